"""How far the program is from its CL files, and which deviations it declares."""
