"""Speeds of rotary axes at the programmed feed, and durations."""
