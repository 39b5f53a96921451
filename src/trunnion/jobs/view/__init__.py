"""A program on its machine as a page."""
