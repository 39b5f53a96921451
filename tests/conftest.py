"""Settings that all tests share."""

import gc
import os
import tempfile
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from tests.support.durations import PROCESSOR_SECONDS, SLOW, kept
from tests.support.examples import DRAWS, leave_thirds
from tests.support.locations import TESTS

# Kernels compile at their first call, and machines are busy: no test depends on time. What a random machine makes
# impossible is left out by ``assume``, and some draws of machines leave much out. In CI a change is judged by the same
# examples as the one before it; elsewhere, and in nightly, they are new ones each time.
for _name, _draws in DRAWS.items():
    settings.register_profile(
        _name,
        max_examples=_draws,
        deadline=None,
        derandomize=_name != "nightly" and bool(os.environ.get("CI")),
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    )
settings.load_profile("trunnion")

BEGUN = pytest.StashKey[float]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let ``make.py nightly`` ask for what ``make.py test`` leaves out."""
    parser.addoption("--nightly", action="store_true", help="the rest of the matrix, and properties with all draws")


def pytest_configure(config: pytest.Config) -> None:
    """Have the tests, and the processes that they start, remember their outputs apart from those of the user.

    No test waits for the disk: a post would do so five times, and what is lost with the power no test sees.
    """
    cache = tempfile.TemporaryDirectory(prefix="trunnion-tests-")
    config.add_cleanup(cache.cleanup)
    without_waiting = pytest.MonkeyPatch()
    without_waiting.setattr(os, "fsync", lambda descriptor: None)
    config.add_cleanup(without_waiting.undo)
    os.environ["LOCALAPPDATA"] = cache.name
    os.environ["LC_MESSAGES"] = "C"  # English, wherever the tests run
    os.environ.pop("LC_ALL", None)
    if config.getoption("nightly"):
        settings.load_profile("nightly")


@pytest.hookimpl(trylast=True)  # Hypothesis has marked its own
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let the slow ones begin first, and part those of nightly from the others."""
    leave_thirds(items)
    slow = {TESTS / file for file, seconds in kept().items() if seconds > SLOW}
    items.sort(key=lambda item: item.path not in slow)  # a long one that began last would have one worker wait
    nightly = config.getoption("nightly")
    rest = [item for item in items if not is_wanted(item, nightly=nightly)]
    if rest:
        config.hook.pytest_deselected(items=rest)
        items[:] = [item for item in items if is_wanted(item, nightly=nightly)]


def pytest_collection_finish(session: pytest.Session) -> None:
    """Look for garbage no more among all modules and tests, which stay: that took a tenth of the time."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> Iterator[None]:
    """Begin to count the processor time of a test."""
    item.stash[BEGUN] = processor_seconds()
    return (yield)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    """Have ``--junitxml`` say what processor time a test took, with the programs that it started and awaited."""
    try:
        return (yield)
    finally:
        item.user_properties.append((PROCESSOR_SECONDS, f"{processor_seconds() - item.stash[BEGUN]:.3f}"))


def processor_seconds() -> float:
    """Processor time of this process and of those that it started and awaited."""
    return sum(os.times()[:4])


def is_wanted(item: pytest.Item, *, nightly: bool) -> bool:
    """Whether nightly has a test, or any other run; a property has draws left for nightly."""
    rest = item.get_closest_marker("nightly") is not None
    return rest or item.get_closest_marker("hypothesis") is not None if nightly else not rest
