"""Cures of checks that need more than a program and its CL file: dynamics, a simulation, a recording, a report."""

import json
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, marked
from tests.support.cures.projects.simulated import CL, ONE, project_written
from tests.support.posting import FOOT, HEAD, LEANING
from tests.support.program_heads import HEADS
from tests.support.recordings import recorded, with_values, written
from trunnion.errors import Problem, TrunnionError
from trunnion.messages import foreign
from trunnion.timing import time_run
from trunnion.verification.results import Check


def _outcome(checks: Iterable[Check], passed: bool) -> Outcome:
    """What checks say: those that failed, and those without a limit of which axes have not enough."""
    said = [each for each in checks if not each.passed or (each.limit is None and (each.worst or 0.0) > 1.0)]
    return Outcome(tuple(Problem("", 0, foreign(each.title, code=each.key)) for each in said), passed)


def _verified(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program on a machine whose definition demands what its proofs stand on."""
    (folder / "ours.toml").write_text(
        'schema = 1\nextends = "yl569"\nname = "Ours"\n[proof]\nrequire = ["zero", "tool_length"]\n', encoding="utf-8"
    )
    (folder / "part.mpf").write_text(text, encoding="utf-8")
    length = float(settings["tool_length"]) if "tool_length" in settings else None
    found = trunnion.verify(
        folder / "part.mpf", machine=folder / "ours.toml", zero=settings.get("zero"), tool_length=length
    )
    return _outcome(found.checks, found.passed)


def _quick(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file for a machine of which rapid speeds and accelerations are known."""
    axes = "".join(f'[[axis]]\nname = "{name}"\nacceleration_mm_s2 = 3000\n' for name in "XYZ")
    axes += "".join(f'[[axis]]\nname = "{name}"\nacceleration_deg_s2 = 900\n' for name in "BC")
    (folder / "ours.toml").write_text(f'schema = 1\nextends = "yl569"\nname = "Ours"\n{axes}', encoding="utf-8")
    (folder / "part.cls").write_text(text, encoding="utf-8")
    try:
        found = trunnion.post(folder / "part.cls", machine=folder / "ours.toml", settings=settings)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return _outcome(found.checks, found.passed)


def _cut(project: str = ONE) -> Trial:
    """Return what posts a CL file and simulates it as a project has it."""

    def cut(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        setup = project_written(project, folder)
        (folder / "part.cls").write_text(text, encoding="utf-8")
        try:
            found = trunnion.post(folder / "part.cls", machine="xyzac_trt", simulation=setup)
        except trunnion.ProofFailedError as error:
            return _outcome(error.result.checks, False)
        return _outcome(found.checks, found.passed)

    return cut


def _reported(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file with a report as data, and return the checks in it that failed."""
    (folder / "part.cls").write_text(text, encoding="utf-8")
    passed = True
    try:
        trunnion.post(folder / "part.cls", machine="yl569", output=folder / "p.mpf", report=folder / "p.json")
    except TrunnionError:
        passed = False
    checks = json.loads((folder / "p.json").read_text(encoding="utf-8"))["checks"]
    failed = [each for each in checks if each["state"] == "FAIL"]
    return Outcome(tuple(Problem("", 0, foreign(each["title"], code=each["key"])) for each in failed), passed)


@cache
def _program(cl: str, machine: str, *settings: tuple[str, str]) -> str:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.cls"
        file.write_text(cl, encoding="utf-8")
        return str(trunnion.post(file, machine=machine, settings=dict(settings)).text)


def _edited(cl: str, machine: str, *settings: tuple[str, str], **given: Any) -> Trial:
    """Return what verifies a posted program in which a text, such as ``F5000 -> F400``, was edited; or nothing."""

    def edited(text: str, no_settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.cls").write_text(cl, encoding="utf-8")
        program = folder / ("part.h" if machine == "dmu65" else "part.mpf")
        old, _, new = text.partition(" -> ")
        posted = _program(cl, machine, *settings)
        assert old in posted, posted
        program.write_text(posted.replace(old, new, 1), encoding="utf-8")
        found = trunnion.verify(program, machine=machine, cl=folder / "part.cls", **given)
        return _outcome(found.checks, found.passed)

    return edited


def _recorded(text: str, _: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program with a recording of it, in which X is off by a number."""
    program = folder / "part.mpf"
    program.write_text(_program(HEAD + FOOT, "yl569"), encoding="utf-8")
    stated: Any = {"zero": (0, 0, 0), "tool_length": 50}
    run = trunnion.verify(program, machine="yl569", **stated).run
    timed = time_run(run)
    made = recorded(timed, np.linspace(0.0, timed.duration, 200))
    file = written(with_values(made, X=made.values["X"] + float(text)), folder / f"off_{text}.csv")
    found = trunnion.verify(program, machine="yl569", recorded=file, **stated)
    return _outcome(found.checks, found.passed)


_FAST: Final = HEAD + "GOTO/20,0,5\nGOTO/40,3,5\nGOTO/41,9,5\n" + FOOT
_NORMALS: Final = (
    HEAD.replace("0.0000,75", "5.0000,75").replace("RAPID\n", "$$ centerline and contact point\nRAPID\n")
    + "GOTO/20,0,5 $$ 20,0,5\nGOTO/40,0,5,0.5,0,0.8660254038 $$ 42.5,0,4.330127\n"
    + FOOT
)
_HEAD, _, _FOOT = CL.partition("GOTO/70,0,-5\n")
_CUTS: Final = "GOTO/70,0,-5"

CURES: Final = (
    Cure("basis", "", _verified, HEADS["yl569"].format(lines="G1 X10 F100"), ({"zero": "0,0,0", "tool_length": "50"},)),
    marked(
        "program", _reported, "- SPINDL/RPM,90000,CLW", "+ SPINDL/RPM,6000,CLW", "GOTO/20,0,5", head=HEAD, foot=FOOT
    ),
    marked(
        "speed",
        _quick,
        "- FEDRAT/MMPM,30000",
        "+ FEDRAT/MMPM,500",
        "GOTO/20,0,5,0.0,0.5,0.8660254",
        head=LEANING,
        foot=FOOT,
    ),
    marked(
        "acceleration",
        _quick,
        "FEDRAT/MMPM,5000",
        *(f"- GOTO/{11 + k},{k % 2},5" for k in range(9)),
        "GOTO/20,0,5",
        head=HEAD,
        foot=FOOT,
    ),
    marked("removal", _cut(), "- RAPID", _CUTS, head=_HEAD, foot=_FOOT),
    marked("collision", _cut(ONE + 'fixtures = ["beside.stl"]\n'), _CUTS, "- GOTO/110,0,-5", head=_HEAD, foot=_FOOT),
    marked(
        "gouge", _cut(ONE + 'part = "part.stl"\n'), "- GOTO/-20,0,-9", "- GOTO/70,0,-9", _CUTS, head=_HEAD, foot=_FOOT
    ),
    Cure(
        "reach",
        "",
        _edited(_FAST, "yl569", ("feed", "fastest"), ("feed_limit", "9000"), feed="fastest", feed_limit=9000),
        "F5050. -> F3000.",
        (("F5050. -> F3000.", ""),),
    ),
    Cure(
        "normal",
        "",
        _edited(_NORMALS, "dmu65", ("normals", "contact"), ("orientation", "vector")),
        "NX+0 NY+0 NZ+1 -> NX+0.6 NY+0 NZ+0.8",
        (("NX+0 NY+0 NZ+1 -> NX+0.6 NY+0 NZ+0.8", ""),),
    ),
    Cure("recorded", "", _recorded, "0.4", (("0.4", "0.0"),)),
)
