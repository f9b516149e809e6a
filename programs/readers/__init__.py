"""From the files of users to the tree of `programs.language`."""
