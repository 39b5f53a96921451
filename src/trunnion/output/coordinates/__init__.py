"""The numbers that words print: axis coordinates, tool vectors, planes and their angles."""
