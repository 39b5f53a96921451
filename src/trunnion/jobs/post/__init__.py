"""CL files to an NC program with its proof."""
