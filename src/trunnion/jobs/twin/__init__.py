"""A program as a running machine, and recordings of machines."""
