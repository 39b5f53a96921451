"""What goes with a program: reports, setup sheet, listing and manifest."""
