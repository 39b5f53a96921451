"""Cutting: the motions of a run as sweeps of the tool, and what they take from the stock."""
