"""Theorems about the enable switch with three channels (seed 003): any inputs, any times, any parameters."""
