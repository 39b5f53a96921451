"""Settings that all tests share."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

#: Folders and files that ``make.py quick`` leaves out: whole matrices, judges, fuzzing, and long property tests.
SLOW = (
    "api/test_concurrent_proof.py", "conversion", "examples", "fuzz", "jit", "linuxcnc", "machines/test_chains.py",
    "machines/test_turn_clearance.py", "matrix",
    "output/families/fanuc", "output/families/heidenhain", "output/families/linuxcnc/test_holes.py",
    "output/families/sinumerik/test_planes.py", "output/test_hole_positions.py", "output/test_holes.py",
    "output/test_holes_as_motion.py", "output/test_small_tilts.py", "output/test_subprograms.py",
    "planning/test_everywhere.py", "planning/test_optimizer.py", "planning/test_pole.py", "planning/test_read_back.py",
    "planning/test_without_tcp.py", "readers/families", "reporting/test_write.py", "readers/test_kernels.py",
    "verification/test_declared_deviations.py", "verification/test_mutations.py",
)  # fmt: skip

# Kernels compile at their first call, and machines are busy: no test depends on time. What a random machine makes
# impossible is left out by ``assume``, and some draws of machines leave much out.
settings.register_profile(
    "trunnion", deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much]
)
settings.load_profile("trunnion")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the slow ones."""
    here = Path(__file__).parent
    slow = [here / name for name in SLOW]
    for item in items:
        if any(item.path.is_relative_to(place) for place in slow):
            item.add_marker(pytest.mark.slow)
