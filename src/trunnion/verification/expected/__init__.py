"""What the CL files ask for: the path, its circles and its holes, in the frame of the program."""
