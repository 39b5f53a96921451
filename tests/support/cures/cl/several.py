"""Cures of messages about CL files that are posted together, written by the library, or no CL files at all."""

import io
from collections.abc import Callable, Mapping
from contextlib import chdir
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

import trunnion
from tests.support.cures.cl.more import KNOTS, POLES
from tests.support.cures.conversion.rows import PROGRAMS, converting
from tests.support.cures.cure import Cure, Outcome, Trial, marked, post, read
from tests.support.cures.reading import ended, limited
from tests.support.posting import FOOT, HEAD
from tests.support.program_heads import HEADS
from trunnion.cl import splines
from trunnion.cl.write import write_cl
from trunnion.errors import Problem
from trunnion.jobs.post.post_job import prepare
from trunnion.jobs.post_project.operation_programs import operation_programs
from trunnion.model.toolpath import Phase, Toolpath


def _saved(encoding: str) -> Trial:
    """Return what reads a CL file in an encoding."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        file = folder / "part.cls"
        file.write_bytes(text.encode(encoding))
        return ended(lambda: trunnion.read_cl(file))

    return tried


def _together(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post files that stand in a text one behind the other, each behind a line of equal signs."""
    files = []
    for k, part in enumerate(text.split("=====\n")):
        files.append(folder / f"{k}.cls")
        files[-1].write_text(part, encoding="utf-8")
    heard = list[Problem]()
    return ended(lambda: heard.extend(trunnion.post(files, machine="yl569").problems), heard)


def _changed(change: Callable[[Toolpath], Toolpath]) -> Trial:
    """Return what writes a CL file that was read, changed where a text does not say "as read"."""

    def written(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.cls").write_text(HEAD + "CIRCLE/10,10,5,0,0,1,10\nGOTO/20,10,5\n" + FOOT, encoding="utf-8")
        found = trunnion.read_cl(folder / "part.cls")
        heard = list[Problem]()
        given = found if text == "as read" else change(found)
        return ended(lambda: heard.extend(write_cl(given, io.BytesIO())), heard)

    return written


def _named(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file by its name, or its names."""
    (folder / "a.cls").write_text(HEAD + FOOT, encoding="utf-8")
    heard = list[Problem]()
    files = [folder / name for name in text.split()]
    return ended(lambda: heard.extend(trunnion.post(files, machine="yl569").problems), heard)


def _operation(**changes: Any) -> Callable[[Toolpath], Toolpath]:
    return lambda found: replace(found, operations=tuple(replace(each, **changes) for each in found.operations))


def _begun_with_arc(found: Toolpath) -> Toolpath:
    (operation,) = found.operations
    moves = operation.moves.select(slice(2, None))
    arcs = replace(operation.arcs, row=np.zeros(1, np.int64))
    return replace(found, operations=(replace(operation, moves=moves, arcs=arcs, events=()),))


def _off(found: Toolpath) -> Toolpath:
    (operation,) = found.operations
    arcs = replace(operation.arcs, radius=operation.arcs.radius + 1.0)
    return replace(found, operations=(replace(operation, arcs=arcs),))


def _phases(found: Toolpath) -> Toolpath:
    (operation,) = found.operations
    phase = np.array([Phase.TRAVERSE, Phase.CUT, Phase.DEPARTURE, Phase.APPROACH][: len(operation.moves)], np.uint8)
    return replace(found, operations=(replace(operation, moves=replace(operation.moves, phase=phase)),))


def _given(use: Callable[[Toolpath], object]) -> Trial:
    """Return what uses a toolpath of the library, without motion where a text does not say "as read"."""

    def used(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
        (folder / "part.mpf").write_text(HEADS["yl569"].format(lines="G1 X10 F100"), encoding="utf-8")
        found = trunnion.read_cl(folder / "part.cls")
        empty = replace(
            found,
            operations=tuple(replace(each, moves=each.moves.select(slice(0)), events=()) for each in found.operations),
        )
        with chdir(folder):
            return ended(lambda: use(found if text == "as read" else empty))

    return used


def _divided(found: Toolpath) -> object:
    return operation_programs([found], prepare(trunnion.load_machine("yl569"), {}), Path("out.mpf"))


_NUMBERED: Final = "".join(f"N{k} {line}\n" for k, line in enumerate("".join(PROGRAMS["yl569"]).splitlines(), 1))
_CATIA: Final = (
    "$$*CATIA0\n$$ A\n$$ 1 0 0 {}\n$$ 0 1 0 0\n$$ 0 0 1 0\nFEDRAT/100,MMPM\nSPINDL/900,RPM,CLW\nLOADTL/1\nMULTAX\n"
    "GOTO/1,2,{},0,0,1\nFINI\n"
)
_TWO: Final = _CATIA.format(0, 9) + "=====\n" + _CATIA
_MSYS: Final = "MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000\n"
_SPLINE: Final = HEAD + "\n".join(("NURBS/", *KNOTS, *POLES)) + "\n" + FOOT
_OP2: Final = "TOOL PATH/OP2,TOOL,D10\n"
_STATED: Final = HEAD + FOOT + "=====\n" + (HEAD.replace("OP1", "OP2") + FOOT).replace(_MSYS, "{}")

CURES: Final = (
    Cure("CL110", "begins_block_number", read, _NUMBERED, (), cured_by=converting(machine="yl569", to_cl="yes")),
    Cure("CL150", "unknown_encoding_utf", _saved("utf-16"), HEAD + FOOT, (), cured_by=_saved("utf-8")),
    Cure(
        "CL140",
        "no_operation",
        _changed(lambda found: replace(found, operations=())),
        "changed",
        (("changed", "as read"),),
    ),
    Cure(
        "CL140",
        "no_motion",
        _given(lambda found: trunnion.post(found, machine="yl569")),
        "empty",
        (("empty", "as read"),),
    ),
    Cure("CL140", "nothing_moves", _given(_divided), "empty", (("empty", "as read"),)),
    Cure(
        "NC180",
        "no_motion_compare",
        _given(lambda found: trunnion.verify("part.mpf", machine="yl569", cl=found)),
        "empty",
        (("empty", "as read"),),
    ),
    Cure("CL910", "line_break_control", _changed(_operation(name="A\nB")), "changed", (("changed", "as read"),)),
    Cure("CL910", "operation_begins_arc", _changed(_begun_with_arc), "changed", (("changed", "as read"),)),
    Cure("CL910", "end_arc_lies", _changed(_off), "changed", (("changed", "as read"),)),
    Cure("CL930", "point_another_phase", _changed(_phases), "", (), stays=True),
    Cure("CL430", "points_another_coordinate", _together, _TWO.format(7, 9), (("0 0 7", "0 0 0"),)),
    Cure(
        "CL430", "does_not_state", _together, _STATED.format("").replace("MSYS/0", "MSYS/100"), ((_OP2, _OP2 + _MSYS),)
    ),
    Cure("CL190", "named_twice", _named, "a.cls a.cls", ((" a.cls", ""),)),
    marked("CL210 empty_value", post(), "- SPINDL/RPM,4000,CLW,", "+ SPINDL/RPM,4000,CLW", head=HEAD, foot=FOOT),
    marked(
        "CL210 in_one_line", post(), "- OPSTOP,RAPID", "+ OPSTOP", "+ RAPID", "+ GOTO/20,0,50", head=HEAD, foot=FOOT
    ),
    Cure(
        "CL600", "splines_take_more", limited(post(), splines, "_MAX_POINTS", 20), _SPLINE, ({"spline_tolerance": "1"},)
    ),
)
