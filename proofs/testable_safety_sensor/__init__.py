"""Theorems about seed 002, SF_TestableSafetySensor."""
