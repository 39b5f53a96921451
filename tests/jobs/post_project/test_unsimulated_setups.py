"""Stock in set-ups that nothing simulates: what is not looked at is said."""

from pathlib import Path

import pytest

import trunnion
from tests.support.cures.projects.simulated import CL, project_written

_STOCK = 'stock = "box:50,40,10,0,-20,-10"\ntools = ["1=flat:10,length=60,flutes=20"]\ncell_mm = 2\n'
_SETUP = '[[setup]]\nname = "{name}"\ncl = ["part.cls"]\noutput = "{name}.nc"\nmachine = "{machine}"\n'


def warned(folder: Path, text: str) -> list[str]:
    """The warnings of a post on stock that is not looked at."""
    path = project_written(text, folder)
    (folder / "part.cls").write_text(CL, encoding="utf-8")
    found = trunnion.post_project(path)
    return [str(problem) for problem in found.problems if "nothing simulates" in str(problem)]


@pytest.mark.parametrize("machine", ["xyzac_trt", "yl569", "dmu65"])
def test_each_later_setup_is_said_not_to_be_checked(machine: str, tmp_path: Path) -> None:
    setups = [_SETUP.format(name=name, machine=machine) for name in ("one", "two", "three")]
    told = warned(tmp_path, _STOCK + "".join(setups))
    assert [each.partition("(set-up ")[2].partition(")")[0] for each in told] == ["two", "three"]
    assert all(each.endswith("[PRJ240]") for each in told)


def test_one_setup_as_it_is_drawn_is_compared(tmp_path: Path) -> None:
    assert not warned(tmp_path, _STOCK + _SETUP.format(name="one", machine="xyzac_trt"))


def test_setups_without_stock_say_nothing(tmp_path: Path) -> None:
    setups = [_SETUP.format(name=name, machine="xyzac_trt") for name in ("one", "two")]
    assert not warned(tmp_path, "".join(setups))
