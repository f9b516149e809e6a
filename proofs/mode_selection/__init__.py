"""Theorems about seed 000, operation mode selection."""
