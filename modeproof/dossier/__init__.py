"""The dossier about a user's programs, machines, adapters and logs, from the records of verdicts."""
