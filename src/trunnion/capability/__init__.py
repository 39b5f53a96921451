"""What machines can do with a path or a program: what they reach, and what an error of their geometry does."""
