"""The complete graph of one device as TLC printed it: read it, merge its columns, compare code with it."""
