"""Near the pole: how far the tool axis may lean, and where the motion deviates from the CL file."""
