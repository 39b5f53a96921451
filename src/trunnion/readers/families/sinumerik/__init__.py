"""Reader of Sinumerik 840D programs: the language, and a control that executes it."""
