"""What the command `prove-program` does."""
