"""Cures of messages about definitions of machines and controls."""
