"""What every other room stands on: places, errors, the lock, progress, processes, evidence."""
