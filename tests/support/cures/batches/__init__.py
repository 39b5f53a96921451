"""Cures of messages about batches."""
