"""Properties of programs, and their verdicts."""
