"""``trunnion kinematics``: the formulas of a machine, as text, Markdown or LaTeX."""

from collections.abc import Iterator

from trunnion.cli.machine.formula_pages import Block, Equations, Heading, Matrix, Paragraph, TableOf, page_lines
from trunnion.cli.results import show
from trunnion.cli.wording import in_words, spoken
from trunnion.formulas.agreement import Agreement
from trunnion.formulas.chain import Parameter
from trunnion.formulas.description import AxisTravel, Kinematics, Solution
from trunnion.formulas.poles import Pole
from trunnion.jobs.describe.kinematics import kinematics
from trunnion.jobs.job import Given
from trunnion.machines.jog_table import number_text, order_of_axes
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, word_said


def run(given: Given) -> int:
    """Print the formulas; 0 if they agree with the maps of the product, else 1."""
    found = kinematics(**given.arguments())
    show(given, lambda: found, page_lines(kinematics_blocks(found), given.format, spoken().language))
    return 0 if found.passed else 1


def kinematics_blocks(found: Kinematics) -> Iterator[Block]:
    """Yield the formulas of a machine as blocks of a page."""
    machine = found.machine
    yield Heading(1, f"{machine.name} ({machine.key})")
    order = tuple(map(word_said, order_of_axes(machine)))
    yield _paragraph(_said("order", axes=order), *map(_said, ("units", "tool_axis", "angles")))
    yield from _frames(found)
    if found.parts:
        yield _paragraph(_said("parts"))
        yield Equations(found.parts)
    yield Heading(2, _said("forward"))
    yield Equations(found.forward)
    yield Heading(2, _said("inverse"))
    if not found.solutions:
        yield _paragraph(_said("tool_axis_stays"))
    for number, solution in enumerate(found.solutions, 1):
        yield Heading(3, _solution_text(number, solution))
        yield Equations(solution.rotary)
    if found.solutions:
        yield _paragraph(_said("whole_turns"))
    yield Heading(3, _said("linear"))
    yield Equations(found.linear)
    yield from _programs(found)
    yield from _poles(found)
    yield Heading(2, _said("travel"))
    heads = _said("head_axis"), _said("head_carries"), _said("head_travel")
    yield TableOf(heads, tuple(map(_travel_cells, found.axes)))
    yield Heading(2, _said("check"))
    yield Paragraph(tuple(_agreement_lines(found.agreement)))


def _said(variant: str, /, **parameters: object) -> str:
    """Return a text of the catalogue ``kinematics``."""
    return in_words(Wording("kinematics", variant, **parameters))


def _paragraph(*lines: str) -> Paragraph:
    return Paragraph(lines)


def _frames(found: Kinematics) -> Iterator[Block]:
    yield Heading(2, _said("symbols"))
    rows = tuple((each.name, in_words(each.meant), _value_text(each)) for each in found.parameters)
    yield TableOf((_said("head_symbol"), _said("head_meaning"), _said("head_value")), rows, symbols=True)
    lines = [_said("without_symbol")]
    lines += [
        _said("axis_value", symbol=each.variable, axis=each.name)
        for each in found.axes
        if each.variable != each.name
    ]  # fmt: skip
    yield Paragraph(tuple(lines))
    yield Heading(2, _said("frames"))
    yield _paragraph(*map(_said, ("parallel", "origins", "inner_in_outer")))
    for each in found.matrices[:-1]:
        yield Matrix(each.within, each.frame, each.rows, each.latex)
    whole = found.matrices[-1]
    yield _paragraph(_said("multiplied"))
    yield Matrix(whole.within, whole.frame, whole.rows, whole.latex)


def _programs(found: Kinematics) -> Iterator[Block]:
    turning = " ".join(sorted(axis.name for axis in found.axes if axis.is_rotary))
    if not turning:
        return
    yield Heading(2, _said("programs"))
    yield _paragraph(_said("with_tcp", rotary=turning))
    if not found.without_tcp:
        yield _paragraph(_said("no_words"))
        return
    yield _paragraph(_said("without_tcp", rotary=turning))
    yield Equations(found.without_tcp)


def _poles(found: Kinematics) -> Iterator[Block]:
    yield Heading(2, _said("poles"))
    lines = list(map(_pole_text, found.poles)) or ([_said("no_pole")] if found.solutions else [])
    reach = found.reach
    near, far = (number_text(angle, 4) for angle in (reach.nearest, reach.farthest))
    if (near, far) == ("0", "180"):
        lines.append(_said("reaches_all"))
    else:
        lines.append(_said("reaches", near=near, far=far, direction=_vector_text(reach.about)))
    if len(found.solutions) == 2:
        lines.append(_said("solutions_meet"))
    if found.dependent is not None:
        lines.append(_said("dependent"))
    yield Paragraph(tuple(lines))
    if found.dependent is not None:
        yield Equations((found.dependent,))


def _pole_text(pole: Pole) -> str:
    return _said(
        "pole" if pole.in_travel else "pole_out_of_travel",
        tool_axis=_vector_text(pole.tool_axis),
        other=pole.other,
        angle=number_text(pole.angle, 6),
        free=pole.free,
    )


def _solution_text(number: int, solution: Solution) -> str:
    where = solution.where
    if where is None:
        return _said("only_solution")
    low, high = number_text(where.low, 4), number_text(where.high, 4)
    within = tuple(
        Wording("kinematics", "range", low=number_text(first, 4), high=number_text(last, 4))
        for first, last in where.travel
    )
    if not within:
        return _said("solution_out_of_travel", number=number, axis=where.axis, low=low, high=high)
    return _said("solution", number=number, axis=where.axis, low=low, high=high, within=within)


def _travel_cells(axis: AxisTravel) -> tuple[str, str, str]:
    carries = _said("carries_part" if axis.carries == "part" else "carries_tool")
    if axis.endless:
        return axis.name, carries, _said("endless")
    if axis.low is None and axis.high is None:
        return axis.name, carries, _said("unknown")
    low, high = (_said("unknown") if end is None else number_text(end, 4) for end in (axis.low, axis.high))
    return axis.name, carries, _said("travel_range", low=low, high=high, unit="°" if axis.is_rotary else " mm")


def _agreement_lines(each: Agreement) -> Iterator[str]:
    yield _said("compared", count=each.poses)
    found = {
        "tip": each.forward_mm, "tool_axis": each.tool_axis, "rotary": each.rotary_deg, "linear": each.linear_mm,
    }  # fmt: skip
    if each.words_mm is None:
        yield _said("differences", **found)
    else:
        yield _said("differences_with_words", words=each.words_mm, **found)
    yield _said("within" if each.passed else "more_than", largest=each.largest, tolerance=each.tolerance)


def _value_text(each: Parameter) -> str:
    return _said("unknown") if each.value is None else f"{number_text(each.value, 9)} {each.unit}".strip()


def _vector_text(vector: Vector) -> str:
    return f"({', '.join(number_text(part, 4) for part in vector)})"
