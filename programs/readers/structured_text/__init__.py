"""The reader of Structured Text."""
