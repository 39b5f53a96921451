"""LinuxCNC's stand-alone interpreter as the judge of programs: the motions it prints for each block."""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats

#: Where CI runs, the judge must be there: ``.ci/run`` installs it.
needs_linuxcnc = pytest.mark.skipif(
    shutil.which("rs274") is None and not os.environ.get("CI"),
    reason="LinuxCNC is not installed (Debian package linuxcnc-uspace)",
)

#: Length of every tool in the table of ``interpret``, mm.
LENGTH = 25.4

#: Folder of a program's subroutines.
SUBROUTINES = "subroutines"

_CALL = re.compile(r"^\s*\d+\s+N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")
_NUMBER = re.compile(r"(?<![A-Z])-?\d+(?:\.\d+)?")
_PLANES = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (2, 0, 1)}


@dataclass(frozen=True)
class Move:
    """One motion with its modal state.

    end      X Y Z A B C in the program's coordinates and units, and degrees
    unit     mm of the program's unit
    machine  the same as positions of the machine, mm and degrees: with all offsets but the tool's length
    feed     in units of the program; of a thread, pitch times speed
    centre   of arcs, in the two coordinates of their plane
    middle   of arcs, the same as positions of the machine, mm
    turns    of arcs, whole and begun ones; negative: clockwise
    normal   of arcs, 0 for X
    offset   the tool's length counts
    tcp      the kinematics are those of the tip
    """

    kind: str
    end: tuple[float, ...]
    feed: float
    feed_mode: int
    rpm: float
    sense: int
    coolant: frozenset[str]
    offset: bool
    tcp: bool
    centre: tuple[float, float] = (0.0, 0.0)
    turns: int = 0
    normal: int = 2
    unit: float = 1.0
    machine: tuple[float, ...] = ()
    middle: tuple[float, float] = (0.0, 0.0)


@dataclass
class Canon:
    """Everything a program did; ``notes`` are dwells, stops and messages, each with the moves before it."""

    moves: list[Move] = field(default_factory=list)
    notes: list[tuple[int, str, str]] = field(default_factory=list)

    @property
    def dwells(self) -> list[float]:
        """Seconds of each."""
        return [float(_NUMBER.findall(inside)[0]) for _, name, inside in self.notes if name == "DWELL"]


class RefusedByLinuxcncError(Exception):
    """The interpreter refuses a program; the message is its own."""


def interpret(text: str, folder: Path, coordinates: str = "XYZABC") -> Canon:
    """Run a program in the interpreter of a machine whose M428 and M429 switch its kinematics.

    The tools 1 to 99 are in the table. Subroutines are looked for in ``SUBROUTINES`` of the folder.
    """
    program, ini = folder / "part.ngc", folder / "judge.ini"
    program.write_text(text, encoding="utf-8")
    remaps = folder / "remaps"
    remaps.mkdir(exist_ok=True)
    for code, kinematics in ((428, 1), (429, 0)):
        body = f"M68 E3 Q{kinematics}\nM66 E0 L0"
        (remaps / f"m{code}.ngc").write_text(f"o<m{code}> sub\n{body}\no<m{code}> endsub\n")
    ini.write_text(
        f"[RS274NGC]\nSUBROUTINE_PATH = {remaps}:{folder / SUBROUTINES}\n"
        "REMAP = M428 modalgroup=10 ngc=m428\nREMAP = M429 modalgroup=10 ngc=m429\n"
        f"[TRAJ]\nCOORDINATES = {' '.join(coordinates)}\nLINEAR_UNITS = mm\n"
    )
    # the stand-alone interpreter takes the lengths in the table to be inches
    table = "".join(f"T{k} P{k} Z{LENGTH / 25.4} D0.2\n" for k in range(1, 100))
    return _read(_judged(program, table, "-i", str(ini)))


def canonical(program: Path) -> Canon:
    """Run a program without a machine; its tools 1 to 9 have no length."""
    return _read(_judged(program, "".join(f"T{k} P{k} Z0 D{k}\n" for k in range(1, 10))))


def _judged(program: Path, tools: str, *arguments: str) -> str:
    """The output of the interpreter for a program, with a tool table."""
    folder = program.parent
    table, variables = folder / "judge.tbl", folder / "judge.var"
    table.write_text(tools)
    variables.unlink(missing_ok=True)
    done = subprocess.run(
        ["rs274", "-g", *arguments, "-v", str(variables), "-t", str(table), str(program)],
        capture_output=True,
        check=False,
        timeout=120,
        env={**os.environ, "HOME": str(folder)},
    )
    if done.returncode:
        raise RefusedByLinuxcncError(done.stderr.decode(errors="replace"))
    return done.stdout.decode(errors="replace")


