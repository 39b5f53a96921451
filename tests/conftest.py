"""Settings that all tests share."""

from hypothesis import settings

# Kernels compile at their first call, and machines are busy: no test depends on time.
settings.register_profile("trunnion", deadline=None)
settings.load_profile("trunnion")
