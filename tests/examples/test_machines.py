"""The machines of the examples: short, from the docs alone, and their programs are proven."""

import re
from io import BytesIO
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT
from trunnion.builder.sample import shipped_sample
from trunnion.controls.loading import with_control
from trunnion.definitions import load_table
from trunnion.definitions.resolved import resolved_text
from trunnion.machines.loading import machine_library

MACHINES = {path.stem: path for path in sorted((ROOT / "examples" / "machines").glob("*.toml"))}


class Sample(BytesIO):
    name = "sample.cls"


def test_they_are_of_four_kinds_and_three_controls() -> None:
    machines = [trunnion.load_machine(path) for path in MACHINES.values()]
    rotary = [[axis for axis in machine.axes if axis.is_rotary] for machine in machines]
    kinds = {
        (*(axis.mount for axis in axes), any(0.1 < abs(part) < 0.9 for axis in axes for part in axis.direction))
        for axes in rotary
    }
    assert kinds == {("part", "part", False), ("part", "part", True), ("part", "tool", False), ("tool", "tool", False)}
    controls = {trunnion.describe_control(path).family for path in MACHINES.values()}
    assert len(controls) == 3


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_takes_less_than_forty_lines_and_its_sample_is_proven(name: str) -> None:
    text = MACHINES[name].read_text(encoding="utf-8")
    assert len(text.splitlines()) < 40
    assert text.startswith("#:schema ")
    posted = trunnion.post(Sample(shipped_sample()), machine=MACHINES[name])
    assert posted.passed
    assert len(posted.checks) > 10
    warned = [each.what for each in posted.problems if "not measured yet" in each.what]
    assert bool(warned) == ("# measure:" in text)
    assert all(f"({Path(MACHINES[name]).name}:" in what for what in warned)
    assert posted.text


def test_marks_are_kept_where_all_that_counts_is_printed(tmp_path: Path) -> None:
    path = next(path for path in MACHINES.values() if "# measure:" in path.read_text(encoding="utf-8"))
    table = load_table(path, machine_library(), kind="machine")
    resolved = tmp_path / "resolved.toml"
    resolved.write_text(resolved_text(with_control(table)), encoding="utf-8")

    def told(machine: Path) -> list[str]:
        found = next(each for each in trunnion.describe_machine(machine).assumed if each.startswith("Still to enter"))
        return re.sub(r" \([^)]*\)", "", found).removeprefix("Still to enter: ").rstrip(".").split(", ")

    assert sorted(told(resolved)) == sorted(told(path))
    assert sorted(map(str, trunnion.load_machine(resolved).unmeasured))[0].startswith(sorted(told(path))[0])


@pytest.mark.parametrize("name", MACHINES)
def test_what_is_not_of_the_public_post_is_marked(name: str) -> None:
    """Points of rotary axes and the place of travel are no data of a post."""
    table = load_table(MACHINES[name], machine_library(), kind="machine")
    lines = MACHINES[name].read_text(encoding="utf-8").splitlines()
    for axis in table.tables("axis"):
        for key in ("point_mm", "limits_mm"):
            file, line = axis.location(key)
            if key in axis and Path(file) == MACHINES[name]:
                assert "# measure: " in lines[line - 1], lines[line - 1]
