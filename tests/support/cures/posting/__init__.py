"""Cures of messages about programs that are posted."""
