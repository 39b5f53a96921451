"""Cures of messages about what a project asks for once its programs are proven, and about programs of operations."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.projects.simulated import CL, project_written
from tests.support.cures.reading import ended
from tests.support.cures.scripts import script
from tests.support.projects import operation
from trunnion.errors import TrunnionError
from trunnion.jobs.post_project import checks
from trunnion.jobs.post_project.cases import posted_case

_POSTED: Final = 'cl = ["part.cls"]\noutput = "part.nc"\nmachine = "xyzac_trt"\n'
_WHOLE: Final = (
    'stock = "box:50,40,10,0,-20,-10"\ntools = ["1=flat:10,length=60,flutes=20"]\ncell_mm = 2\n'
    f'part = "whole.stl"\n{_POSTED}[checks]\nsimulate = "refuse"\n'
)
_HIGH: Final = "GOTO/-20,0,0\nGOTO/70,0,0\n"
_LOW: Final = "GOTO/-20,0,-5\nGOTO/70,0,-5\n"
_BACK: Final = "GOTO/70,0,20\nGOTO/70,15,20\nGOTO/70,15,-5\nGOTO/-20,15,-5\nGOTO/-20,15,20\n"
# Twelve holes in the part, far enough from each other along the path to be findings of their own.
_PLUNGES: Final = "".join(
    f"GOTO/{x},{y},5\nGOTO/{x},{y},-3\nGOTO/{x},{y},5\n" + f"GOTO/{x},-60,5\nGOTO/{x},60,5\n" * 3
    for x in (6, 19, 32, 45)
    for y in (-14, 0, 14)
)
_DIVIDED: Final = 'machine = "yl569"\ncl = ["a.cls", "b.cls"]\noutput = "out.mpf"\ndivide = "operations"\n'
_ON: Final = "CUTCOM/LEFT\n"


def _post(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a project whose simulation judges it; the text is that of the CL file, and of the project behind a line."""
    cl, _, project = text.rpartition("#END\n")
    path = project_written(project, folder)
    (folder / "part.cls").write_text(cl or CL, encoding="utf-8")
    try:
        found = trunnion.post_project(path)
    except TrunnionError as error:
        return Outcome(error.problems, False)
    return Outcome(found.problems, not found.problems)


def _seen(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a project that warns, and simulate what was written; all findings are there then."""
    _post(text, settings, folder)
    found = trunnion.simulate(folder / "part.toml")
    return Outcome((), len(found.findings) > 10)


def _without_places(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a project whose simulation is taken to blame no line for what is missing.

    No project is known that does so: what the stock lacks is said before (SIM131, SIM132), and a row that takes metal
    from the part is found even where it takes all of it. The cure needs no such simulation.
    """
    simulate = checks._simulate
    with patch.object(checks, "_simulate", lambda *given: replace(simulate(*given), findings=())):
        return _post(text, settings, folder)


def _seen_missing(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """The same; what is missing from the part is there then."""
    _post(text, settings, folder)
    found = trunnion.simulate(folder / "part.toml")
    return Outcome((), found.gouge is not None and found.gouge.largest > 1.0)


def _accepted(*, changes: bool) -> Trial:
    """Return what accepts the programs of a case, of which somebody writes a CL file meanwhile."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "a.cls").write_text(operation("A"), encoding="utf-8")
        path = folder / "case.toml"
        path.write_text(_DIVIDED.replace(', "b.cls"', ""), encoding="utf-8")
        with posted_case(path) as case:
            if changes:
                (folder / "a.cls").write_text(operation("B"), encoding="utf-8")
            return ended(case.accept)

    return tried


def _project(message: str, old: str, new: str, text: str = _DIVIDED, **cl: str) -> Cure:
    """A project of operations in files, and what stands in place of a part of it or of them."""
    lines = [f"write {name}.cls '{content}'\n" for name, content in cl.items()]
    told = "".join([*lines, f"write p.toml '{text}'\n"]).replace("\n", "\\n").replace("'\\n", "'\n")
    return script(message, f"{told}trunnion post p.toml", *(each.replace("\n", "\\n") for each in (old, new)))


_OVER: Final = CL.replace("GOTO/-20,0,20,0,0,1", "GOTO/20,0,20,0,0,1")
_THICK: Final = f'{_OVER}#END\nstock = "box:50,40,90,0,-20,-10"\n{_POSTED}'
_CLAMPED: Final = _WHOLE.replace("part =", 'fixtures = ["beside.stl"]\npart =')
_TWO: Final = f'[[setup]]\nname = "one"\n{_POSTED}[[setup]]\nname = "two"\n{_POSTED.replace("part.nc", "two.nc")}'
_TWICE: Final = _WHOLE.replace(_POSTED, _TWO)
_JUDGED: Final = '[checks]\nsimulate = "refuse"\n'

CURES: Final = (
    Cure("PRJ240", "rapid_through_stock", _post, _THICK, (("box:50,40,90", "box:50,40,10"),)),
    Cure(
        "PRJ240",
        "stock_not_checked",
        _post,
        f"{CL.replace(_LOW, _HIGH)}#END\n{_TWICE.replace(_JUDGED, '')}",
        ((_TWO, _TWO + _JUDGED),),
    ),
    Cure("PRJ240", "rapid_through_stock", _post, _THICK, (("GOTO/20,0,20", "GOTO/20,0,90"),)),
    Cure(
        "PRJ240",
        "fixtures_not_checked",
        _post,
        f"{CL.replace(_LOW, _HIGH)}#END\n{_CLAMPED.replace(_JUDGED, '')}",
        ((_POSTED, _POSTED + _JUDGED),),
    ),
    _project("PRJ140 leaves_something_on", _ON, "", a=operation("A", end=_ON), b=operation("B")),
    _project("PRJ140 leaves_something_on", 'divide = "operations"\n', "", a=operation("A", end=_ON), b=operation("B")),
    _project(
        "PRJ140 other_coordinate_system",
        "divide",
        'settings = { frame = "absolute" }\ndivide',
        a=operation("A"),
        b=operation("B", origin="5.0,0.0,0.0"),
    ),
    _project(
        "PRJ140 other_coordinate_system",
        'divide = "operations"\n',
        "",
        a=operation("A"),
        b=operation("B", origin="5.0,0.0,0.0"),
    ),
    _project(
        "PRJ230 takes_at_least_too_long",
        "longest_s = 0.1",
        "longest_s = 100",
        text=_DIVIDED.replace("yl569", "dmu65").replace(".mpf", ".h") + "[checks]\nlongest_s = 0.1\n",
        a=operation("A"),
        b=operation("B"),
    ),
    Cure("PRJ210", "", _post, _WHOLE, ((_WHOLE, f"{CL.replace(_LOW, _HIGH)}#END\n{_WHOLE}"),)),
    Cure(
        "PRJ210",
        "more_findings",
        _post,
        f"{CL.replace(_LOW, _HIGH + _PLUNGES)}#END\n{_WHOLE}",
        (('"refuse"', '"warn"'),),
        cured_by=_seen,
    ),
    Cure(
        "PRJ210",
        "missing_from_part",
        _without_places,
        _WHOLE,
        (('"refuse"', '"warn"'),),
        cured_by=_seen_missing,
    ),
    Cure("PRJ160", "changed_since_compared", _accepted(changes=True), "", (), cured_by=_accepted(changes=False)),
)
