"""Writer of Sinumerik 840D sl."""
