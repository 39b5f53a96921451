"""Edits that change what a program cuts: slots that touch nothing of each other, beside a clamp, for every machine.

Each cut of these programs takes its own material, and each rapid between them crosses a clamp or stock at its height.
So an edit that moves, lowers, lifts, drops or hurries a cut must show in what is left of the stock.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

import trunnion
from tests.support.recall_proof.bases import MACHINES, Base
from tests.support.recall_proof.edits import Edit, blocks_of, harmful
from tests.support.recall_proof.judges import Told, sound_file
from tests.support.recall_proof.languages import LANGUAGES
from tests.support.recall_proof.parts import operation, rapid, to_feed
from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.surface import stock_surface

_STOCK: Final = "box:60,40,10,-30,-20,-10"
_TOOLS: Final = tuple(f"{tool}=flat:4,length=60,flutes=30" for tool in (1, 2))
_CELL: Final = 1.0

#: What is thinner than this, mm, is no rest: cells are a millimetre wide.
_REST: Final = 0.6

#: Kinds of edits after which a slot is deeper, shallower, elsewhere, missing, or cut in a way that it must not be.
KINDS: Final = frozenset(
    {
        "X: a sign", "Y: a sign", "Z: a sign", "X: left out", "Y: left out", "Z: left out", "X: a digit",
        "X and Y exchanged", "a cut left out", "a cut at rapid", "incremental from here",
        "inches in the cut", "a mirror in the cut", "a scale in the cut", "a rotation in the cut", "a shift in the cut",
        "an offset is written", "an offset is shifted", "an offset over another", "the spindle stops in the cut",
        "no start of the spindle", "the program ends in the cut", "a tool change in the cut", "an unset variable",
        "a coordinate counts from here",
    }
)  # fmt: skip


def slots() -> list[str]:
    """Two operations: slots along X and along Y, one behind the other, at depths of their own."""
    lines = list[str]()
    for k, y in enumerate((-15.0, -8.0, -1.0)):
        z = -2.0 - k
        lines += [*rapid((-24.0, y, 25.0), (-24.0, y, 2.0)), *to_feed(150, (-24.0, y, z))]
        lines += [*to_feed(400, (-4.0 + 3.0 * k, y, z)), *rapid((-4.0 + 3.0 * k, y, 25.0))]
    first = operation("ALONG_X", 1, 2400, _upright(lines))
    lines = []
    for k, x in enumerate((-21.0, 9.0, 24.0)):
        z = -2.5 - k
        lines += [*rapid((x, 6.0, 25.0), (x, 6.0, 2.0)), *to_feed(160, (x, 6.0, z))]
        lines += [*to_feed(380, (x, 12.0 + 2.0 * k, z)), *rapid((x, 12.0 + 2.0 * k, 25.0))]
    return [*first, *operation("ALONG_Y", 2, 2100, _upright(lines))]


def _upright(lines: list[str]) -> list[str]:
    """The lines with the tool axis in their first point."""
    at = next(k for k, line in enumerate(lines) if line.startswith("GOTO"))
    return [*lines[:at], f"{lines[at]},0.0,0.0,1.0", *lines[at + 1 :]]


def clamp() -> TriangleMesh:
    """A clamp on the stock between the slots, higher than the tool is in them."""
    low, high = np.array((13.0, -14.0, 0.0)), np.array((20.0, -4.0, 14.0))
    return TriangleMesh(low + CUBE * (high - low), CUBE_FACES, "clamp")


def removal_bases(folder: Path, family: str | None = None) -> list[Base]:
    """The program of the slots for a machine of each language."""
    cl = folder / "slots.cls"
    cl.write_text("\n".join(["PARTNO/SLOTS", "UNITS/MM", *slots()]) + "\n", encoding="utf-8")
    found = []
    for each, machine in MACHINES.items():
        if family in (None, each):
            program = folder / f"{machine}_slots.nc"
            trunnion.post(cl, machine=machine, output=program)
            found.append(Base(each, program.stem, machine, cl, program.read_text(encoding="utf-8")))
    return found


def removal_edits(base: Base) -> Iterator[Edit]:
    """Yield the harmful edits that must show in what is cut; a height that a rapid has lost need not."""
    blocks = blocks_of(base.text, LANGUAGES[base.family])
    for edit in harmful(base.text, base.family):
        if edit.kind in KINDS and (edit.kind != "Z: left out" or blocks[edit.line - 1].cuts):
            yield edit


@dataclass(frozen=True)
class _Reference:
    part: TriangleMesh
    left: float


@cache
def _reference(base_file: Path, machine: str) -> _Reference:
    """What the sound program makes, and how much of the stock a comparison with itself finds left."""
    part = stock_surface(_simulated(base_file, machine, None).simulation.stock)
    left = _simulated(base_file, machine, part).left
    return _Reference(part, left.largest if left else 0.0)


def _simulated(program: Path, machine: str, part: TriangleMesh | None) -> trunnion.SimulationResult:
    return trunnion.simulate(
        program, machine=machine, stock=_STOCK, tools=_TOOLS, part=part, fixtures=[clamp()], cell=_CELL
    )


def simulate(base: Base, program: Path) -> Told:
    """Whether the simulation finds something, or leaves more of the stock than the sound program."""
    machine = str(base.machine)
    reference = _reference(sound_file(base, program.parent), machine)
    try:
        found = _simulated(program, machine, reference.part)
    except trunnion.TrunnionError as refused:
        return Told(True, type(refused).__name__)
    if not found.passed:
        kinds = {str(each.kind) for each in found.findings} or {"gouge"}
        return Told(True, ", ".join(sorted(kinds)))
    rest = found.left.largest if found.left else 0.0
    return Told(rest > reference.left + _REST, "left over")
