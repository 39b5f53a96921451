"""How far the tool retracts, and rewinds of rotary axes in the cut."""
