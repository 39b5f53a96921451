"""Cures of messages about files that are read and written."""
