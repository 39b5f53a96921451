"""Speeds of rotary axes, and times."""
