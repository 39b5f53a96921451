"""Writer of LinuxCNC."""
