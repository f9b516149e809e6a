"""TLC: find it, run it, understand what it says, and judge the outcome against runs.toml."""
