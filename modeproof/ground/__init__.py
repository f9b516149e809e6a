"""What every other room rests on: places, errors, the lock, progress, processes, evidence."""
