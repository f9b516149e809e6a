"""Reference implementation of seed 003: the function block for an enable switch with three channels."""
