"""`modules`, which the page fills and nothing here reads."""

from __future__ import annotations

modules = {}
