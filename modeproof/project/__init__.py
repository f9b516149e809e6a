"""A user's own project: the file that lists what is theirs, and the commands that write it and judge it."""
