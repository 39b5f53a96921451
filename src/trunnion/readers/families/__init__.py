"""The readers of the families of controls, a folder each."""
