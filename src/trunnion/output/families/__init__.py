"""The writers of the families of controls, a folder each."""
