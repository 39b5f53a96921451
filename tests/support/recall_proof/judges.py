"""What Trunnion says of an edited program: by its proof, by a comparison with the sound one, by a conversion."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import trunnion
from tests.support.recall_proof.bases import Base
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer


@dataclass(frozen=True)
class Told:
    """Whether an edit is reported, and how."""

    reported: bool
    by: str


class _Warnings(Observer):
    """What a conversion warns of."""

    def __init__(self) -> None:
        self.codes: list[str] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        """Keep the codes of problems."""
        self.codes += [str(problem.code) for problem in problems]


def proof(base: Base, program: Path) -> Told:
    """Whether the proof against the CL file fails, or names what nobody asked for."""
    try:
        found = trunnion.verify(program, machine=base.machine, cl=base.cl, **base.stated)
    except trunnion.TrunnionError as refused:
        return Told(True, type(refused).__name__)
    unasked = [check.key for check in found.checks if check.key in ("holes", "words") and check.missing]
    failed = [check.key for check in found.checks if not check.passed]
    return Told(bool(failed or unasked), ", ".join(failed or unasked))


def diff(base: Base, program: Path) -> Told:
    """Whether it differs from the sound program."""
    try:
        found = trunnion.diff(sound_file(base, program.parent), program, machine=base.machine)
    except trunnion.TrunnionError as refused:
        return Told(True, type(refused).__name__)
    return Told(not found.same, found.first.text if found.first else "")


#: Text of a CL file, codes of the warnings and settings that come with it.
_Converted: TypeAlias = tuple[str, list[str], dict[str, Any]]


def convert(base: Base, program: Path) -> Told:
    """Whether a CL file of it is refused, comes with other warnings or settings, or is not what the sound one does; or
    whether what is posted from it is not what is posted from that of the sound one.
    """
    sound = sound_file(base, program.parent)
    known = _converted(base, sound)
    if not isinstance(known, tuple):
        raise ValueError(f"{base.name} cannot be converted: {known}")
    found = _converted(base, program)
    if not isinstance(found, tuple):
        return Told(True, found)
    if found[1:] != known[1:]:
        return Told(True, "warnings or settings")
    if _skipped(found[0]) != _skipped(known[0]):
        return Told(True, "OPSKIP")
    cl = program.with_suffix(".cls")
    cl.write_text(found[0], encoding="utf-8")
    against = Base(base.family, base.name, base.machine, cl, base.text, base.stated)
    told = proof(against, sound)
    if told.reported or found[0] == known[0]:
        return told
    return _posted_otherwise(base, known, found, program)


def _posted_otherwise(base: Base, known: _Converted, found: _Converted, program: Path) -> Told:
    """Whether two CL files become different programs: the proof lets a program leave the part before it goes home."""
    posted = [_posted(base, *each[::2], program.parent, name) for each, name in ((known, "known"), (found, "found"))]
    if posted[0] is None or posted[1] is None:
        return Told(posted[0] is not None, "post")
    differs = not trunnion.diff(posted[0], posted[1], machine=base.machine).same
    return Told(differs, "post" if differs else "")


def _posted(base: Base, text: str, settings: dict[str, Any], folder: Path, name: str) -> Path | None:
    """The program of a CL file; None: it is refused."""
    cl, output = folder / f"{name}.cls", folder / f"posted_{name}.{_suffix(base)}"
    cl.write_text(text, encoding="utf-8")
    try:
        trunnion.post(cl, machine=base.machine, output=output, settings=settings)
    except trunnion.TrunnionError:
        return None
    return output


def is_convertible(base: Base, folder: Path) -> bool:
    """Whether the CL file of the sound program is what it does."""
    program = folder / f"try.{_suffix(base)}"
    program.write_bytes(base.text.encode())
    try:
        return not convert(base, program).reported
    except ValueError:
        return False


def _converted(base: Base, program: Path) -> _Converted | str:
    """The CL file of a program with its warnings and settings, or what refuses it."""
    warned = _Warnings()
    stated = {key: value for key, value in base.stated.items() if key in ("zero", "tool_length")}
    try:
        found = trunnion.convert(program, machine=base.machine, to_cl=True, observer=warned, **stated)
    except trunnion.TrunnionError as refused:
        return type(refused).__name__
    return found.text or "", sorted(warned.codes), dict(found.settings)


def _skipped(text: str) -> list[str]:
    """What a CL file lets the operator skip; tool changes are made all the same."""
    found, skips = list[str](), False
    for line in text.splitlines():
        skips = line == "OPSKIP/ON" or (skips and line != "OPSKIP/OFF")
        if skips and line.startswith(("GOTO/", "SPINDL/", "COOLNT/", "CYCLE/", "STOP", "OPSTOP", "DELAY/")):
            found.append(line)
    return found


def _suffix(base: Base) -> str:
    return "h" if base.family == "Heidenhain" else "nc"


def sound_file(base: Base, folder: Path) -> Path:
    """The file of the sound program."""
    return _written(f"{base.family}_{base.name.replace('/', '_')}", base.text, _suffix(base), folder)


@cache
def _written(name: str, text: str, suffix: str, folder: Path) -> Path:
    path = folder / f"sound_{name}.{suffix}"
    path.write_bytes(text.encode())
    return path
