"""Seed 004: SF_EDM V2.0, external device monitoring."""
