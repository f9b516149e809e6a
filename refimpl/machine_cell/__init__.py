"""The machine cell: the steps of the other folders, wired by data. Our own design; no paper describes it."""
