"""Cures of messages as tables: the smallest input that draws a message, and the same as its cure says."""
