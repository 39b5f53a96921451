"""Cures of messages about projects."""
