"""The reader of PLCopen XML: declarations, bodies in Structured Text, function block diagrams, ladders."""
