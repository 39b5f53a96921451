"""Defects put into sound programs, to see whether the simulation finds them, and in which block.

A program is lines of text and the moves of the tool in them. A golden program is changed in its own text; a plate in
its CL file, which is posted again, and its findings count by the lines of the CL file. The design is what the sound
program leaves of the stock, cut in cells of half the width; a place for a gouge is taken where the tool at the end of
a block touches that design, with so much of it behind, in cells of half the width too, that the depth is known.
"""

import random
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

import trunnion
from trunnion.arrays import Floats
from trunnion.jobs.inputs.reading import as_machine, as_run
from trunnion.model.toolpath import Kind
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans
from trunnion.simulation.stock.surface import stock_surface

DEPTHS: Final = (0.25, 0.5, 1.0, 2.0, 4.0)
WAYS: Final = ("plane", "wall", "tilted")

#: What a gouge is told as.
GOUGE: Final = ("gouge",)
_AXES_WORDS: Final = re.compile(r"\s*(?<![A-Z_])[XYZ]\s*-?[\d.]+")


@dataclass(frozen=True, slots=True)
class Move:
    """A block: index of its line, tip and axis at its end, its tool and ``Kind``."""

    line: int
    tip: Floats
    axis: Floats
    tool: str
    kind: int


@dataclass(frozen=True, slots=True)
class Sound:
    """A sound program and how it is simulated."""

    name: str
    machine: str
    lines: tuple[str, ...]
    moves: tuple[Move, ...]
    stock: str
    tools: tuple[str, ...]
    cell: float
    suffix: str

    @property
    def is_cl(self) -> bool:
        """Whether its lines are those of a CL file, which is posted."""
        return self.suffix == ".cls"

    def radius(self, tool: str) -> tuple[float, bool]:
        """Radius of a tool, and whether it is a ball mill."""
        text = next(text for text in self.tools if text.startswith(f"{tool or 0}="))
        kind, diameter = text.partition("=")[2].split(",")[0].split(":")
        return 0.5 * float(diameter), kind == "ball"


