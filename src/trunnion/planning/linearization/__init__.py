"""Points between CL points, and lines in place of arcs."""
