"""Scan kernels: plain motion blocks straight from bytes to columns."""
