"""Cures of messages about programs that are converted for another machine."""
