"""The page to play with: the reference implementation, run by Brython in a browser. It proves nothing."""
