"""A reference: draws a Klartext program, and works out by the textbook where each block puts the tool."""

import math
from dataclasses import dataclass, field

import numpy as np
from hypothesis import strategies as st

from trunnion.arrays import Floats


def matrix(a: float, b: float, c: float) -> Floats:
    """Spatial angles, degrees: about the fixed axes X, then Y, then Z."""
    a, b, c = (math.radians(angle) for angle in (a, b, c))
    x = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    y = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
    z = np.array([[math.cos(c), -math.sin(c), 0], [math.sin(c), math.cos(c), 0], [0, 0, 1]])
    return np.asarray(z @ y @ x)


#: A position is a whole number of micrometres, so that text and number are the same.
microns = st.integers(-90_000, 90_000)


@dataclass
class Program:
    """The blocks written so far, and their rows: X Y Z in the workpiece frame, feed, rapid or not."""

    lines: list[str] = field(default_factory=list)
    rows: list[tuple[float, float, float, float, bool]] = field(default_factory=list)
    place: list[int] = field(default_factory=lambda: [0, 0, 0])
    shift: list[int] = field(default_factory=lambda: [0, 0, 0])
    feed: float = math.nan

    def row(self, place: list[float], rapid: bool) -> None:
        """Record the end of a block, in the program's coordinates, um."""
        x, y, z = ((p + s) / 1000.0 for p, s in zip(place, self.shift, strict=True))
        self.rows.append((x, y, z, self.feed, rapid))


def number(draw: st.DrawFn, value: int) -> str:
    """One of the ways to write a number of micrometres."""
    text = f"{abs(value) / 1000.0:.3f}"
    if draw(st.booleans()):
        text = text.rstrip("0")
    if text.startswith("0.") and len(text) > 2 and draw(st.booleans()):
        text = text[1:]
    sign = "-" if value < 0 else draw(st.sampled_from(["", "+"]))
    return sign + (text.replace(".", ",") if draw(st.booleans()) else text)


def line(draw: st.DrawFn, program: Program) -> None:
    """L with any of X Y Z, absolute, incremental or by a parameter."""
    words = []
    end = [float(value) for value in program.place]
    for axis in draw(st.lists(st.sampled_from([0, 1, 2]), min_size=1, max_size=3, unique=True)):
        value = draw(microns)
        how = draw(st.sampled_from(["", "I", "Q"]))
        if how == "Q":
            which = draw(st.integers(1, 9)) + 10 * axis
            program.lines.append(f"Q{which} = {number(draw, value)}")
            words.append(f"{'XYZ'[axis]}{draw(st.sampled_from(['+', '', '-']))}Q{which}")
            program.place[axis] = -value if "-" in words[-1] else value
        else:
            words.append(f"{how}{'XYZ'[axis]}{draw(st.sampled_from(['', ' ']))}{number(draw, value)}")
            program.place[axis] = value + (program.place[axis] if how else 0)
        end[axis] = float(program.place[axis])
    rapid = draw(st.booleans())
    if rapid:
        words.append("FMAX")
    elif draw(st.booleans()):
        program.feed = float(draw(st.integers(1, 9000)))
        words.append(f"F{program.feed:g}")
    if draw(st.booleans()):
        words.insert(draw(st.integers(0, len(words))), "R0")
    program.lines.append("L " + draw(st.sampled_from([" ", "  "])).join(words) + draw(st.sampled_from(["", " ; c"])))
    program.row(end, rapid)


def shift(draw: st.DrawFn, program: Program) -> None:
    """Cycle 7: the axes rest, and the numbers of their positions change."""
    program.lines.append("CYCL DEF 7.0 DATUM SHIFT")
    axes = draw(st.lists(st.sampled_from([0, 1, 2]), min_size=1, max_size=3, unique=True))
    for line, axis in enumerate(axes, start=1):
        value = draw(microns)
        incremental = draw(st.booleans())
        program.lines.append(f"CYCL DEF 7.{line} {'I' if incremental else ''}{'XYZ'[axis]}{number(draw, value)}")
        new = value + (program.shift[axis] if incremental else 0)
        program.place[axis] += program.shift[axis] - new
        program.shift[axis] = new


def arc(draw: st.DrawFn, program: Program) -> None:
    """CC and a half circle by C, or full turns of a helix by CP; both end at whole micrometres."""
    radius = draw(st.integers(1000, 50_000))
    x, y, _ = program.place
    sense = draw(st.sampled_from(["+", "-"]))
    if draw(st.booleans()):
        program.lines.append(f"CC X{number(draw, x + radius)} Y{number(draw, y)}")
    else:
        program.lines.append(f"CC IX{number(draw, radius)} IY+0")
    if draw(st.booleans()):
        program.place[0] += 2 * radius
        program.lines.append(f"C X{number(draw, program.place[0])} DR{sense}")
    else:
        turns = draw(st.integers(1, 5))
        program.place[2] = draw(microns)
        program.lines.append(f"CP IPA{sense}{turns * 360} Z{number(draw, program.place[2])} DR{sense}")
    program.row([float(value) for value in program.place], False)


def repeat(draw: st.DrawFn, program: Program) -> None:
    """A labelled part that is repeated."""
    label = len(program.lines) + 1
    step = draw(st.integers(-999, 999))
    times = draw(st.integers(1, 4))
    program.lines += [f"LBL {label}", f"L IY{number(draw, step)}", f"CALL LBL {label} REP {times}"]
    for _ in range(times + 1):
        program.place[1] += step
        program.row([float(value) for value in program.place], False)


def jump(draw: st.DrawFn, program: Program) -> None:
    """A block that a conditional jump may skip."""
    label = len(program.lines) + 1
    first, second = draw(st.integers(-5, 5)), draw(st.integers(-5, 5))
    number_, word, holds = draw(
        st.sampled_from([(9, "EQU", first == second), (10, "NE", first != second), (11, "GT", first > second)])
    )
    program.lines += [f"FN {number_}: IF {first:+} {word} {second:+} GOTO LBL {label}", "L X+1.5", f"LBL {label}"]
    if not holds:
        program.place[0] = 1500
        program.row([float(value) for value in program.place], False)


@st.composite
def programs(draw: st.DrawFn) -> Program:
    """A program without tilts."""
    program = Program()
    program.lines.append("BEGIN PGM A MM")
    for _ in range(draw(st.integers(1, 12))):
        draw(st.sampled_from([line, line, line, shift, arc, repeat, jump]))(draw, program)
    program.lines.append("END PGM A MM")
    if draw(st.booleans()):
        program.lines = [f"{k} {text}" for k, text in enumerate(program.lines)]
    return program
