"""The same path in every dialect of CL files: what it is, and one small writer for each dialect."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

Vector = tuple[float, float, float]

Z: Final[Vector] = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Step:
    """A tool change, a feed, a point, an arc, a cycle with its holes, or a switch; lengths in units of the file.

    word     TOOL, SPINDLE, COOLANT, FEED, RAPID, GOTO, ARC, CYCLE, DWELL, CUTCOM, COMMENT
    numbers  of the tool (number, diameter, corner radius), speed, feed, depth, clearance, peck and so on
    point    end point; ``axis`` is the tool axis there
    """

    word: str
    numbers: tuple[float, ...] = ()
    text: str = ""
    point: Vector = (0.0, 0.0, 0.0)
    axis: Vector = Z
    centre: Vector = (0.0, 0.0, 0.0)
    normal: Vector = Z
    start: Vector = (0.0, 0.0, 0.0)
    holes: tuple[Vector, ...] = ()

    @property
    def radius(self) -> float:
        """Radius of an arc."""
        return math.dist(self.start, self.centre)

    @property
    def tangent(self) -> Vector:
        """Direction at the start of an arc."""
        (a, b, c), r = self.normal, [s - m for s, m in zip(self.start, self.centre, strict=True)]
        cross = (b * r[2] - c * r[1], c * r[0] - a * r[2], a * r[1] - b * r[0])
        length = math.hypot(*cross)
        return cross[0] / length, cross[1] / length, cross[2] / length


def turned(step: Step) -> float:
    """Degrees by which an arc turns about its normal."""
    first, last = ([p - m for p, m in zip(point, step.centre, strict=True)] for point in (step.start, step.point))
    tangent = sum(t * p for t, p in zip(step.tangent, last, strict=True))
    along = sum(a * b for a, b in zip(first, last, strict=True)) / step.radius
    return math.degrees(math.atan2(tangent, along)) % 360.0 or 360.0


def listed(*values: float, decimals: int = 6) -> str:
    """Numbers between commas."""
    return ", ".join(f"{value:.{decimals}f}" for value in values)


def continued(text: str, at: int) -> str:
    """A statement that goes on in a second line behind a comma."""
    parts = text.split(", ")
    return ", ".join(parts[:at]) + ",$\n  " + ", ".join(parts[at:])


class _Writer:
    """What most dialects have in common."""

    name = "apt"
    cycles: frozenset[str] = frozenset({"DRILL", "DEEP", "BRKCHP", "TAP", "FACE", "REAM"})
    tilts = True

    def __init__(self, inch: bool) -> None:
        self.feed_unit = "IPM" if inch else "MMPM"
        self.units = "INCHES" if inch else "MM"

    def head(self) -> list[str]:
        return ["PARTNO PART", f"UNITS/{self.units}", "MULTAX/ON"]

    def foot(self) -> list[str]:
        return ["END", "FINI"]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        seven = listed(diameter, corner, 0.5 * diameter - corner, corner, 0, 0, 50)
        return [f"CUTTER/{seven}", f"LOADTL/{number}"]

    def goto(self, step: Step) -> list[str]:
        return [f"GOTO/{listed(*step.point)}, {listed(*step.axis, decimals=9)}"]

    def arc(self, step: Step) -> list[str]:
        numbers = listed(*step.centre, *step.normal, step.radius)
        return [f"MOVARC/{numbers}, ANGLE, {turned(step):.6f}", *self.goto(step)]

    def cycle(self, step: Step) -> list[str]:
        depth, clear, feed, peck = step.numbers
        pecks = f"STEP,{peck:.4f}," if step.text in ("DEEP", "BRKCHP") else ""
        return [f"CYCLE/{step.text},{pecks}FEDTO,{depth:.4f},{self.feed_unit},{feed:.4f},RAPTO,{clear:.4f}"]

    def feed(self, value: float) -> list[str]:
        return [f"FEDRAT/{value:.4f},{self.feed_unit}"]

    def spindle(self, rpm: float, sense: str) -> list[str]:
        return [f"SPINDL/{rpm:.4f}, RPM, {sense}"]

    def write(self, steps: Sequence[Step]) -> str:
        """The file."""
        lines = self.head()
        for step in steps:
            match step.word:
                case "TOOL":
                    lines += self.tool(int(step.numbers[0]), *step.numbers[1:])
                case "SPINDLE":
                    lines += self.spindle(step.numbers[0], step.text)
                case "FEED":
                    lines += self.feed(step.numbers[0])
                case "COOLANT":
                    lines.append(f"COOLNT/{step.text}")
                case "CUTCOM":
                    lines.append(f"CUTCOM/{step.text}")
                case "COMMENT":
                    lines.append(f"PPRINT/{step.text}")
                case "DWELL":
                    lines.append(f"DELAY/{step.numbers[0]:.3f}")
                case "RAPID":
                    lines += ["RAPID", *self.goto(step)]
                case "GOTO":
                    lines += self.goto(step)
                case "ARC":
                    lines += self.arc(step)
                case "CYCLE":
                    lines += self.cycle(step)
                    for hole in step.holes:
                        lines += self.goto(Step("GOTO", point=hole, axis=step.axis))
                    lines.append("CYCLE/OFF")
        return "\n".join([*lines, *self.foot()]) + "\n"


class _Clsf(_Writer):
    name = "clsf"

    def head(self) -> list[str]:
        self._open = False
        return [f"UNITS/{self.units}"]

    def foot(self) -> list[str]:
        return ["END-OF-PATH"] if self._open else []

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        ends = self.foot()
        self._open = True
        data = f"TLDATA/MILL,{listed(diameter, corner, 50, 0, 0)}"
        return [*ends, f"TOOL PATH/OP{number},TOOL,T{number}", data, f"LOAD/TOOL,{number}"]

    def arc(self, step: Step) -> list[str]:
        return [f"CIRCLE/{listed(*step.centre, *step.normal, step.radius, 0.06, 0.5, 0, 0)}", *self.goto(step)]

    def cycle(self, step: Step) -> list[str]:
        depth, clear, feed, peck = step.numbers
        mode = {"DEEP": "DRILL,DEEP", "BRKCHP": "DRILL,BRKCHP"}.get(step.text, step.text)
        pecks = f",STEP,{peck:.4f}" if "," in mode else ""
        return [f"CYCLE/{mode}{pecks},RAPTO,{clear:.4f},FEDTO,{-depth:.4f},{self.feed_unit},{feed:.4f}"]


class _Trunnion(_Clsf):
    name = "trunnion"

    def head(self) -> list[str]:
        return ["$$-> TRUNNION / 1", *super().head()]

    def foot(self) -> list[str]:
        return [*super().foot(), "FINI"]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        ends = _Clsf.foot(self)
        self._open = True
        data = f"$$-> TOOL / MILL, LENGTH, 50, DIAMETER, {diameter:.6f}, CORNER, {corner:.6f}"
        offset = "$$-> WORK-OFFSET / 1"
        return [*ends, f"TOOL PATH/OP{number},TOOL,T{number}", data, offset, f"LOADTL/{number}"]


class _Ncl(_Writer):
    name = "ncl"

    def head(self) -> list[str]:
        identity = "1.0, 0.0, 0.0, 0.0,  $\n  0.0, 1.0, 0.0, 0.0,  $\n  0.0, 0.0, 1.0, 0.0"
        return [
            "$$*          Pro/CLfile  Version 8.0",
            "PARTNO / PART",
            f"UNITS / {self.units}",
            f"$$-> CSYS / {identity}",
        ]

    def foot(self) -> list[str]:
        return ["$$-> END / ", "FINI"]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        return [f"LOADTL / {number}", f"$$-> CUTTER / {listed(diameter, corner)}"]

    def goto(self, step: Step) -> list[str]:
        text = f"GOTO / {listed(*step.point, decimals=10)}"
        if step.axis == Z:
            return [text]
        return [f"{text},  $\n{listed(*step.axis, decimals=10)}"]

    def arc(self, step: Step) -> list[str]:
        return [continued(f"CIRCLE / {listed(*step.centre, *step.normal, step.radius)}", 3), *self.goto(step)]

    def cycle(self, step: Step) -> list[str]:
        depth, clear, feed, peck = step.numbers
        pecks = f" STEP, {peck:.6f}," if step.text in ("DEEP", "BRKCHP") else ""
        text = f"CYCLE / {step.text}, DEPTH, {depth:.6f},{pecks} {self.feed_unit}, {feed:.6f}, CLEAR, {clear:.6f}"
        return [continued(text, 4)]

    def spindle(self, rpm: float, sense: str) -> list[str]:
        return [f"SPINDL / RPM, {rpm:.6f},  {sense}"]


class _Solidworks(_Writer):
    name = "solidworks"
    cycles = frozenset({"DRILL", "DEEP"})

    def head(self) -> list[str]:
        return ["PARTNO/1", f"UNIT/{self.units}"]

    def foot(self) -> list[str]:
        return ["FINI"]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        (cutter, _) = super().tool(number, diameter, corner)
        csys = "CSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0"
        return ["INSERT/A TOOL", cutter, f"LOAD/TOOL,{number}", "CSI_SET_FLUTE_LENGTH/4.", "TRNTYP/WORLD,0,0,0", csys]

    def goto(self, step: Step) -> list[str]:
        return super().goto(step) if step.axis != Z else [f"GOTO/{listed(*step.point)}"]

    def arc(self, step: Step) -> list[str]:
        return [f"CIRCLE/{listed(*step.centre, *step.normal)}", *self.goto(step)]

    def cycle(self, step: Step) -> list[str]:
        depth, clear, feed, peck = step.numbers
        tail = f"{self.feed_unit},{feed:.4f},RAPTO,{clear:.4f},RTRCTO,{clear:.4f}"
        if step.text == "DEEP":
            return ["CYCLE/INIT", f"CYCLE/DEEP2,FEDTO,{depth:.4f},1STPECK,{peck:.4f},SUBPECK,{peck:.4f},{tail}"]
        return ["CYCLE/INIT", f"CYCLE/DRILL,FEDTO,{depth:.4f},{tail},DWELL,0"]


class _Catia(_Writer):
    name = "catia"

    def head(self) -> list[str]:
        identity = ["$$     1.0 0.0 0.0 0.0", "$$     0.0 1.0 0.0 0.0", "$$     0.0 0.0 1.0 0.0"]
        return [
            "$$     CATIA APT VERSION 1.0",
            "$$*CATIA0",
            "$$ A",
            *identity,
            "PARTNO PART",
            f"UNITS/{self.units}",
            "MULTAX",
        ]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        (cutter, load) = super().tool(number, diameter, corner)
        head = [f"$$ OPERATION NAME : Tool Change.{number}", "$$ TOOLCHANGEBEGINNING", continued(cutter, 5)]
        return [*head, f"TOOLNO/{number},  {diameter:.6f}", f"TPRINT/T{number}", load, "$$ TOOLCHANGEEND", f"{load},0"]

    def arc(self, step: Step) -> list[str]:
        x, y, z = (f"{value:.6f}" for value in step.centre)
        end = listed(*step.point)
        lines = ["AUTOPS", f"INDIRV/ {listed(*step.tangent)}"]
        if abs(step.normal[2]) == 1.0:
            return [
                *lines, f"TLON,GOFWD/   (CIRCLE/  {x}, {y}, {z},$", f"    {step.radius:.6f}),ON,(LINE/ {x}, {y}, {z},$",
                f"   {end})",
            ]  # fmt: skip
        axis = listed(*step.normal)
        return [
            *lines, f"TLON,GOFWD/(CYLNDR/{x},{y},{z},$", f"{axis},{step.radius:.6f}),ON,(PLANE/PERPTO,$",
            f"(PLANE/(POINT/{x},{y},{z}),PERPTO,$", f"(VECTOR/{axis})),(POINT/{x},{y},{z}),(POINT/{end}))",
        ]  # fmt: skip

    def cycle(self, step: Step) -> list[str]:
        depth, clear, feed, peck = step.numbers
        if step.text in ("DEEP", "BRKCHP"):
            text = (
                f"CYCLE/{step.text},DEPTH, {depth:.4f},STEP, {peck:.4f},{self.feed_unit}, {feed:.4f},CLEAR, {clear:.4f}"
            )
            return [continued(text, 3)]
        return [f"CYCLE/{step.text}, {depth:.6f}, {clear:.6f}, {feed:.4f},{self.feed_unit}"]


class _Fusion(_Writer):
    name = "fusion"
    cycles = frozenset()
    tilts = False

    def head(self) -> list[str]:
        return ["PARTNO/'PART'", "PPRINT/'PART'", f"UNITS/{self.units}", "MULTAX/OFF"]

    def tool(self, number: int, diameter: float, corner: float) -> list[str]:
        (cutter, load) = super().tool(number, diameter, corner)
        return ["PPRINT/'Contour'", cutter, f"{load}, 0, 60.0, 0"]

    def goto(self, step: Step) -> list[str]:
        return [f"GOTO/{listed(*step.point)}"]


#: By the names of the dialects: those that have words for every step.
WRITERS: Final[dict[str, type[_Writer]]] = {
    writer.name: writer for writer in (_Clsf, _Ncl, _Solidworks, _Catia, _Writer, _Trunnion)
}

#: All of them.
EVERY: Final[dict[str, type[_Writer]]] = {**WRITERS, _Fusion.name: _Fusion}


def says(dialect: str, step: Step) -> bool:
    """Whether a dialect has words for a step."""
    writer = EVERY[dialect]
    return (step.word != "CYCLE" or step.text in writer.cycles) and (writer.tilts or step.axis == Z)


def write_in(dialect: str, steps: Sequence[Step], inch: bool) -> str | None:
    """A path in a dialect; None if it has no words for one of its steps."""
    if not all(says(dialect, step) for step in steps):
        return None
    return EVERY[dialect](inch).write(steps)
