"""An NC program to a CL file, or to the program of another machine."""
