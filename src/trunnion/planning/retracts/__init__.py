"""Retracts: how far the tool draws back, and rewinds of rotary axes."""
