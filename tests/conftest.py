"""Settings that all tests share."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.support.slow import SLOW

# Kernels compile at their first call, and machines are busy: no test depends on time. What a random machine makes
# impossible is left out by ``assume``, and some draws of machines leave much out.
settings.register_profile(
    "trunnion", deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much]
)
settings.load_profile("trunnion")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the slow ones."""
    here = Path(__file__).parent
    places = {here / name for name in SLOW}
    slow = {path for path in {item.path for item in items} if not places.isdisjoint((path, *path.parents))}
    for item in items:
        if item.path in slow:
            item.add_marker(pytest.mark.slow)