@dataclass(frozen=True, slots=True)
class Defect:
    """A program with one defect: its lines, the lines (from 1) that do it, and what it may be told as."""

    kind: str
    cells: float
    sound: Sound
    right: tuple[int, int]
    told_as: tuple[str, ...] = GOUGE
    fixtures: tuple[TriangleMesh, ...] = ()
    accuracy: float | None = None
    mm: float = 0.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a defect: told depth in mm, and findings that it does not explain."""

    defect: Defect
    found: bool
    right: bool
    depth: float
    invented: tuple[str, ...]


# Programs.


def program(name: str, machine: str, text: str, stock: str, tools: Sequence[str], cell: float, folder: Path) -> Sound:
    """An NC program that is sound, with the moves that the control makes of it."""
    path = folder / f"{name}.nc"
    path.write_text(text, encoding="utf-8")
    run = as_run(path, as_machine(machine), ())
    moves = [
        Move(int(run.line[k]) - 1, run.tip[k], run.axis[k], run.tools[int(run.tool[k])], int(run.kind[k]))
        for k in range(len(run))
    ]
    return Sound(name, machine, tuple(text.splitlines()), tuple(moves), stock, tuple(tools), cell, ".nc")


def _cl_line(tip: Floats, axis: Floats) -> str:
    return "GOTO/" + ",".join(f"{value:.6f}" for value in (*tip, *axis))


def plate(machine: str, cell: float) -> Sound:
    """Two pockets from above, and a slope on either side: by a ball from one, by a flat mill from the other."""
    lines, moves = list[str](), list[Move]()
    upright, right, left = (np.array(axis) for axis in ((0, 0, 1), (0.5, 0, 0.75**0.5), (-0.5, 0, 0.75**0.5)))

    def begin(name: str, tool: str, corner: float, width: float) -> None:
        lines.extend((f"TOOL PATH/{name},TOOL,D{width:g}", f"TLDATA/MILL,{width:.4f},{corner:.4f},75.0,0.0,0.0"))
        lines.append("MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0")
        lines.extend((f"LOAD/TOOL,{tool},ADJUST,{tool}", "SPINDL/RPM,2000.0,CLW"))

    def go(kind: int, tool: str, axis: Floats, *tips: Floats) -> None:
        lines.append("RAPID" if kind == Kind.RAPID else "FEDRAT/MMPM,200.0")
        for number, tip in enumerate(tips):
            if kind == Kind.RAPID and number:
                lines.append("RAPID")
            moves.append(Move(len(lines), tip, axis, tool, int(kind)))
            lines.append(_cl_line(tip, axis))

    begin("POCKETS", "1", 0.0, 10.0)
    for x in (-20.0, 20.0):
        go(Kind.RAPID, "1", upright, np.array((x, 0.0, 3.0)))
        for z in (-3.0, -6.0):
            ring = [(x, 0), (x - 5, -10), (x + 5, -10), (x + 5, 10), (x - 5, 10), (x - 5, -10), (x, 0)]
            go(Kind.LINEAR, "1", upright, *(np.array((a, b, z)) for a, b in ring))
        go(Kind.RAPID, "1", upright, np.array((x, 0.0, 3.0)))
    go(Kind.RAPID, "1", upright, np.array((20.0, 0.0, 40.0)))
    lines.append("END-OF-PATH")
    for name, tool, axis, width, step in (("BALL", "2", right, 6.0, 0.8), ("FLAT", "3", left, 8.0, 4.0)):
        begin(name, tool, 3.0 if name == "BALL" else 0.0, width)
        side = float(np.sign(axis[0]))
        down = np.array((side * 0.75**0.5, 0.0, -0.5))
        starts = [np.array((side * 32.0, 0.0, 0.0)) + t * down for t in np.arange(1.0, 11.0, step)]
        y = 1.0
        go(Kind.RAPID, tool, axis, starts[0] + np.array((0.0, -38.0, 0.0)) + 30.0 * axis)
        path = [starts[0] + np.array((0.0, -38.0, 0.0))]
        for start in starts:
            path += [start + np.array((0.0, -38.0 * y, 0.0)), start, start + np.array((0.0, 38.0 * y, 0.0))]
            y = -y
        go(Kind.LINEAR, tool, axis, path[0], *path[2:])
        go(Kind.RAPID, tool, axis, path[-1] + 30.0 * axis)
        lines.append("END-OF-PATH")
    tools = ("1=flat:10,length=75,flutes=40", "2=ball:6,length=75,flutes=40", "3=flat:8,length=75,flutes=40")
    stock = "box:80,60,20,-40,-30,-20"
    return Sound(f"plate on {machine}", machine, tuple(lines), tuple(moves), stock, tools, cell, ".cls")


# Simulating.


def simulated(
    sound: Sound,
    folder: Path,
    part: TriangleMesh | None = None,
    fixtures: Sequence[TriangleMesh] = (),
    cell: float | None = None,
    accuracy: float | None = None,
    spindle: bool = True,
) -> trunnion.SimulationResult:
    """Simulate a program."""
    source, nc = folder / f"recall{sound.suffix}", folder / "recall.nc"
    source.write_text("\n".join(sound.lines) + "\n", encoding="utf-8")
    cl: list[Path] = []
    if sound.is_cl:
        trunnion.post(source, machine=sound.machine, output=nc, force=True)
        cl = [source]
    if not spindle:
        text = nc.read_text(encoding="utf-8")
        nc.write_text(re.sub(r"(?<![A-Z])M0?3\b", "M5", text), encoding="utf-8")
    return trunnion.simulate(
        nc, machine=sound.machine, stock=sound.stock, tools=sound.tools, part=part, fixtures=fixtures,
        cell=cell or sound.cell, accuracy=accuracy, cl=cl,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Reference:
    """What a sound program leaves, in cells of half the width: as stock and as the mesh of the design."""

    stock: Stock
    mesh: TriangleMesh
    spans: tuple[Spans, ...]

    @staticmethod
    def of(sound: Sound, folder: Path) -> "Reference":
        """Cut it."""
        stock = simulated(sound, folder, cell=0.5 * sound.cell).simulation.stock
        return Reference(stock, stock_surface(stock), tuple(stock.spans(bundle) for bundle in range(3)))

    def solid(self, points: Floats, along: Floats) -> bool:
        """Whether all points (n, 3) are in the material, by the rays that are steepest to a surface's normal."""
        bundle = int(np.abs(along).argmax())  # the bundle whose rays run along this axis
        u, v, w = BUNDLE_AXES[bundle]
        lattice, spans = self.stock.lattice, self.spans[bundle]
        cells = np.floor((points - lattice.low) / lattice.cell).astype(np.int64)
        if (cells < 0).any() or (cells >= np.array(lattice.counts)).any():
            return False
        for cell, height in zip(cells, points[:, w], strict=True):
            ray = int(cell[u] * lattice.counts[v] + cell[v])
            ends = spans.ends[2 * spans.first[ray] : 2 * spans.first[ray + 1]]
            if np.searchsorted(ends, height) % 2 == 0:
                return False
        return True


