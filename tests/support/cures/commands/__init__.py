"""Cures of messages about commands, their arguments and settings."""
