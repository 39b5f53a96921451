"""``trunnion kinematics``: the formulas of a machine, as text, Markdown or LaTeX."""

from collections.abc import Iterator
from typing import Final

from trunnion.cli.machine.formula_pages import Block, Equations, Heading, Matrix, Paragraph, TableOf, page_lines
from trunnion.cli.results import show
from trunnion.formulas.agreement import Agreement
from trunnion.formulas.chain import Parameter
from trunnion.formulas.description import AxisTravel, Kinematics, Solution
from trunnion.formulas.poles import Pole
from trunnion.jobs.describe.kinematics import kinematics
from trunnion.jobs.job import Given
from trunnion.machines.jog_table import number_text, order_of_axes
from trunnion.machines.machine import Vector

_NAMES: Final = (
    "Lengths in mm, angles in degrees. x y z is the tip in workpiece coordinates.",
    "i j k is the tool axis from the tip to the holder, with i² + j² + k² = 1.",
    "Axis values are those that the control displays. cos and sin take degrees; acos, asin and atan2(y, x) give them.",
)


def run(given: Given) -> int:
    """Print the formulas; 0 if they agree with the maps of the product, else 1."""
    found = kinematics(**given.arguments())
    show(given, lambda: found, page_lines(kinematics_blocks(found), given.format))
    return 0 if found.passed else 1


def kinematics_blocks(found: Kinematics) -> Iterator[Block]:
    """Yield the formulas of a machine as blocks of a page."""
    machine = found.machine
    yield Heading(1, f"{machine.name} ({machine.key})")
    yield Paragraph((f"From the workpiece to the tool: {' '.join(order_of_axes(machine))}.", *_NAMES))
    yield from _frames(found)
    if found.parts:
        yield Paragraph(("Parts of these matrices, by row and column:",))
        yield Equations(found.parts)
    yield Heading(2, "Forward: where the tool is")
    yield Equations(found.forward)
    yield Heading(2, "Inverse: where the axes are")
    for number, solution in enumerate(found.solutions, 1):
        yield Heading(3, f"Solution {number}: {_range_text(solution)}")
        yield Equations(solution.rotary)
    yield Paragraph(("Rotary values are equal if whole turns are between them.",))
    yield Heading(3, "Linear axes, for either solution")
    yield Equations(found.linear)
    yield from _programs(found)
    yield from _poles(found)
    yield Heading(2, "Travel")
    yield TableOf(("axis", "carries", "travel"), tuple(map(_travel_cells, found.axes)))
    yield Heading(2, "Check")
    yield Paragraph(tuple(_agreement_lines(found.agreement)))


def _frames(found: Kinematics) -> Iterator[Block]:
    yield Heading(2, "Symbols")
    rows = tuple(
        (
            each.name,
            each.meaning,
            "unknown" if each.value is None else f"{number_text(each.value, 9)} {each.unit}".strip(),
        )
        for each in found.parameters
    )
    yield TableOf(("symbol", "meaning", "value"), rows, symbols=True)
    lines = ["An offset without a symbol is zero. An unknown one depends on the set-up (--zero, --tool-length)."]
    lines += [f"{each.variable} is the value of axis {each.name}." for each in found.axes if each.variable != each.name]
    yield Paragraph(tuple(lines))
    yield Heading(2, "Frames")
    yield Paragraph((
        "With all axes at zero the frames of axes are parallel to the machine frame.",
        "That of the workpiece has its origin in the workpiece zero, that of the tool in the tip.",
        "A matrix gives a point of the inner frame in the outer one.",
    ))  # fmt: skip
    for each in found.matrices[:-1]:
        yield Matrix(each.within, each.frame, each.rows, each.latex)
    whole = found.matrices[-1]
    yield Paragraph(("Multiplied, with x y z as below:",))
    yield Matrix(whole.within, whole.frame, whole.rows, whole.latex)


