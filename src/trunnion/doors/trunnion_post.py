"""Trunnion's post for FreeCAD: writes CL of a job, and has Trunnion post and prove it.

FreeCAD runs this file in its own Python: it uses the standard library alone, and of FreeCAD only what is handed to
``export``. ``trunnion freecad install`` puts it where FreeCAD looks, and beside it how to run Trunnion.

In:     the objects of a job with their ``Path.Commands``: mm, F in mm per second, words modal, arc centres relative,
        in the work plane that is the object's ``Placement``.
Out:    CL in Trunnion's own profile, mm and mm/min, in the coordinate system of the job.
"""

from __future__ import annotations

import json
import math
import os
import re
import shlex
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

TOOLTIP = "Trunnion: an NC program that is proven before it appears, with its report, or the reason why there is none."
TOOLTIP_ARGS = """--machine NAME   the machine, as trunnion machines lists it, or its file
--set KEY=VALUE  a setting of the post; may be repeated
--cl-only        write the CL file in place of the program
Other options are those of trunnion post.
"""
UNITS = "G21"
MACHINE_NAME = "Trunnion"

#: Says how Trunnion is run: written by ``trunnion freecad install``.
_COMMAND_FILE = "trunnion_post.json"

_MOVES = {"G0": 0, "G1": 1, "G2": 2, "G3": 3}
_CYCLES = {"G73": "DRILL,BRKCHP", "G81": "DRILL", "G82": "DRILL", "G83": "DRILL,DEEP", "G84": "TAP", "G85": "BORE"}
#: Axis about which arcs turn, by the word of their plane.
_PLANES = {"G17": (0.0, 0.0, 1.0), "G18": (0.0, 1.0, 0.0), "G19": (1.0, 0.0, 0.0)}
#: The plane of an operation without a work plane.
_ABSOLUTE = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
#: Words that say what this post takes for granted.
_GRANTED = {"G21", "G40", "G43", "G49", "G90", "G94"}
#: Which work offset of the control a fixture selects.
_OFFSETS = {**{f"G{53 + n}": n for n in range(1, 7)}, **{f"G59.{n}": 6 + n for n in range(1, 10)}}
_COOLANTS = {"Flood": "FLOOD", "Mist": "MIST"}
#: Lengths below this are none, mm.
_POINT = 1e-6
_SWITCHES = {
    "M7": "COOLNT/MIST", "M8": "COOLNT/FLOOD", "M9": "COOLNT/OFF", "M5": "SPINDL/OFF", "M0": "STOP", "M1": "OPSTOP",
}  # fmt: skip


class RefusedError(Exception):
    """A job that no program is made of; its text names the operation."""


def export(objects: Iterable[Any], filename: str, argstring: str) -> str:
    """Write the program of a job to a file; ``-`` writes none. Return its text.

    Raises ``RefusedError`` with the operation's name where there is no program.
    """
    argstring = argstring or ""
    arguments = shlex.split(argstring.replace("\\", "/") if os.name == "nt" else argstring)
    writer = Writer()
    text = writer.job(objects)
    if "--cl-only" in arguments:
        return text if filename == "-" else _write(Path(filename), text)
    program = Path("freecad.nc" if filename == "-" else filename).resolve()
    _write(source := program.with_suffix(".apt"), text)
    given = [] if "--report" in arguments else ["--report", str(program.with_suffix(".html"))]
    if len(writer.planes) > 1 and not any(each.startswith("frame=") for each in arguments):
        given += ["--set", "frame=absolute"]
    _post([str(source), "--output", str(program), *given, *arguments], writer.begins)
    return program.read_text(encoding="utf-8", errors="replace")


def _write(file: Path, text: str) -> str:
    """Write a CL file whole or not at all, and never over what is none of this post; return its text."""
    if file.is_file() and file.stat().st_size and not file.read_bytes().startswith(b"$$-> TRUNNION / 1"):
        raise RefusedError(f"{file} would be replaced by the CL file, and is none: move it away")
    part = file.with_name(file.name + ".part")
    part.write_text(text, encoding="utf-8")
    part.replace(file)
    return text


def _post(arguments: Sequence[str], begins: Sequence[tuple[int, str]]) -> None:
    """Run ``trunnion post``, and say what it says."""
    try:
        command = json.loads(Path(__file__).with_name(_COMMAND_FILE).read_text(encoding="utf-8"))["command"]
    except (OSError, ValueError, KeyError) as error:
        raise RefusedError(f"Trunnion is not installed for FreeCAD: run trunnion freecad install ({error})") from error
    own = {key: value for key, value in os.environ.items() if key not in ("PYTHONHOME", "PYTHONPATH")}
    done = subprocess.run(
        [*command, "post", *arguments], capture_output=True, text=True, check=False, env=own, encoding="utf-8"
    )
    said = "\n".join(with_operation(line, begins) for line in (done.stdout + done.stderr).splitlines())
    print(said)
    if done.returncode:
        raise RefusedError(said)


