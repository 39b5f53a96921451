"""Cures of messages about projects that are simulated, and about simulations while a program is posted."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.simulating import HEAD, SLOT, TOOL, cuboid
from trunnion.batch.jobs_file import load_batch
from trunnion.errors import TrunnionError
from trunnion.jobs.observer import SILENT
from trunnion.jobs.simulate.shares import simulate_share
from trunnion.simulation.cutting.shares import Share
from trunnion.simulation.meshes import save_mesh

_TWO_OFFSETS: Final = SLOT.replace("G43 H1", "G54\nG43 H1").replace(
    "M5\n", "G55\nG0 X-20 Y10\nG0 Z-3\nG1 X70\nG0 Z20\nM5\n"
)
_PROGRAMS: Final = {
    "one.ngc": SLOT.replace("N50", "G54\nN50"),
    "two.ngc": _TWO_OFFSETS,
    "bare.ngc": SLOT,
    "beside.ngc": SLOT.replace("G43 H1", "G54\nG43 H1").replace("N50", "G55\nG0 X-20 Y0 Z30\nG54\nG0 X-20 Y0 Z20\nN50"),
    "other.ngc": SLOT.replace("N50", "G55\nN50"),
    "high.ngc": SLOT.replace("Z-5", "Z0"),
    "all.ngc": HEAD
    + "G0 Y-22 Z-11\n"
    + "".join(f"G1 X70 Y{y} F500\nG1 X-20\n" for y in range(-22, 25, 4))
    + "G0 Z20\nM5\nM30\n",
}
CL: Final = (
    "TOOL PATH/SLOT,TOOL,D10\nTLDATA/MILL,10,0,60,0,0\nLOADTL/1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/-20,0,20,0,0,1\n"
    "FEDRAT/MMPM,500\nGOTO/-20,0,-5\nGOTO/70,0,-5\nRAPID\nGOTO/70,0,20\nEND-OF-PATH\n"
)
_SETUP: Final = 'programs = ["one.ngc"]\nmachine = "xyzac_trt"\n'
_WHOLE: Final = f'stock = "box:50,40,10,0,-20,-10"\ntools = ["{TOOL}"]\ncell_mm = 2\n'
ONE: Final = _WHOLE + _SETUP
_SECOND: Final = f'[[setup]]\nname = "A"\n{_SETUP}[[setup]]\nname = "B"\n{_SETUP}'
_POSTED: Final = 'cl = ["part.cls"]\noutput = "part.nc"\nmachine = "xyzac_trt"\n'
TWO: Final = _WHOLE + _SECOND
_HIGH: Final = (
    _WHOLE + 'part = "whole.stl"\n' + _SECOND.replace("one.ngc", "high.ngc").replace("high.ngc", "one.ngc", 1)
).replace("40,10,", "40,15,")


def project_written(text: str, folder: Path, name: str = "part.toml") -> Path:
    for program, content in _PROGRAMS.items():
        (folder / program).write_text(content, encoding="utf-8")
    (folder / "part.cls").write_text(CL, encoding="utf-8")
    save_mesh(cuboid((0, -20, -10), (50, 20, -5)), folder / "part.stl")
    save_mesh(cuboid((0, -20, -10), (50, 20, 0)), folder / "whole.stl")
    save_mesh(cuboid((100, -20, -10), (150, 20, -5)), folder / "beside.stl")
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def _simulated(name: str = "part.toml", *others: str, **given: Any) -> Trial:
    """Return what simulates a project of a name, and others with it; settings are further arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        files = [project_written(text, folder, name), *(folder / other for other in others)]
        try:
            found = trunnion.simulate(files, **given, **settings)  # type: ignore[arg-type]
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(tuple(found.remarks), found.passed)

    return tried


def _posted(**given: Any) -> Trial:
    """Return what posts a CL file and simulates what is posted as a project has it; settings are further arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file = folder / "part.cls"
        file.write_text(CL, encoding="utf-8")
        how: dict[str, Any] = {"machine": "xyzac_trt", **given}
        project = project_written(text, folder) if text else None
        try:
            found = trunnion.post(file, settings=settings, simulation=how.pop("simulation", project), **how)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        return Outcome(tuple(found.problems), found.passed)

    return tried


def _posted_with(name: str) -> Trial:
    """Return what posts a CL file and simulates with a project of a name."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return _posted(simulation=project_written(text, folder, name))("", settings, folder)

    return tried


