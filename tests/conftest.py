"""Settings that all tests share."""

from hypothesis import HealthCheck, settings

# Kernels compile at their first call, and machines are busy: no test depends on time. What a random machine makes
# impossible is left out by ``assume``, and some draws of machines leave much out.
settings.register_profile(
    "trunnion", deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much]
)
settings.load_profile("trunnion")
