"""How strong the properties are: one-edit mutants, and which property each of them breaks."""
