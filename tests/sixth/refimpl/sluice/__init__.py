"""The sluice as plain Python."""
