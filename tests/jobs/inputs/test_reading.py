"""Programs that are already read: a run belongs to the machine, by its content, with which it was read."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.machines import Machine

CL = YL569 / "2_hub_rough.cls"
PROGRAM = YL569 / "2_hub_rough.expected.mpf"

#: Definitions that are another machine, or have another control, under the same name.
OTHERS = {
    "another control": '[control]\nextends = "fanuc_31i"\n',
    "another reading": "[control.reading]\ncycles_along_tool = true\n",
    "other settings": '[control.settings]\nwork_offset = "G55"\n',
    "another travel": '[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n',
    "another rapid": '[[axis]]\nname = "B"\nrapid_deg_min = 1\n',
    "another spindle": "[spindle]\nmax_rpm = 10\n",
}


def own_machine(folder: Path, change: str) -> Machine:
    """A definition called yl569 in another folder."""
    file = folder / "yl569.toml"
    file.write_text(f'extends = "yl569"\n{change}', encoding="utf-8")
    return trunnion.load_machine(file)


@pytest.fixture(scope="module")
def run() -> trunnion.Run:
    return trunnion.read_program(PROGRAM, machine="yl569")


@pytest.mark.parametrize("change", OTHERS)
def test_a_run_is_not_proven_for_a_machine_that_is_defined_otherwise(
    change: str, run: trunnion.Run, tmp_path: Path
) -> None:
    other = own_machine(tmp_path, OTHERS[change])
    calls: list[Callable[[], object]] = [
        lambda: trunnion.verify(run, machine=other, cl=CL),
        lambda: trunnion.diff(run, run, machine=other),
        lambda: trunnion.diff(PROGRAM, run, machine="yl569", to_machine=other),
    ]
    for call in calls:
        with pytest.raises(trunnion.InputError, match="was read for yl569") as refused:
            call()
        assert refused.value.problems[0].cure


def test_a_run_is_proven_for_its_machine_whatever_that_is_called(run: trunnion.Run, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('extends = "yl569"\nname = "Mine"\n', encoding="utf-8")
    assert trunnion.verify(run, machine=file, cl=CL).passed
    assert trunnion.verify(run, machine=replace(run.machine, description="the one at the window"), cl=CL).passed
    assert trunnion.diff(run, PROGRAM, machine="yl569", to_machine=file).same
