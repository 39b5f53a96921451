"""Reports: a verification as an HTML file that works offline, or as JSON."""
