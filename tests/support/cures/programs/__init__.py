"""Cures of messages about NC programs that are read and proven."""
