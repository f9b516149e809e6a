"""Builds test suites from graphs and writes them as vector files."""
