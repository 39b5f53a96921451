"""Stock: material along the rays of a lattice, its surface, and how it differs from the design."""
