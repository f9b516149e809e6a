"""What `modeproof verify` runs, stage by stage, and the commands that need several rooms."""