@dataclass
class _Offsets:
    """From the program's coordinates to positions of the machine."""

    unit: float = 1.0
    system: Floats = field(default_factory=lambda: np.zeros(6))
    shift: Floats = field(default_factory=lambda: np.zeros(6))
    angle: float = 0.0

    def in_units(self, unit: float) -> None:
        self.system[:3] *= self.unit / unit
        self.shift[:3] *= self.unit / unit
        self.unit = unit

    def machine(self, point: tuple[float, ...]) -> tuple[float, ...]:
        p = np.array(point) + self.shift
        cos, sin = np.cos(np.radians(self.angle)), np.sin(np.radians(self.angle))
        p[:2] = cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]
        p += self.system
        p[:3] *= self.unit
        return tuple(float(value) for value in p)


def _read(text: str) -> Canon:
    canon, offsets = Canon(), _Offsets()
    feed = rpm = pitch = 0.0
    feed_mode = sense = 0
    coolant: frozenset[str] = frozenset()
    offset = tcp = False
    plane = "XY"
    here: tuple[float, ...] = (0.0,) * 6

    def move(kind: str, end: tuple[float, ...], rate: float) -> Move:
        state = feed_mode, rpm, sense, coolant, offset, tcp
        return Move(kind, end, rate, *state, unit=offsets.unit, machine=offsets.machine(end))

    for line in text.splitlines():
        match = _CALL.match(line)
        if match is None:
            continue
        name, inside = match.groups()
        numbers = [float(value) for value in _NUMBER.findall(inside)] if name not in ("COMMENT", "MESSAGE") else []
        match name:
            case "USE_LENGTH_UNITS":
                offsets.in_units(1.0 if "MM" in inside else 25.4)
            case "SET_G5X_OFFSET":
                offsets.system = np.array(numbers[1:7])
            case "SET_G92_OFFSET":
                offsets.shift = np.array(numbers[:6])
            case "SET_XY_ROTATION":
                offsets.angle = numbers[0]
            case "SET_FEED_RATE":
                feed = numbers[0]
            case "SET_FEED_MODE":
                feed_mode = int(numbers[1])
            case "SET_SPINDLE_SPEED":
                rpm = numbers[1]
            case "START_SPINDLE_CLOCKWISE":
                sense = 1
            case "START_SPINDLE_COUNTERCLOCKWISE":
                sense = -1
            case "STOP_SPINDLE_TURNING":
                sense = 0
            case "START_SPEED_FEED_SYNC":
                pitch = numbers[0]
            case "FLOOD_ON" | "MIST_ON":
                coolant |= {name.removesuffix("_ON")}
            case "FLOOD_OFF" | "MIST_OFF":
                coolant -= {name.removesuffix("_OFF")}
            case "USE_TOOL_LENGTH_OFFSET":
                offset = any(numbers)
            case "SET_AUX_OUTPUT_VALUE":
                tcp = numbers[1] == 1.0
            case "SELECT_PLANE":
                plane = inside.removeprefix("CANON_PLANE_").removeprefix("CANON_PLANE::")
            case "DWELL" | "PROGRAM_STOP" | "OPTIONAL_PROGRAM_STOP" | "MESSAGE":
                canon.notes.append((len(canon.moves), name, inside))
            case "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED":
                here = tuple(numbers[:6])
                canon.moves.append(move("rapid" if name == "STRAIGHT_TRAVERSE" else "line", here, feed))
            case "RIGID_TAP":  # in, and back to where it began
                for goal in ((*numbers[:3], *here[3:]), here):
                    canon.moves.append(move("line", goal, pitch * rpm))
            case "ARC_FEED":
                first, second, c1, c2, turns, height, *rotary = numbers
                order = _PLANES[plane]
                end = dict(zip(order, (first, second, height), strict=True))
                middle = dict(zip(order, (c1, c2, height), strict=True))
                here = (end[0], end[1], end[2], *rotary[:3])
                placed = offsets.machine((middle[0], middle[1], middle[2], *rotary[:3]))
                arc = move("arc", here, feed)
                about = {"centre": (c1, c2), "middle": (placed[order[0]], placed[order[1]])}
                canon.moves.append(Move(**{**vars(arc), **about, "turns": int(turns), "normal": order[2]}))
            case _:
                pass
    return canon