def _jobs_read(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a file of jobs."""
    return ended(lambda: load_batch(project_written(text, folder)))


def _project_posted(name: str) -> Trial:
    """Return what posts a project of a name, which has a program already."""
    return lambda text, settings, folder: ended(lambda: trunnion.post_project(project_written(text, folder, name)))


def _shared(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Cut one tile of the stock of a project."""
    return ended(lambda: simulate_share(project_written(text, folder), Share(0, 2), dict(settings), SILENT))  # type: ignore[arg-type]


_BODIES: Final = {"stock": "box:50,40,10,0,-20,-10", "cell": 2.0}

_JOBS: Final = (
    '[[job]]\naction = "simulate"\nfiles = ["one.ngc"]\n'
    + _WHOLE
    + 'machine = "xyzac_trt"\ntiles = 2\nstop_at = "first"\n'
)


def _posted_first(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a project, and simulate it."""
    trunnion.post_project(project_written(text, folder))
    return ended(lambda: trunnion.simulate(folder / "part.toml"))


_DIVIDED: Final = 'divide = "operations"\n'

CURES: Final = (
    Cure("DEF330", "not_posted_yet", _simulated(), _POSTED + _WHOLE, (), cured_by=_posted_first),
    Cure(
        "DEF330",
        "becomes_several_files",
        _simulated(),
        _POSTED + _DIVIDED + _WHOLE,
        ((_WHOLE, _WHOLE + '[checks]\nsimulate = "refuse"\n'),),
        cured_by=_project_posted("part.toml"),
    ),
    Cure("SIM111", "project_among_programs", _simulated("part.toml", "one.ngc"), ONE, (), cured_by=_simulated()),
    Cure(
        "SIM111",
        "of_all_setups",
        _simulated(zero="-25,0,12"),
        TWO,
        (('[[setup]]\nname = "A"', 'zero_mm = [-25, 0, 12]\n[[setup]]\nname = "A"'),),
        cured_by=_simulated(),
    ),
    Cure(
        "SIM112",
        "project_of_other_ending",
        _project_posted("part.txt"),
        _POSTED,
        (),
        cured_by=_project_posted("part.toml"),
    ),
    Cure("SIM112", "no_project", _simulated(), 'title = "PART"\n', (('title = "PART"\n', ONE),)),
    Cure("SIM112", "machine_for_project", _simulated(), 'extends = "xyzac_trt"\n', (('extends = "xyzac_trt"\n', ONE),)),
    Cure("SIM112", "several_setups", _posted(), TWO, ((TWO, ONE),)),
    Cure("SIM113", "other_machine", _posted(machine="yl569"), ONE, (), cured_by=_posted()),
    Cure("SIM113", "not_of_the_post", _posted(), ONE + "tool_length_mm = 60\n", ({"tool_length": "60"},)),
    Cure(
        "SIM113",
        "other_than_of_the_post",
        _posted(),
        ONE + "tool_length_mm = 60\n",
        ({"tool_length": "60"},),
        {"tool_length": "50"},
    ),
    Cure("SIM113", "clamped_otherwise", _posted(), ONE + "turn_deg = 90\n", (), cured_by=_posted(turn=90.0)),
    Cure("SIM113", "only_to_a_block", _posted(), ONE + "until = 60\n", (("until = 60\n", ""),)),
    Cure(
        "SIM110",
        "unknown",
        _posted(simulation={**_BODIES, "colour": "red"}),
        "",
        (),
        cured_by=_posted(simulation=_BODIES),
    ),
    Cure(
        "SIM110",
        "unknown_but_near",
        _posted(simulation={**_BODIES, "cel": 2.0}),
        "",
        (),
        cured_by=_posted(simulation=_BODIES),
    ),
    Cure("SIM116", "several_setups", _shared, TWO, ((TWO, ONE),)),
    Cure("SIM116", "stops_at_first_finding", _shared, ONE, ({"stop_at": None},), {"stop_at": "first"}),
    Cure(
        "SIM141",
        "cuts_in_other_offset",
        _simulated(),
        ONE.replace("one", "other") + 'work_offset = "G54"\n',
        (("other", "one"),),
    ),
    Cure(
        "SIM141",
        "cuts_in_no_offset",
        _simulated(),
        ONE.replace("one", "bare") + 'work_offset = "G54"\n',
        (("bare", "one"),),
    ),
    Cure(
        "SIM141",
        "place_of_offset_unknown",
        _simulated("part.toml"),
        ONE.replace("one", "two") + "zero_mm = { G54 = [-25, 0, 12] }\n",
        (("12] }", "12], G55 = [-25, 0, 12] }"),),
    ),
    Cure(
        "SIM146",
        "motion_elsewhere",
        _simulated("part.toml"),
        ONE.replace("one", "beside") + "zero_mm = { G54 = [-25, 0, 12] }\n",
        (("12] }", "12], G55 = [-25, 0, 12] }"),),
    ),
    Cure("SIM131", "reaches_mm_beyond", _simulated(), TWO + 'part = "beside.stl"\n', (('"beside.stl"', '"part.stl"'),)),
    Cure("SIM132", "missing_before_this_setup", _simulated(), _HIGH, (("one.ngc", "high.ngc"),)),
    Cure(
        "SIM134",
        "turned_through_surface",
        _simulated(),
        TWO + "pose = { turn_deg = [0, 0, 30], origin_mm = [50, 0, 0] }\n",
        ((" 30]", " 180]"),),
    ),
    Cure("SIM135", "nothing_left_next", _simulated(), TWO.replace("one.ngc", "all.ngc", 1), (("all.ngc", "one.ngc"),)),
    Cure("SIM112", "no_project_of_simulation", _posted_with("part.txt"), ONE, (), cured_by=_posted()),
    Cure("SIM116", "no_meaning_stop", _jobs_read, _JOBS, (('stop_at = "first"\n', ""),)),
    Cure("SIM116", "no_meaning_stop", _jobs_read, _JOBS, (("tiles = 2\n", ""),)),
)
