"""Harmful and sound edits of programs in six languages, and the rules by which they are one or the other."""
