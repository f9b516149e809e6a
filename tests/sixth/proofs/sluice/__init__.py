"""Theorems about the sluice."""
