"""Cures of messages about programs and bodies that are simulated, placed and shown, and of those that nobody reads."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, define
from tests.support.cures.projects.simulated import ONE, project_written
from tests.support.cures.reading import limited
from tests.support.cures.scripts import looked_at, script
from tests.support.simulating import STOCK, TOOL, cuboid
from trunnion.builder import draft
from trunnion.errors import TrunnionError
from trunnion.families import FAMILIES
from trunnion.jobs.view.viewing import prepare_view
from trunnion.simulation.meshes import TriangleMesh

_CONTOUR: Final = (
    "append part.mpf ''\nedit part.mpf 'G1 X10 F100' 'G41 G1 X10 Y10 F100\\nG1 X30\\nG40 G1 Y30'\n"
    "trunnion place part.mpf --machine yl569 --turn 0 --tool-length 60 --radius-register radius"
)
_AMONG: Final = "trunnion place part.cls --machine generic_head_head_ca --turn 0 --goal collisions"
_VIEW: Final = "trunnion view part.mpf --machine yl569 --output a.html"
_TURNED: Final = (
    "trunnion post part.cls --machine yl569 --turn 30 --output q.mpf\ntrunnion view q.mpf --machine yl569 "
    "--output a.html --stock box:40,40,10,-20,-20,-4 --tool 1=flat:10,length=60,flutes=30 --cell 2"
)
_SHOWN: Final = "--tool 5=flat:4,length=60,flutes=50 --zero 0,0,0 --tool-length 60 --cell 2"
_OURS: Final = 'extends = "yl569"\n'


def _posted(*, simulated: bool) -> Trial:
    """Return what posts a CL file by force for a control whose programs nobody reads; it is sound if one is written."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        project = project_written(ONE, folder)
        given: dict[str, Any] = {"simulation": project} if simulated else {}
        with patch.dict(FAMILIES, linuxcnc=FAMILIES["linuxcnc"]._replace(reader=None)):
            try:
                found = trunnion.post(folder / "part.cls", machine="xyzac_trt", force=True, **given)
            except TrunnionError as error:
                return Outcome(error.problems, False)
        return Outcome(found.problems, bool(found.text))

    return tried


def _viewed(*names: str, machine: str = "xyzac_trt", unread: str = "") -> Trial:
    """Return what prepares a view of files, where the programs of a family are read by nobody."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        project_written(ONE, folder)
        lacking = {unread: FAMILIES[unread]._replace(reader=None)} if unread else {}
        with patch.dict(FAMILIES, lacking):
            try:
                prepare_view([folder / name for name in names], machine=machine)
            except TrunnionError as error:
                return Outcome(error.problems, False)
        return Outcome((), True)

    return tried


def _cut(part: TriangleMesh) -> Trial:
    """Return what cuts a slot above a part."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        project_written(ONE, folder)
        found = trunnion.simulate(
            folder / "one.ngc", machine="xyzac_trt", stock=STOCK, tools=[TOOL], cell=2.0, part=part
        )
        return Outcome(tuple(found.remarks), found.passed)

    return tried


def _judged(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have the builder judge a definition."""
    found = draft.judge(text, folder / "ours.toml")
    return Outcome(found.problems, not found.problems)


_BLOCK: Final = cuboid((0, -20, -10), (50, 20, -5))
_OPEN: Final = TriangleMesh(_BLOCK.vertices, _BLOCK.faces[:-1])
_VIEW_CL: Final = _viewed("part.cls")

CURES: Final = (
    Cure("SIM115", "program_not_read", _posted(simulated=True), "", (), cured_by=_posted(simulated=False)),
    Cure(
        "SIM214",
        "rays_pass_hole",
        _cut(_OPEN),
        "",
        (),
        cured_by=_cut(_BLOCK),
    ),
    script("SIM147 radius_not_known", _CONTOUR, "--turn", "--tool 5=flat:10,length=60 --turn"),
    script(
        "SIM175 unit_not_known",
        "write tool.tbl 'T3 P3 D10'\ntrunnion check tool.tbl",
        "check tool.tbl",
        "verify part.mpf --machine yl569 --tool-library tool.tbl --unit mm",
    ),
    script("SIM310 length_of_tool_unknown", _AMONG, "--turn", "--tool-length 60 --turn"),
    Cure("PAG112", "no_cl_file_as_others", _viewed("part.cls", "one.ngc"), "", (), cured_by=_VIEW_CL),
    Cure(
        "PAG114",
        "control_without_reader",
        _viewed("part.cls", unread="linuxcnc"),
        "",
        (),
        cured_by=_viewed("part.cls", machine="yl569", unread="linuxcnc"),
    ),
    looked_at("PAG116 bodies_clamped_otherwise", _TURNED),
    script(
        "PAG121 too_large_shown",
        f"{_VIEW} {_SHOWN} --stock box:900,900,90,-450,-450,-90",
        "--stock box:900,900,90,-450,-450,-90",
        "--stock box:20,20,4,-10,-10,-4",
    ),
    script(
        "PAG121 too_large_shown",
        f"{_VIEW} {_SHOWN} --stock box:900,900,90,-450,-450,-90",
        f"{_SHOWN} --stock box:900,900,90,-450,-450,-90",
        "",
    ),
    Cure(
        "PAG213",
        "letters_more_not",
        limited(_judged, draft, "MOST_LETTERS", 20),
        _OURS * 1 + "# a shop's own\n",
        (),
        cured_by=define,
    ),
)
