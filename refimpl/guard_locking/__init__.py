"""The safety function block of seed 001: SF_GuardLocking V1.0."""
