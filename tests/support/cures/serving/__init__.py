"""Cures of messages about pages, twins and recordings."""
