"""The former place of modeproof/registers/runs.py."""

from modeproof.registers.runs import Graph, Run, load_runs

__all__ = ["Graph", "Run", "load_runs"]
