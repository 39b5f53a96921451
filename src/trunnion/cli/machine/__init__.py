"""Commands about a machine: its definition, what it reaches, and where a workpiece fits."""
