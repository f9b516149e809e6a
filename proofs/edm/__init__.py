"""Theorems about seed 004, SF_EDM."""
