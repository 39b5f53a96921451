"""Blocks of an NC program: the compiled block writer, and the motion blocks that it writes."""
