"""Theorems about seed 001, SF_GuardLocking."""
