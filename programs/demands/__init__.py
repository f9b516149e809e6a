"""Does a program follow the page: its demands, proved over the program for every input and time."""
