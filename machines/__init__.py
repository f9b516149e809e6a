"""Machines: blocks of the documents joined by a wiring file; their properties, programs, models, vectors."""