def outcome(defect: Defect, reference: Reference, folder: Path) -> Outcome:
    """Simulate a program with a defect, and judge what is told."""
    found = simulated(defect.sound, folder, reference.mesh, defect.fixtures, accuracy=defect.accuracy)
    first, last = defect.right
    hits, others, right = [], [], False
    for each in found.findings:
        line, end = each.line, each.last_line
        if defect.sound.is_cl:
            line = end = each.cl_line
        here = first <= line <= last
        if each.kind in defect.told_as:
            hits.append(each.depth)
            right = right or here
        if not here and not (line <= last and end >= first):
            others.append(f"{each.kind} in line {each.line}, {each.depth:.3f} mm")
    return Outcome(defect, bool(hits), right, max(hits, default=0.0), tuple(others))


# Gouges.


def _sideways(move: Move, before: Move) -> Floats | None:
    """Across the way of the tool and its axis."""
    side = np.cross(move.tip - before.tip, move.axis)
    length = float(np.linalg.norm(side))
    return side / length if length > 0.05 else None


def directions(way: str, move: Move, before: Move, is_ball: bool) -> Iterator[tuple[Floats, float]]:
    """Yield unit directions into the design, and how far to go in them for a depth of 1."""
    if way == "plane":
        yield -move.axis, 1.0
        return
    side = _sideways(move, before)
    if side is None:
        return
    for sign in (1.0, -1.0):
        if way == "wall":
            yield sign * side, 1.0
        else:
            tilted = (sign * side - move.axis) / 2.0**0.5
            yield tilted, 1.0 if is_ball else 2.0**0.5


def contacts(sound: Sound, move: Move, way: str, along: Floats) -> list[tuple[Floats, Floats]]:
    """Points of the tool that go into the design first, and the normals there."""
    radius, is_ball = sound.radius(move.tool)
    if is_ball:
        return [(move.tip + radius * move.axis + radius * along, along)]
    aside = along - (along @ move.axis) * move.axis
    if way == "plane":
        return [(move.tip, -move.axis)]
    aside /= np.linalg.norm(aside)
    up = 2.5 * sound.cell * move.axis
    wall = (move.tip + radius * aside + up, aside)
    return [wall] if way == "wall" else [wall, (move.tip + (radius - 2.5 * sound.cell) * aside, -move.axis)]


def _is_clear(sound: Sound, reference: Reference, move: Move, way: str, along: Floats, depth: float) -> bool:
    """Whether there is material all around behind the places that the tool touches."""
    cell = sound.cell
    for point, normal in contacts(sound, move, way, along):
        one = np.cross(normal, (0.3, 0.5, 0.8))
        one /= np.linalg.norm(one)
        two = np.cross(normal, one)
        steps = np.arange(0.15 * cell, depth + 1.5 * cell, 0.25 * cell)
        points = [point + step * normal for step in steps]
        if reference.solid(np.array([point - 0.4 * cell * normal]), normal):
            return False
        for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            aside = 1.5 * cell * (a * one + b * two)
            points += [point + aside + step * normal for step in steps[steps > 0.45 * cell]]
        if not reference.solid(np.array(points), normal):
            return False
    return True


def moved(sound: Sound, first: int, last: int, by: Floats) -> tuple[tuple[str, ...], tuple[int, int]]:
    """The lines with the moves ``first`` to ``last`` shifted, one there and one back, and which lines these are."""
    before, end, lines = sound.moves[first - 1], sound.moves[last], list(sound.lines)
    for move in sound.moves[first : last + 1]:
        lines[move.line] = _written(sound, lines[move.line], move.tip + by, move.axis)
    back = _step(sound, lines[end.line], end.tip, end.axis)
    to = _step(sound, lines[end.line], before.tip + by, before.axis)
    lines.insert(end.line + 1, back)
    at = sound.moves[first].line
    lines.insert(at, to)
    return tuple(lines), (at + 1, end.line + 3)


