"""Cures of messages about impellers."""
