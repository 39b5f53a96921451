"""Cures of messages about places of a part on a machine."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.projects.simulated import CL, ONE, project_written
from tests.support.cures.reading import ended
from tests.support.program_heads import HEADS
from trunnion.errors import Problem, TrunnionError
from trunnion.jobs.place.project import placed_setup
from trunnion.model.clamped_toolpaths import clamped_after, stated_clamping
from trunnion.model.clamping import Clamping

_POSTED: Final = ONE.replace('programs = ["one.ngc"]', 'cl = ["part.cls"]\noutput = "part.nc"')
_SETUPS: Final = "".join(
    f'[[setup]]\nname = "{name}"\ncl = ["part.cls"]\noutput = "{name}.nc"\nmachine = "yl569"\n' for name in "AB"
)


def _placed(*names: str, machine: Any = "yl569", **fixed: Any) -> Trial:
    """Return what seeks the place of the part of CL files or programs; settings are further arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        project_written(ONE, folder)
        (folder / "part.cls").write_text(text, encoding="utf-8")
        own = machine
        if str(machine).endswith("\n"):
            own = folder / "ours.toml"
            own.write_text(machine, encoding="utf-8")
        given: dict[str, Any] = {"turns": [0.0], **fixed, **settings}
        try:
            found = trunnion.place([folder / name for name in names], machine=own, **given)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(tuple(found.problems), found.best is not None)

    return tried


def _of_project(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have a project say what is placed; the setting is the name of its set-up."""
    place = project_written(text, folder)
    (folder / "hooks.py").write_text("", encoding="utf-8")
    heard: list[Problem] = []
    return ended(lambda: heard.extend(placed_setup(place, settings.get("setup")).problems), heard)


def _cl_of_project(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    return _placed("part.cls", tool_length=60.0)(CL, settings, folder)


def _stated(*angles: tuple[float, float] | None) -> Trial:
    """Return what asks CL files how their part is clamped; each states a turn and a tilt, or nothing."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.cls").write_text(text, encoding="utf-8")
        toolpath = trunnion.read_cl(folder / "part.cls")
        each = [
            replace(toolpath, clamping=None if own is None else Clamping(turn=own[1], tilt=own[0])) for own in angles
        ]
        return ended(lambda: stated_clamping(each))

    return tried


def _turned_again(turn: float, tilt: float) -> Trial:
    """Return what clamps a part otherwise that is turned by 90 degrees already."""
    return lambda text, settings, folder: ended(lambda: clamped_after(Clamping(turn=90.0), (turn, tilt), "part.cls"))


def _without_tcp(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Compare a program with TCP with itself without it; settings are the place."""
    one, two = folder / "one.mpf", folder / "two.mpf"
    one.write_text(text, encoding="utf-8")
    two.write_text(text.replace("TRAORI\n", ""), encoding="utf-8")
    given: dict[str, Any] = {key: tuple(map(float, value.split(","))) for key, value in settings.items()}
    if "tool_length" in given:
        given["tool_length"] = given["tool_length"][0]
    return ended(lambda: trunnion.diff(one, two, machine="yl569", **given))


_UNLIMITED: Final = 'extends = "ucp800"\n'
_LIMITED: Final = _UNLIMITED + "".join(f'[[axis]]\nname = "{name}"\nlimits_mm = [-400, 400]\n' for name in "XYZ")
_CLS: Final = _placed("part.cls", tool_length=60.0)

CURES: Final = (
    Cure("PLC110", "programs_and_others", _placed("part.cls", "one.ngc", machine="xyzac_trt"), CL, (), cured_by=_CLS),
    Cure(
        "PLC130",
        "no_limits",
        _placed("part.cls", machine=_UNLIMITED),
        CL,
        (),
        cured_by=_placed("part.cls", machine=_LIMITED),
    ),
    Cure("PLC210", "places_depend_on_length", _placed("part.cls"), CL, ({"tool_length": "60"},)),
    Cure("PLC170", "several_setups", _of_project, _SETUPS, ({"setup": "A"},)),
    Cure("PLC170", "no_such_setup", _of_project, _SETUPS, ({"setup": "A"},), {"setup": "C"}),
    Cure("PLC160", "project_with_hooks", _of_project, f'hooks = ["hooks.py"]\n{_POSTED}', (), cured_by=_cl_of_project),
    Cure(
        "PLC310", "states_nothing_part", _stated((0.0, 90.0), None), CL, (), cured_by=_stated((0.0, 90.0), (0.0, 90.0))
    ),
    Cure(
        "PLC310", "states_part", _stated((0.0, 90.0), (0.0, 45.0)), CL, (), cured_by=_stated((0.0, 90.0), (0.0, 90.0))
    ),
    Cure(
        "PLC340",
        "place_of_cuts",
        _without_tcp,
        HEADS["yl569"].format(lines="TRAORI\nG1 X10. B30. F100."),
        ({"zero": "0,0,20", "tool_length": "100"},),
    ),
    Cure("PLC320", "states_part_tilt", _turned_again(0.0, 30.0), CL, (), cured_by=_turned_again(30.0, 0.0)),
)
