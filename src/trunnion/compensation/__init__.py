"""Radius compensation in a plane: the path of the tool centre that a control makes of a programmed path."""
