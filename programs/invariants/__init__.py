"""Proofs about transition systems by induction, and the search for the invariants that they need."""
