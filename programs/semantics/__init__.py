"""What one scan of a program does: with plain values, and as terms of a solver."""
