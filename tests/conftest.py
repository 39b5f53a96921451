"""Settings that all tests share."""

import os
import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.support.slow import SLOW

#: Files and folders of the slow ones.
PLACES = {Path(__file__).parent / name for name in SLOW}

# Kernels compile at their first call, and machines are busy: no test depends on time. What a random machine makes
# impossible is left out by ``assume``, and some draws of machines leave much out. In CI a change is judged by the same
# examples as the one before it; elsewhere they are new ones each time.
settings.register_profile(
    "trunnion",
    deadline=None,
    derandomize=bool(os.environ.get("CI")),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
settings.load_profile("trunnion")


def pytest_configure(config: pytest.Config) -> None:
    """Have the tests, and the processes that they start, remember their outputs apart from those of the user."""
    cache = tempfile.TemporaryDirectory(prefix="trunnion-tests-")
    config.add_cleanup(cache.cleanup)
    os.environ["LOCALAPPDATA"] = cache.name


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not even import the slow ones where they are left out."""
    return True if config.getoption("markexpr") == "not slow" and collection_path in PLACES else None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the slow ones."""
    slow = {path for path in {item.path for item in items} if not PLACES.isdisjoint((path, *path.parents))}
    for item in items:
        if item.path in slow:
            item.add_marker(pytest.mark.slow)
