"""Cures of messages about simulations: stocks, tools, bodies."""
