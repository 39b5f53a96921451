"""Impellers and curves from measured points."""
