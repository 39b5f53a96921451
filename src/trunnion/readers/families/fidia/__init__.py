"""Programs of a Fidia NC15."""
