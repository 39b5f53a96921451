"""How many changes of the sources the tests notice."""
