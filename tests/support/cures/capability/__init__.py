"""Cures of messages about what a machine reaches, and where a part stands on it."""
