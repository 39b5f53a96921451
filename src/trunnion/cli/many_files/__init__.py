"""Commands for many files: what is shown while they go on, and what is printed of them."""
