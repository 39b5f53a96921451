"""RS274/NGC as LinuxCNC 2.9 reads it."""
