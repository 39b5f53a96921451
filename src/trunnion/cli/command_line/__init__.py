"""How the words of a command line are understood, from the declarations of the commands."""
