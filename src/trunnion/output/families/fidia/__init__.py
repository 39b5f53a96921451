"""Writer of Fidia NC15."""