def with_operation(line: str, begins: Sequence[tuple[int, str]]) -> str:
    """Return a line of Trunnion with the name of the operation whose line of the CL file it names.

    begins  first line and name of each operation, in order
    """
    found = re.match(r".*?:(\d+): ", line)
    names = [name for first, name in begins if found and first <= int(found.group(1))]
    return f"{line} (operation {names[-1]})" if names and names[-1] not in line else line


def _number(value: Any) -> float:
    """Return a quantity, a number or its text as a number; some locales write a decimal comma."""
    value = getattr(value, "Value", value)
    return float(value.split()[0].replace(",", ".") if isinstance(value, str) else value)


def _text(value: float, decimals: int = 6) -> str:
    return f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".")


def _line(text: Any) -> str:
    """Return a text that is one line of a statement: a dollar sign would continue it."""
    return " ".join(re.sub(r"[\x00-\x1f\x7f\x85\u2028\u2029$]", " ", str(text)).split())


def _listed(*values: float) -> str:
    return ",".join(_text(value) for value in values)


def tool_statement(bit: Any) -> str:
    """Return the form of a tool bit as a statement, by its shape and its properties."""
    shape = str(getattr(bit, "ShapeName", "") or getattr(bit, "ShapeType", "")).lower()
    names = (("DIAMETER", "Diameter"), ("LENGTH", "Length"), ("FLUTE", "CuttingEdgeHeight"))
    size = {word: _number(getattr(bit, name)) for word, name in names if hasattr(bit, name)}
    form = "MILL"
    if shape.startswith("ball"):
        size["CORNER"] = size.get("DIAMETER", 0.0) / 2.0
    elif shape.startswith(("bullnose", "torus", "radius")) and shape != "radius":
        size["CORNER"] = _number(getattr(bit, "CornerRadius", getattr(bit, "FlatRadius", 0.0)))
    elif shape.startswith("drill"):
        form = "DRILL"
        size["TIP"] = _number(getattr(bit, "TipAngle", 0.0))
    elif not shape.startswith("endmill"):
        form = "UNKNOWN"
    if size.get("FLUTE", 0.0) > size.get("LENGTH", 0.0):
        size.pop("LENGTH", None)
    words = [f"{word},{_text(value)}" for word, value in size.items() if value > 0.0]
    return "$$-> TOOL / " + ",".join([form, *words])


def dressed(given: Any) -> list[Any]:
    """Return an object and those that it changes, the operation last: dressups may stand upon each other."""
    found = [given]
    while hasattr(base := getattr(found[-1], "Base", None), "Path") and base not in found:
        found.append(base)
    return found


def work_plane(given: Any) -> tuple[float, ...]:
    """Return the plane in which an operation has its path: origin, X and Y in the coordinates of the job."""
    placement = getattr(given, "Placement", None)
    if placement is None:
        return _ABSOLUTE
    rows = [round(float(value), 9) + 0.0 for value in placement.toMatrix().A]
    return (rows[3], rows[7], rows[11], rows[0], rows[4], rows[8], rows[1], rows[5], rows[9])


