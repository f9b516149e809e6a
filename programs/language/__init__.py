"""The language into which programs are read: its tree, types, constants, calls, and what it leaves out."""
