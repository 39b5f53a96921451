"""A whole project: posted, tested against the programs that it has, and watched."""
