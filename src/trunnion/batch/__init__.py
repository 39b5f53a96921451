"""Many files posted, converted, verified or simulated: on this computer, or on a cluster."""
