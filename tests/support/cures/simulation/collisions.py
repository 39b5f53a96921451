"""Cures of messages about the bodies of machines, and about collisions with them."""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.cures.simulation.simulations import ABOVE_TABLE, HEAD_OF_OURS, SHORT, on, simulated
from tests.support.simulating import SLOT, TOOL, cuboid
from trunnion.errors import Problem
from trunnion.machines import load_machine
from trunnion.machines.loading import machine_library
from trunnion.readers import run_program
from trunnion.simulation.collisions import Body, BodyKind, check_collisions, machine_bodies
from trunnion.simulation.meshes import box_mesh, save_mesh
from trunnion.simulation.tools.text import parse_tool

_BODY: Final = '[[body]]\nname = "cover"\nlink = "spindle"\nshape = "file"\nfile = "cover.stl"\n'
_GAUGE: Final = "[spindle]\ngauge_point_mm = [0, 0, 0]\n"
_STATED_HEAD: Final = (machine_library() / "generic_head_table_bc.toml").read_text(encoding="utf-8")
_TURNING_HEAD: Final = re.sub("gauge_point_mm.*\n", "", _STATED_HEAD)
_AT_MACHINE: Final = SLOT.replace("N50", "G53 G0 Z0\nG0 Z20\nN50")
_ABOVE: Final = _GAUGE.replace("0]", "100]")
_TABLE: Final = Body("table", "bed", box_mesh(np.array([500.0, 0, 0]), np.array([510.0, 9, 9])), BodyKind.MACHINE)


def _read(*, keeps: bool = True, linked: bool = False) -> Trial:
    """Return what reads the bodies of a definition, whose file may be gone since, and whose mesh a link elsewhere."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        own, heard = folder / "own", list[Problem]()
        own.mkdir(exist_ok=True)
        cover = own / "cover.stl"
        cover.unlink(missing_ok=True)
        save_mesh(cuboid((0, 0, 0), (9, 9, 9)), folder / "cover.stl" if linked else cover)
        if linked:
            cover.symlink_to(folder / "cover.stl")
        (own / "ours.toml").write_text(text, encoding="utf-8")
        machine = load_machine(own / "ours.toml")
        if not keeps:
            (own / "ours.toml").unlink()
        return ended(lambda: machine_bodies(machine, heard.append), heard)

    return tried


def _checked(tools: str = TOOL, *, placed: bool = True) -> Trial:
    """Return what looks for collisions of a program, on a machine with a zero or without."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.ngc").write_text(text, encoding="utf-8")
        machine = replace(load_machine("xyzac_trt"), workpiece_zero=(0.0, 0.0, 0.0) if placed else None)
        run = run_program(folder / "part.ngc", machine)
        shapes = {"1": parse_tool(tools)} if tools else {}
        return ended(lambda: check_collisions(run, [_TABLE], shapes))

    return tried


def _on_own(gauge: str = "") -> Trial:
    """Return what simulates a program on a definition of one's own, whose gauge point is stated or not."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "ours.toml").write_text(HEAD_OF_OURS + gauge, encoding="utf-8")
        return simulated(text, str(folder / "ours.toml"), folder, zero=ABOVE_TABLE, tool_length="50", tools=SHORT)

    return tried


CURES: Final = (
    Cure("SIM310", "no_spindle_gauge", _read(), _TURNING_HEAD, ((_TURNING_HEAD, _STATED_HEAD),)),
    Cure("SIM146", "motion_before_all", on(), SLOT.replace("X-20 Y0 Z20", "X-20 Y0"), (), cured_by=_on_own(_ABOVE)),
    Cure("SIM310", "gauge_at_machine", _on_own(), _AT_MACHINE, (), cured_by=_on_own(_ABOVE)),
    Cure("SIM312", "leads_out_folder", _read(linked=True), HEAD_OF_OURS + _BODY, (), cured_by=_read()),
    Cure("SIM312", "belongs_no_definition", _read(keeps=False), HEAD_OF_OURS + _BODY, (), cured_by=_read()),
    Cure("SIM150", "tool_not_known", _checked(""), SLOT, (), cured_by=_checked()),
    Cure("SIM310", "collision_check_machine", _checked(placed=False), SLOT, (), cured_by=_checked()),
    Cure("SIM310", "length_tool_not", _checked("1=flat:10,flutes=20"), SLOT, (), cured_by=_checked()),
    Cure(
        "SIM314",
        "in_stock",
        on(),
        SLOT,
        ({"fixtures": "vice:50,opening=40,jaw=10x5,base=80x9,at=25/0/-10"},),
        {"fixtures": "vice:50,opening=36,jaw=10x5,base=80x9,at=25/0/-10"},
    ),
    Cure("SIM313", "sunk_in", on(), SLOT, ({"zero": "-25,0,12"},), {"zero": "-25,0,2"}),
)
