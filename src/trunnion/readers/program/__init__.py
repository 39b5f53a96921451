"""Programs as text: files, subprograms, and what the interpreters of all families share."""
