"""Fifty real machines, as public posts describe them: each becomes a definition and goes there and back in its limits.

``tests/data/machines.csv`` is a table of facts of 50 post-processors. In it the fourth axis is the one on the base and
carries the fifth; ``plane`` is the plane in which an axis turns; offsets lead from the fourth to the fifth axis; the
pivot lies above the gauge point. Rows that contradict themselves are listed here with the reason; they must not load.
"""

from pathlib import Path

import numpy as np
import pytest

from tests.support.fifty_machines import ABOUT, CONTRADICTIONS, ROWS, load, numbers
from trunnion.errors import InputError
from trunnion.machines import forward, inverse

#: Facts that are odd and yet make a machine; what the test does about them.
ODD = {
    "Haas_vf2_ss_5axis": "an axis about Z is called B: names are free",
    "Haas_5T": "an axis about Z is called B: names are free",
    "Makino_Axx-5x": "an axis about X is called C: names are free",
    "zfg630_fanuc0m": "an axis about Z is called B; its zero is turned by 180 degrees, which turns the workpiece frame",
    "MAZAK_VORTEX": "no spindle axis is stated: Z, the default",
    "DMU_70_eVo_840D_in": "a nutated B at 45 degrees with 102 degrees of travel tilts the tool by less than 90",
}


def test_the_table_holds_fifty_machines_and_every_exception_is_one_of_them() -> None:
    assert len(ROWS) == 50
    assert set(CONTRADICTIONS) | set(ODD) <= set(ROWS)


@pytest.mark.parametrize("name", sorted(set(ROWS) - set(CONTRADICTIONS)))
def test_a_real_machine_goes_there_and_back_within_its_limits(name: str, tmp_path: Path) -> None:
    machine = load(ROWS[name], tmp_path)
    for which in ("axis4", "axis5"):
        axis = machine.axis(ROWS[name][which])
        assert [axis.low, axis.high] == [float(ROWS[name][f"{which}_{end}_deg"]) for end in ("min", "max")]
    random = np.random.default_rng(5)
    low, high = np.clip(machine.limits, -5000.0, 5000.0).T
    values = random.uniform(low, high, (500, 5))
    tip, axis_there = forward(machine, values, 120.0)
    found = inverse(machine, tip, axis_there, 120.0)
    assert found.reachable.all()
    for branch in found.joints:
        again_tip, again_axis = forward(machine, branch, 120.0)
        np.testing.assert_allclose(again_tip, tip, rtol=0, atol=1e-9)
        np.testing.assert_allclose(again_axis, axis_there, rtol=0, atol=1e-12)
    off = found.joints - values
    turning = list(machine.rotary)
    off[:, :, turning] = (off[:, :, turning] + 180.0) % 360.0 - 180.0
    assert np.abs(off).max(axis=2).min(axis=0).max() < 1e-6


@pytest.mark.parametrize("name", sorted(CONTRADICTIONS))
def test_a_row_that_contradicts_itself_is_refused_for_the_reason_listed(name: str, tmp_path: Path) -> None:
    _, expected = CONTRADICTIONS[name]
    with pytest.raises(InputError) as caught:
        load(ROWS[name], tmp_path)
    said = [problem.what for problem in caught.value.problems]
    for what in expected:
        if "parallel" in what and any("missing" in line for line in said):
            continue  # the chain is looked at only when every axis is sound by itself
        assert any(line.startswith(what) for line in said), said


def test_planes_and_vectors_agree_wherever_both_are_given() -> None:
    differ = set()
    for name, row in ROWS.items():
        for which in ("axis4", "axis5"):
            vector, plane = numbers(row[f"{which}_vector"]), row[f"{which}_plane"]
            if vector and plane in ABOUT and tuple(vector) != ABOUT[plane]:
                differ.add(name)
    assert differ == {"dmu50_MILL_PLUS"}
