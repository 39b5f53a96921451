"""Cut stock with NC programs."""
