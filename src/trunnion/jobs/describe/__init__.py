"""Machines, controls, CL files and codes of messages in words."""
