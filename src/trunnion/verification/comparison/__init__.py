"""Two programs side by side: whether they make the tool do the same."""
