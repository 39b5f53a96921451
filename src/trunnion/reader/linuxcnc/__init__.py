"""Reader of LinuxCNC programs (RS274/NGC): the language, and a control that executes it."""
