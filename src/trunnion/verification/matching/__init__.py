"""Which motions of a program answer to which points, arcs and holes of the CL files."""
