"""LinuxCNC's stand-alone interpreter as the judge of programs: what it makes of each block, as it prints it."""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import pytest

#: Where CI runs, the judge must be there: ``.ci/run`` installs it.
needs_linuxcnc = pytest.mark.skipif(
    shutil.which("rs274") is None and not os.environ.get("CI"),
    reason="LinuxCNC is not installed (Debian package linuxcnc-uspace)",
)

#: Length of every tool in the table, mm.
LENGTH = 25.4

#: Folder of a program's subroutines.
SUBROUTINES = "subroutines"

_CALL = re.compile(r"^\s*\d+\s+N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")
_NUMBER = re.compile(r"(?<![A-Z])-?\d+(?:\.\d+)?")
_PLANES = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (2, 0, 1)}


@dataclass(frozen=True)
class Move:
    """One motion with what was in force.

    end      X Y Z A B C in the program's coordinates, mm and degrees
    centre   of arcs, in the two coordinates of their plane
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


@dataclass
class Canon:
    """Everything that a program made happen; ``notes`` are dwells, stops and messages, with the moves before them."""

    moves: list[Move] = field(default_factory=list)
    notes: list[tuple[int, str, str]] = field(default_factory=list)


class RefusedByLinuxcncError(Exception):
    """What the interpreter says of a program that it does not take."""


def interpret(text: str, folder: Path, coordinates: str = "XYZABC") -> Canon:
    """Run a program in the interpreter of a machine whose M428 and M429 switch its kinematics.

    The tools 1 to 99 are in the table. Subroutines are looked for in ``SUBROUTINES`` of the folder.
    """
    program, table, ini = folder / "part.ngc", folder / "tool.tbl", folder / "judge.ini"
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
    # the stand-alone interpreter takes the table's lengths for inches
    table.write_text("".join(f"T{k} P{k} Z{LENGTH / 25.4} D0.2\n" for k in range(1, 100)))
    variables = folder / "judge.var"
    variables.unlink(missing_ok=True)
    done = subprocess.run(
        ["rs274", "-g", "-i", str(ini), "-v", str(variables), "-t", str(table), str(program)],
        capture_output=True,
        check=False,
        timeout=120,
        env={**os.environ, "HOME": str(folder)},
    )
    if done.returncode:
        raise RefusedByLinuxcncError(done.stderr.decode(errors="replace"))
    return _read(done.stdout.decode(errors="replace"))


def _read(text: str) -> Canon:
    canon = Canon()
    feed = rpm = 0.0
    feed_mode = sense = 0
    coolant: frozenset[str] = frozenset()
    offset = tcp = False
    plane = "XY"
    for line in text.splitlines():
        match = _CALL.match(line)
        if match is None:
            continue
        name, inside = match.groups()
        numbers = [float(value) for value in _NUMBER.findall(inside)] if name not in ("COMMENT", "MESSAGE") else []
        match name:
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
            case "FLOOD_ON" | "MIST_ON":
                coolant |= {name.removesuffix("_ON")}
            case "FLOOD_OFF" | "MIST_OFF":
                coolant -= {name.removesuffix("_OFF")}
            case "USE_TOOL_LENGTH_OFFSET":
                offset = any(numbers)
            case "SET_AUX_OUTPUT_VALUE":
                tcp = numbers[1] == 1.0
            case "SELECT_PLANE":
                plane = inside.removeprefix("CANON_PLANE_")
            case "DWELL" | "PROGRAM_STOP" | "OPTIONAL_PROGRAM_STOP" | "MESSAGE":
                canon.notes.append((len(canon.moves), name, inside))
            case "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED":
                kind = "rapid" if name == "STRAIGHT_TRAVERSE" else "line"
                state = feed, feed_mode, rpm, sense, coolant, offset, tcp
                canon.moves.append(Move(kind, tuple(numbers[:6]), *state))
            case "ARC_FEED":
                first, second, c1, c2, turns, height, *rotary = numbers
                order = _PLANES[plane]
                end = dict(zip(order, (first, second, height), strict=True))
                state = feed, feed_mode, rpm, sense, coolant, offset, tcp
                place = (end[0], end[1], end[2], *rotary[:3])
                canon.moves.append(Move("arc", place, *state, (c1, c2), int(turns), order[2]))
            case _:
                pass
    return canon
