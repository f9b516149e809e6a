"""The reader of statement list (STL, AWL) of an S7-300."""