def _programs(found: Kinematics) -> Iterator[Block]:
    turning = " ".join(sorted(axis.name for axis in found.axes if axis.is_rotary))
    yield Heading(2, "With TCP and without")
    yield Paragraph((
        f"With TCP (TRAORI, M128, G43.4, RTCP) a program has x y z of the tip and {turning}: the control computes the"
        " linear axes.",
    ))  # fmt: skip
    if not found.without_tcp:
        why = "a linear axis is not X, Y or Z, or they lie in a plane with the rotary axes at zero"
        yield Paragraph((f"Without TCP there are no words: {why}.",))
        return
    yield Paragraph((
        f"Without TCP it has the words below and {turning}. They count from a work offset that was set with the rotary"
        " axes at zero and the tip in the workpiece zero, so the tool length is in it.",
    ))  # fmt: skip
    yield Equations(found.without_tcp)


def _poles(found: Kinematics) -> Iterator[Block]:
    yield Heading(2, "Poles and reach")
    lines = list(map(_pole_text, found.poles))
    if not lines:
        lines.append("There is no pole: no tool axis that is reached is parallel to the first rotary axis.")
    reach, about = found.reach, f"the direction {_vector_text(found.reach.about)}"
    near, far = (number_text(angle, 4) for angle in (reach.nearest, reach.farthest))
    whole = near == "0" and far == "180"
    lines.append(
        "Limits apart, the rotary axes reach every tool axis."
        if whole
        else f"Limits apart, the rotary axes reach tool axes from {near}° to {far}° off {about}."
    )
    lines.append("At poles, and at the ends of the reach, both solutions meet.")
    if found.dependent is not None:
        lines.append("Where the following is zero the linear axes lie in a plane, and cannot follow:")
    yield Paragraph(tuple(lines))
    if found.dependent is not None:
        yield Equations((found.dependent,))


def _pole_text(pole: Pole) -> str:
    where = f"{pole.other} = {number_text(pole.angle, 6)}"
    travel = "" if pole.in_travel else ", which is out of travel"
    axis = _vector_text(pole.tool_axis)
    return f"Pole: with the tool axis {axis}, at {where}{travel}, the angle of {pole.free} is free."


def _range_text(solution: Solution) -> str:
    where = solution.where
    whole = f"{where.axis} from {number_text(where.low, 4)}° to {number_text(where.high, 4)}°"
    within = " and ".join(f"{number_text(low, 4)}° to {number_text(high, 4)}°" for low, high in where.travel)
    return f"{whole}, of which {within or 'nothing'} is in travel"


def _travel_cells(axis: AxisTravel) -> tuple[str, str, str]:
    unit = "°" if axis.is_rotary else " mm"
    carries = "the part" if axis.carries == "part" else "the tool"
    if axis.endless:
        return axis.name, carries, "endless"
    ends = ("unknown" if end is None else number_text(end, 4) for end in (axis.low, axis.high))
    known = axis.low is not None or axis.high is not None
    return axis.name, carries, f"{' to '.join(ends)}{unit}" if known else "unknown"


def _agreement_lines(each: Agreement) -> Iterator[str]:
    yield (
        f"Compared with the maps that programs are made and proven with, at {each.poses} random positions, with random"
        " values of what is unknown."
    )
    words = "" if each.words_mm is None else f", words without TCP {each.words_mm:.1e} mm"
    yield (
        f"Largest differences: tip {each.forward_mm:.1e} mm, tool axis {each.tool_axis:.1e},"
        f" rotary axes {each.rotary_deg:.1e}°, linear axes {each.linear_mm:.1e} mm{words}."
    )
    yield f"The largest, {each.largest:.1e}, is {'within' if each.passed else 'MORE THAN'} {each.tolerance:g}."


def _value_text(each: Parameter) -> str:
    return "unknown" if each.value is None else f"{number_text(each.value, 9)} {each.unit}".strip()


def _vector_text(vector: Vector) -> str:
    return f"({', '.join(number_text(part, 4) for part in vector)})"
