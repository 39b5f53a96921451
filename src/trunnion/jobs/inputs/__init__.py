"""What the jobs share of their inputs: arguments, settings, CL files, machines and programs."""
