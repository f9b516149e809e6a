"""What an id or a word of this project means, where it is, and what was shown: for the terminal."""
