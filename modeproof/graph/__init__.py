"""The complete graph of one device as TLC printed it: read it, merge its input columns, compare code with it."""
