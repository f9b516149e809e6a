"""Pages for readers, rendered from registers and evidence alone; the same evidence gives the same bytes."""
