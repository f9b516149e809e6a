"""What others can check of a proof, without any search."""
