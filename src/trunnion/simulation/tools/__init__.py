"""Tools as bodies: from sizes, texts, libraries and CL files to the convex pieces that kernels work with."""
