"""What the axes and the tool do in a run: positions, deviations, speeds, times."""
