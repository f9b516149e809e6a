"""Theorems about the shipped reference implementation, judged by two solvers."""