class Writer:
    """Writes the objects of a job as CL.

    begins   first line of each operation, and its name
    offsets  work offsets in the order of their first use
    planes   work planes, and the absolute one first: origin, X and Y in the coordinates of the job
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.begins: list[tuple[int, str]] = []
        self.offsets: list[str] = []
        self.planes: list[tuple[float, ...]] = [_ABSOLUTE]
        self._plane: tuple[float, ...] = _ABSOLUTE
        self._used: set[str] = set()
        self._controller: Any = None
        self._offset = ""
        self._at: list[float | None] = [None, None, None]

    def job(self, objects: Iterable[Any]) -> str:
        """Return the CL of a job: its operations, and before them the tools and work offsets that they use."""
        objects = list(objects)
        self.lines = ["$$-> TRUNNION / 1", "UNITS/MM", *_head(objects)]
        for each in objects:
            self._object(each)
        if not self.begins:
            raise RefusedError("the job has no active operation with motion")
        return "\n".join([*self.lines, "FINI"]) + "\n"

    def _object(self, given: Any) -> None:
        if not all(getattr(each, "Active", True) for each in dressed(given)):
            return
        if hasattr(given, "ToolNumber"):
            self._controller, self._at = given, [None, None, None]
            return
        commands = list(getattr(getattr(given, "Path", None), "Commands", ()))
        offset = next((name for name in (_code(each.Name) for each in commands) if name in _OFFSETS), "")
        if offset:
            self._offset, self._at = offset, [None, None, None]
            self.offsets += [offset] * (offset not in self.offsets)
        if offset and not any(_code(each.Name) in ("G1", "G2", "G3", *_CYCLES) for each in commands):
            return  # a fixture: its height counts from where nobody knows
        if commands:
            self._operation(given, commands)

    def _operation(self, given: Any, commands: Sequence[Any]) -> None:
        chain, label = dressed(given), _line(str(given.Label).replace(",", " "))
        own = [getattr(each, "ToolController", None) for each in chain]
        if (controller := next((each for each in own if each is not None), self._controller)) is None:
            raise RefusedError(f"operation {label}: it has no tool")
        name = label if len(self.offsets) < 2 else f"{label} {self._offset}"
        others = (f"{label} {again}" for again in range(2, len(self._used) + 3))
        name = next(each for each in (name, *others) if each not in self._used)
        self._used.add(name)
        plane = work_plane(given)
        if any(work_plane(each) != plane for each in chain):
            raise RefusedError(f"operation {label}: its work plane is not that of the operation that it changes")
        if plane != self._plane:
            self._plane, self._at = plane, [None, None, None]
            self.planes += [plane] * (plane not in self.planes)
        head = [
            f"TOOL PATH/{name},TOOL,{_line(controller.Label)}",
            tool_statement(getattr(controller, "Tool", None)),
            "MSYS/" + ",".join(_text(value, 9) for value in plane),
            *(f"$$-> WORK-OFFSET / {n}" for fixture, n in _OFFSETS.items() if fixture == self._offset),
            f"LOADTL/{controller.ToolNumber}",
        ]
        speed = _number(controller.SpindleSpeed)
        if speed > 0.0 and str(controller.SpindleDir) != "None":
            head.append(f"SPINDL/RPM,{_text(speed)}," + ("CCLW" if controller.SpindleDir == "Reverse" else "CLW"))
        mode = next((str(each.CoolantMode) for each in chain if hasattr(each, "CoolantMode")), "")
        if mode not in (*_COOLANTS, "None", ""):
            raise RefusedError(f"operation {label}: coolant {mode} is not known")
        head += ["COOLNT/" + _COOLANTS.get(mode, "")] * (mode in _COOLANTS)
        body = _Path(label, self._at, speed, int(controller.ToolNumber))
        for command in commands:
            body.command(command)
        body.end_cycle()
        if body.moved:
            self.begins.append((len(self.lines) + 1, name))
            self.lines += [*head, *body.lines, *["COOLNT/OFF"] * (mode in _COOLANTS), "END-OF-PATH"]


def _head(objects: Sequence[Any]) -> list[str]:
    """Return name and stock of the job that the objects belong to, as far as they say it."""
    parents, level = list[Any](), list(objects)
    for _ in range(3):
        level = [parent for each in level for parent in getattr(each, "InList", ())]
        parents += level
    job: Any = next((each for each in parents if hasattr(each, "Stock") and hasattr(each, "Operations")), None)
    box = getattr(getattr(getattr(job, "Stock", None), "Shape", None), "BoundBox", None)
    if box is None:
        return []
    sizes = [box.XMax - box.XMin, box.YMax - box.YMin, box.ZMax - box.ZMin, box.XMin, box.YMin, box.ZMin]
    return ["PARTNO/" + _line(job.Label), "$$-> STOCK / BOX," + _listed(*sizes)]


def _code(name: str) -> str:
    """Return the name of a command without leading zeros: G01 is G1."""
    found = re.match(r"([GM])0*(\d+(?:\.\d+)?)$", name)
    return found.group(1) + found.group(2) if found else name


def _known(at: Sequence[float | None]) -> list[float]:
    """Return the coordinates of a place, none where one of them is not known."""
    return [] if None in at else [value for value in at if value is not None]


class _Path:
    """The commands of one operation as statements.

    at     where the tool is, mm; None where nothing has said it yet; goes on to the next operation
    moved  something of it is motion
    lines  the statements
    """

    def __init__(self, operation: str, at: list[float | None], speed: float, tool: int) -> None:
        self.moved = False
        self._operation, self._at, self._speed, self._tool = operation, at, speed, tool
        self.lines: list[str] = []
        self._feed = ""
        self._plane, self._cycle, self._to_start = _PLANES["G17"], "", True

    def command(self, command: Any) -> None:
        """Add a command."""
        name, words = _code(command.Name), command.Parameters
        if name.startswith("("):
            self.lines.append("$$ " + _line(name.strip("()").replace("/", " ").replace("->", " ")))
            return
        if turned := [word for word in "ABC" if abs(words.get(word, 0.0)) > 1e-9]:
            raise self._refused(f"{command.Name} has the rotary word {turned[0]}, which says no plane")
        if name in _MOVES:
            self._move(name, words)
        elif name in _CYCLES:
            self._hole(name, words)
        elif name in _PLANES:
            self._plane = _PLANES[name]
        elif name in ("G98", "G99"):
            self._to_start = name == "G98"
        elif name == "G80":
            self.end_cycle()
        elif name == "G4":
            self.lines.append("DELAY/" + _text(words.get("P", words.get("X", 0.0))))
        elif name in _SWITCHES:
            self.lines.append(_SWITCHES[name])
        elif name in ("M3", "M4") and words.get("S"):
            self.lines.append("SPINDL/RPM,{},{}".format(_text(words["S"]), "CLW" if name == "M3" else "CCLW"))
        elif name == "M6" and words.get("T", self._tool) != self._tool:
            raise self._refused(f"M6 T{words['T']:g} loads another tool than that of the operation")
        elif name != "M6" and name not in _GRANTED and name not in _OFFSETS:
            raise self._refused(f"{command.Name} is not known")

    def _refused(self, why: str) -> RefusedError:
        return RefusedError(f"operation {self._operation}: {why}")

    def end_cycle(self) -> None:
        """End the cycle that is on."""
        self.lines += ["CYCLE/OFF"] * bool(self._cycle)
        self._cycle = ""

    def _take_feed(self, words: dict[str, float]) -> str:
        """Return the feed in mm/min that is in force; FreeCAD has mm per second, and 0 where none is stated."""
        if words.get("F", 0.0) > 0.0:
            self._feed = _text(words["F"] * 60.0)
        return self._feed

    def _move(self, name: str, words: dict[str, float]) -> None:
        start, before = list(self._at), self._feed
        for k, word in enumerate("XYZ"):
            self._at[k] = words.get(word, self._at[k])
        self.end_cycle()
        if name != "G0" and self._take_feed(words) != before:
            self.lines.append("FEDRAT/MMPM," + self._feed)
        if None in self._at and name != "G0":
            raise self._refused(f"{name} cuts before X, Y and Z are known")
        if None in self._at or (start == self._at and name in ("G0", "G1") and self.moved):
            return
        if name == "G0":
            self.lines.append("RAPID")
        elif name != "G1":
            self._arc(name, words, _known(start))
        self.lines.append("GOTO/" + _listed(*_known(self._at)))
        self.moved = True

    def _arc(self, name: str, words: dict[str, float], start: Sequence[float]) -> None:
        """Add an arc: its centre lies at I, J, K from its start."""
        if not start or not any(words.get(word) for word in "IJK"):
            raise self._refused(f"{name} without I, J and K, or without a start")
        centre = [a + words.get(word, 0.0) for a, word in zip(start, "IJK")]
        centre = [s if n else c for c, s, n in zip(centre, start, self._plane)]
        level = [s if n else a for a, s, n in zip(_known(self._at), start, self._plane)]
        if max(math.dist(start, centre), math.dist(start, level)) < _POINT:
            return  # thread milling goes down so where the arc to the next pass has no width: a line
        turn = -1.0 if name == "G2" else 1.0
        self.lines.append("CIRCLE/" + _listed(*centre, *(turn * n for n in self._plane), math.dist(start, centre)))

    def _hole(self, name: str, words: dict[str, float]) -> None:
        """Add a hole; its point is at the height of R, above which nothing is cut."""
        for k, word in enumerate("XY"):
            self._at[k] = words.get(word, self._at[k])
        feed, at = self._take_feed(words), _known(self._at)
        if not at or "R" not in words or "Z" not in words:
            raise self._refused(f"{name} without X, Y, Z and R")
        parts = ["CYCLE/" + _CYCLES[name], "RAPTO,0", "FEDTO," + _text(words["Z"] - words["R"])]
        top = max(at[2], words["R"]) if self._to_start else words["R"]
        parts.append("RTRCTO," + _text(top - words["R"]))
        if name in ("G73", "G83"):
            if not words.get("Q", 0.0) > 0.0:
                raise self._refused(f"{name} without a peck Q")
            parts.append("STEP," + _text(words["Q"]))
        if name in ("G82", "G85") and words.get("P", 0.0) > 0.0:
            parts.append("DWELL," + _text(words["P"]))
        if name == "G84":
            if not self._speed or not feed:
                raise self._refused("G84 without a speed or a feed")
            parts.append("MMPR," + _text(float(feed) / self._speed))
        elif feed:
            parts.append("MMPM," + feed)
        cycle = ",".join(parts)
        if cycle != self._cycle:
            self.end_cycle()
            self.lines.append(cycle)
            self._cycle = cycle
        self._at[2] = top
        self.lines.append("GOTO/" + _listed(at[0], at[1], words["R"]))
        self.moved = True