def moved_all(sound: Sound, by: Callable[[Move], Floats]) -> tuple[str, ...]:
    """The lines with every move at feed shifted, and the rapids before and after with them."""
    lines, moves = list(sound.lines), sound.moves
    for k, move in enumerate(moves):
        if any(each.kind != Kind.RAPID for each in moves[max(0, k - 1) : k + 1]):
            lines[move.line] = _written(sound, lines[move.line], move.tip + by(move), move.axis)
    return tuple(lines)


def _words(tip: Floats) -> str:
    return "X{:.5f} Y{:.5f} Z{:.5f}".format(*tip)


def _written(sound: Sound, line: str, tip: Floats, axis: Floats) -> str:
    """A block with another end."""
    if sound.is_cl:
        return _cl_line(tip, axis)
    number = re.match(r"N\d+ ", line)
    start = number.group() if number else ""
    rest = line[len(start) :]
    words = re.match(r"(G\d+ ?)*", rest)
    verbs = words.group() if words else ""
    return f"{start}{verbs.strip()} {_words(tip)} {_AXES_WORDS.sub('', rest[len(verbs) :]).strip()}".rstrip()


def _step(sound: Sound, like: str, tip: Floats, axis: Floats) -> str:
    """A new block at feed; inverse time needs its F again."""
    if sound.is_cl:
        return _cl_line(tip, axis)
    feed = re.search(r"F\s*[\d.]+", like) if "LinuxCNC" in sound.name else None
    return f"G1 {_words(tip)} {feed.group() if feed else ''}".rstrip()


def _can_move(sound: Sound, first: int, last: int) -> bool:
    moves = sound.moves
    if first < 1 or last + 1 >= len(moves) or any(move.kind == Kind.RAPID for move in moves[first - 1 : last + 2]):
        return False
    numbers = [move.line for move in moves[first : last + 1]]
    if len(set(numbers)) < len(numbers):
        return False
    arcs = (move for move in moves[first : last + 2] if move.kind == Kind.ARC)
    return all(re.search(r"G0?[23]\b", sound.lines[move.line]) for move in arcs)


def gouges(sound: Sound, reference: Reference, each: int, seed: int = 1) -> Iterator[Defect]:
    """Yield up to ``each`` gouges of every depth, way and number of blocks."""
    rng = random.Random(f"{sound.name} {seed}")
    for way in WAYS:
        for blocks in (1, 3):
            order = list(range(1, len(sound.moves) - 1))
            for cells in DEPTHS:
                rng.shuffle(order)
                count = 0
                for row in order:
                    if count == each:
                        break
                    made = _gouge(sound, reference, way, blocks, cells, row)
                    if made is not None:
                        count += 1
                        yield made


def _gouge(sound: Sound, reference: Reference, way: str, blocks: int, cells: float, row: int) -> Defect | None:
    if not _can_move(sound, row, row + blocks - 1):
        return None
    move, depth = sound.moves[row], cells * sound.cell
    for along, far in directions(way, move, sound.moves[row - 1], sound.radius(move.tool)[1]):
        if _is_clear(sound, reference, move, way, along, depth):
            lines, right = moved(sound, row, row + blocks - 1, depth * far * along)
            name = f"gouge, {way}, {'one block' if blocks == 1 else 'three blocks'}"
            return Defect(name, cells, replace(sound, lines=lines), right, mm=depth)
    return None


def cut_depths(sound: Sound, folder: Path) -> dict[int, float]:
    """How deep each move of a sound program cuts, mm, by the number of the move; 0 where that is not known.

    The spindle is stopped from the beginning, so that every block that cuts is told; of a run of blocks the worst.
    """
    found = simulated(sound, folder, spindle=False)
    lines = {move.line + 1: k for k, move in enumerate(sound.moves)}
    told = {(each.cl_line if sound.is_cl else each.line): each.depth for each in found.findings}
    return {lines[line]: depth for line, depth in told.items() if line in lines}
