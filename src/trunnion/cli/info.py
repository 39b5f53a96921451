"""``trunnion info``: what CL files hold."""

from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.jobs.describe.cl_files import ClDescription, OperationDescription, ToolDescription, Vector, describe_cl
from trunnion.jobs.describe.plot import write_plot
from trunnion.jobs.job import Given
from trunnion.model.toolpath import Frame
from trunnion.wording import counted, format_duration

_INDENT: Final = "  "

#: Planes that the text shows of an operation.
_MOST_PLANES: Final = 6


def info(given: Given) -> int:
    """Show what CL files hold, as text or data, and draw it."""
    terminal = Terminal()
    found = describe_cl(**given.arguments(), observer=terminal)
    terminal.problems(found.remarks)
    if given.plot is not None:
        write_plot(found, given.plot)
    show(given, lambda: found, info_lines(found))
    return 0


def info_lines(found: ClDescription) -> Iterator[str]:
    """Yield a description in lines."""
    for file in found.files:
        unit = file.units if file.states_units else f"{file.units}, which it does not state"
        part = f"; part {file.part}" if file.part else ""
        yield f"{file.file}: {file.title} ({file.recognized}); lengths in {unit}{part}"
        if file.system:
            yield f"{_INDENT}coordinate system of the points: {' '.join(f'{number:g}' for number in file.system)}"
    yield f"{counted(len(found.operations), 'operation')}: {_motions(found.operations)}"
    yield f"cutting {_lengths(found)}; rapids {found.rapid_length:.0f} mm"
    if found.extents is not None:
        yield f"points from {_vector(found.extents[0])} to {_vector(found.extents[1])} mm"
    yield from ("", "Operations")
    for number, operation in enumerate(found.operations, 1):
        yield from _operation_lines(number, operation, found)
    yield from ("", "Tools")
    yield from (_INDENT + _tool_line(tool) for tool in found.tools)
    if found.systems != (Frame(),):
        yield from ("", "Coordinate systems: origin, X, Y in the CAM's absolute system")
        for number, frame in enumerate(found.systems, 1):
            yield f"{_INDENT}{number}  {_vector(frame.origin)}  {_vector(frame.x)}  {_vector(frame.y)}"
    if found.unknown:
        yield from ("", "Statements that are not known")
        for unknown in found.unknown:
            becomes = "post refuses it" if unknown.acts else "nothing becomes of it"
            what = f"{counted(unknown.count, 'time')}: {unknown.what}; {becomes}"
            yield f"{_INDENT}{unknown.file}:{unknown.line}: {unknown.statement}  {what}"


def _operation_lines(number: int, operation: OperationDescription, found: ClDescription) -> Iterator[str]:
    tool = found.tools[operation.tool]
    motions = _motions([operation])
    names = " + ".join((operation.name, *operation.joined))
    yield f"{_INDENT}{number}  {names}  {operation.kind}  {_tool_name(tool)}  {motions}"
    details = [f"cutting {_lengths(operation)}", *operation.cycles, *_rates(operation)]
    if len(found.systems) > 1:
        details.append(f"coordinate system {operation.system + 1}")
    yield _INDENT * 3 + "; ".join(details)
    if operation.planes:
        shown = ", ".join(map(_vector, operation.planes[:_MOST_PLANES]))
        more = len(operation.planes) - _MOST_PLANES
        yield f"{_INDENT * 3}planes {shown}{f' and {more} more' if more > 0 else ''}"
    if operation.extents is not None:
        yield f"{_INDENT * 3}points from {_vector(operation.extents[0])} to {_vector(operation.extents[1])} mm"


def _motions(operations: Sequence[OperationDescription]) -> str:
    """How many motions of each kind operations have together."""
    points, arcs, holes, splines = (
        sum(getattr(operation, name) for operation in operations) for name in ("points", "arcs", "holes", "splines")
    )
    of_splines = f" (some for {counted(splines, 'spline')})" if splines else ""
    return f"{counted(points, 'point')}{of_splines}, {counted(arcs, 'arc')}, {counted(holes, 'hole')}"


def _lengths(found: ClDescription | OperationDescription) -> str:
    time = f"{found.cutting_length:.0f} mm in {format_duration(found.cutting_seconds)} at the programmed feeds"
    unknown = found.moves_without_time
    return time if not unknown else f"{time}, without the time of {counted(unknown, 'move')} of unknown feed"


def _rates(operation: OperationDescription) -> Iterator[str]:
    for name, values, unit in (
        ("feed", operation.feed, "mm/min"),
        ("feed", operation.feed_per_rev, "mm/rev"),
        ("speed", operation.rpm, "rev/min"),
    ):
        if values is not None:
            low, high = values
            yield f"{name} {low:g} {unit}" if low == high else f"{name} {low:g} to {high:g} {unit}"


def _tool_name(tool: ToolDescription) -> str:
    number = "no number" if tool.number is None else f"T{tool.number}"
    return f"{number} {tool.name}".strip()


def _tool_line(tool: ToolDescription) -> str:
    sizes = [
        f"{title} {value:g}"
        for title, value in (
            ("d", tool.diameter),
            ("r", tool.corner_radius),
            ("upper r", tool.upper_radius),
            ("length", tool.length),
            ("flute length", tool.flute_length),
            ("taper", tool.taper_angle),
            ("tip angle", tool.tip_angle),
            ("stands out", tool.extension),
            ("length in the spindle", tool.set_length),
        )
        if value
    ]
    if tool.apt and tool.apt[1] and tool.apt[2:4] != (0.5 * tool.diameter - tool.corner_radius, tool.corner_radius):
        sizes.append(f"corner centre {tool.apt[2]:g} from the axis, {tool.apt[3]:g} above the tip")
    register = [f"length register {tool.register}"] if tool.register else []
    if tool.holder:
        register.append(f"holder {tool.holder}")
    where = "operations " + ", ".join(str(place + 1) for place in tool.operations)
    return "; ".join([f"{_tool_name(tool)}  {tool.kind} {' '.join(sizes)}".rstrip(), *register, where])


def _vector(values: Vector | Sequence[float]) -> str:
    return "(" + ", ".join(f"{round(value, 4) + 0.0:g}" for value in values) + ")"
