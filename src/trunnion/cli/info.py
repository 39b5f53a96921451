"""``trunnion info``: what CL files hold."""

from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_words, line, part, spoken, together
from trunnion.jobs.describe.cl_files import (
    ClDescription,
    ClFileDescription,
    OperationDescription,
    ToolDescription,
    Vector,
    describe_cl,
)
from trunnion.jobs.describe.plot import write_plot
from trunnion.jobs.job import Given
from trunnion.messages import Wording, phrase, word_said
from trunnion.model.toolpath import Frame, Toolpath
from trunnion.wording import format_duration

_INDENT: Final = "  "

#: Planes that the text shows of an operation.
_MOST_PLANES: Final = 6


class _Quiet(Terminal):
    """A terminal for files of which the result itself says as what they were read."""

    def read(self, toolpaths: Sequence[Toolpath]) -> None:
        """Leave that to the result."""


def info(given: Given) -> int:
    """Show what CL files hold, as text or data, and draw it."""
    terminal = _Quiet()
    found = describe_cl(**given.arguments(), observer=terminal)
    terminal.problems(found.remarks)
    if given.plot is not None:
        write_plot(found, given.plot, spoken())
    show(given, lambda: found, info_lines(found))
    return 0


def info_lines(found: ClDescription) -> Iterator[str]:
    """Yield a description in lines."""
    for file in found.files:
        yield _file_line(file)
        if file.system:
            numbers = " ".join(f"{number:g}" for number in file.system)
            yield _INDENT + line("system_of_points", numbers=numbers)
        if file.stock:
            yield _INDENT + line("stock_of_file", stock=file.stock)
    operations = found.operations
    yield line("operations_with_motions", count=len(operations), motions=_motions(operations))
    yield line("cutting_and_rapids", cutting=_lengths(found), length=found.rapid_length)
    yield from _extents(found.extents)
    yield from ("", line("operations"))
    for number, operation in enumerate(operations, 1):
        yield from _operation_lines(number, operation, found)
    yield from ("", line("tools"))
    yield from (_INDENT + _tool_line(tool) for tool in found.tools)
    if found.systems != (Frame(),):
        yield from ("", line("coordinate_systems"))
        for number, frame in enumerate(found.systems, 1):
            yield f"{_INDENT}{number}  {_vector(frame.origin)}  {_vector(frame.x)}  {_vector(frame.y)}"
    if found.unknown:
        yield from ("", line("statements_not_known"))
        for each in found.unknown:
            yield _INDENT + line(
                "statement_refused" if each.acts else "statement_left_out",
                file=each.file,
                line=each.line,
                statement=each.statement,
                count=each.count,
                what=each.said,
            )


def _file_line(file: ClFileDescription) -> str:
    units = file.units if file.states_units else part("units_not_stated", units=file.units)
    about = {"file": file.file, "title": file.title, "why": file.why, "units": units}
    return line("cl_file_of_part", **about, part=file.part) if file.part else line("cl_file", **about)


def _extents(extents: tuple[Vector, Vector] | None) -> Iterator[str]:
    if extents is not None:
        yield line("points_from_to", low=_vector(extents[0]), high=_vector(extents[1]))


def _operation_lines(number: int, operation: OperationDescription, found: ClDescription) -> Iterator[str]:
    tool = found.tools[operation.tool]
    motions, kind = in_words(_motions([operation])), in_words(word_said(operation.kind))
    names = " + ".join((operation.name, *operation.joined))
    yield f"{_INDENT}{number}  {names}  {kind}  {_tool_name(tool)}  {motions}"
    details = [in_words(_lengths(operation)), *operation.cycles, *_rates(operation)]
    if len(found.systems) > 1:
        details.append(line("in_coordinate_system", number=operation.system + 1))
    yield _INDENT * 3 + together(*details)
    if operation.planes:
        shown = ", ".join(map(_vector, operation.planes[:_MOST_PLANES]))
        more = len(operation.planes) - _MOST_PLANES
        yield _INDENT * 3 + (
            line("planes_shown_and_more", planes=shown, more=more) if more > 0 else line("planes_shown", planes=shown)
        )
    yield from (_INDENT * 3 + extents for extents in _extents(operation.extents))


def _motions(operations: Sequence[OperationDescription]) -> Wording:
    """How many motions of each kind operations have together."""
    points, arcs, holes, splines = (
        sum(getattr(operation, name) for operation in operations) for name in ("points", "arcs", "holes", "splines")
    )
    counted = (
        phrase("points_with_splines", count=points, splines=splines)
        if splines
        else phrase("points_counted", count=points)
    )
    return part("motions", points=counted, arcs=arcs, holes=holes)


def _lengths(found: ClDescription | OperationDescription) -> Wording:
    known = {"length": found.cutting_length, "time": format_duration(found.cutting_seconds)}
    unknown = found.moves_without_time
    return part("cutting_without_some", **known, count=unknown) if unknown else part("cutting", **known)


def _rates(operation: OperationDescription) -> Iterator[str]:
    for variant, values in (
        ("rate_feed", operation.feed),
        ("rate_feed_per_rev", operation.feed_per_rev),
        ("rate_speed", operation.rpm),
    ):
        if values is not None:
            low, high = (f"{value:g}" for value in values)
            yield line(variant, range=low if low == high else part("range", low=low, high=high))


def _tool_name(tool: ToolDescription) -> str:
    number = line("tool_without_number") if tool.number is None else f"T{tool.number}"
    return f"{number} {tool.name}".strip()


def _tool_line(tool: ToolDescription) -> str:
    sizes = [
        line(variant, value=value)
        for variant, value in (
            ("size_diameter", tool.diameter),
            ("size_corner", tool.corner_radius),
            ("size_upper", tool.upper_radius),
            ("size_length", tool.length),
            ("size_flutes", tool.flute_length),
            ("size_taper", tool.taper_angle),
            ("size_tip", tool.tip_angle),
            ("size_out", tool.extension),
            ("size_set", tool.set_length),
        )
        if value
    ]
    if tool.apt and tool.apt[1] and tool.apt[2:4] != (0.5 * tool.diameter - tool.corner_radius, tool.corner_radius):
        sizes.append(line("size_corner_centre", across=tool.apt[2], above=tool.apt[3]))
    register = [line("length_register", register=tool.register)] if tool.register else []
    if tool.holder:
        register.append(line("holder", holder=tool.holder))
    where = line("of_operations", numbers=", ".join(str(place + 1) for place in tool.operations))
    return together(f"{_tool_name(tool)}  {tool.kind} {' '.join(sizes)}".rstrip(), *register, where)


def _vector(values: Vector | Sequence[float]) -> str:
    return "(" + ", ".join(f"{round(value, 4) + 0.0:g}" for value in values) + ")"
