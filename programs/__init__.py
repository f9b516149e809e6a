"""Proofs about a user's own PLC program: read from its source, compared with the reference implementation.

`tree` is the language, `st` reads Structured Text into it, `check` gives every name and expression its type
and refuses what is not in the subset, `run` executes a program with plain values, `symbolic` turns one scan
into solver terms, `product` proves a program equal to a reference or finds the scans after which it differs.
"""
