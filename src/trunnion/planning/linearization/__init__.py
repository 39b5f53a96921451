"""Points between CL points, and arcs as chords."""
