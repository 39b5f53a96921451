"""Programs of a Fanuc 30i or 31i."""
