"""Near the pole: the tool axis leans so that the rotary axes need not be too fast."""
