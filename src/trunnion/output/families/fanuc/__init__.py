"""Writer of Fanuc 30i and 31i."""
