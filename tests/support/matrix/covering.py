"""A covering array of the matrix: each machine and control once, each of them with each family of paths.

Kinematics, control and path are independent (decisions 0002 and 0006), so that a fault shows in a pair of them.
``make.py test`` has this array, ``make.py nightly`` the rest of the matrix.
"""

from collections.abc import Sequence
from typing import Final

import pytest

from tests.support.matrix.expected import FAMILIES
from tests.support.matrix.pairs import CONTROLS
from trunnion.machines import shipped_machines

#: The family of paths with all cycles that a control has.
ALL_CYCLES: Final = "all cycles"

PATHS: Final = (*FAMILIES, ALL_CYCLES)
MACHINES: Final = shipped_machines()


def covering(machine: str, control: str) -> str:
    """The family of paths that a machine with a control has in the array."""
    return PATHS[(MACHINES.index(machine) + CONTROLS.index(control)) % len(PATHS)]


def cases(paths: Sequence[str]) -> list[object]:
    """Machine, control and path of the whole matrix, as parameters; what is not in the array is left to nightly."""
    return [case(machine, control, path) for path in paths for control in CONTROLS for machine in MACHINES]


def case(machine: str, control: str, path: str) -> object:
    """One cell of the matrix, left to nightly if the array does without it."""
    rest = [] if path == covering(machine, control) else [pytest.mark.nightly]
    return pytest.param(machine, control, path, marks=rest)
