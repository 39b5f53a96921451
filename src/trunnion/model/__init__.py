"""The records and columns that everybody shares: toolpaths, motions on the machine, and runs of programs."""
