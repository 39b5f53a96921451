"""The bodies that a part is placed among: those of the machine, tools, and what is clamped with the part."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final, Literal

from trunnion.errors import InputError, Problem, Severity, argument_problem, warning
from trunnion.jobs.inputs.bodies import MeshLike, fixture_meshes, known_tools, read_mesh
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.stated_setup import length_of_tool_missing
from trunnion.jobs.place.inputs import PlacedInput
from trunnion.machines import Machine
from trunnion.machines.machine import tool_key
from trunnion.messages import Wording
from trunnion.placing.collisions.best_clearance import Guard
from trunnion.placing.collisions.guarded_pairs import (
    Changes,
    Guarded,
    guarded_machine,
    guarded_on_part,
    guarded_pairs,
    guarded_tool,
)
from trunnion.records import dataclass
from trunnion.simulation.collisions import BodyKind, machine_bodies
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.stock.solids import stock_shape
from trunnion.simulation.tools.choice import NO_CALL, tools_of_toolpaths
from trunnion.simulation.tools.profile import ToolShape

#: Tools whose lengths differ by less are as long, mm.
_LIKE_LENGTH: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class BodiesInput:
    """Bodies as ``trunnion.place`` takes them."""

    fixtures: MeshLike | Iterable[MeshLike] = ()
    part: MeshLike | None = None
    stock: MeshLike | None = None
    tools: str | ToolShape | Iterable[str | ToolShape] = ()
    tool_libraries: Sequence[FilePath] = ()
    unit: Literal["mm", "inch"] | None = None

    @property
    def are_given(self) -> bool:
        """Whether there are any but stock and part, which are asked for the table, too."""
        several = (self.fixtures, self.tools, self.tool_libraries)
        return any(not isinstance(each, tuple | list) or len(each) > 0 for each in several)


@dataclass(frozen=True, slots=True, eq=False)
class PlacedBodies:
    """What was read: the pairs that are kept apart, the machine with the length of its longest tool, and warnings."""

    guard: Guard
    machine: Machine
    problems: tuple[Problem, ...]


def read_bodies(given: BodiesInput, placed: PlacedInput, machine: Machine, *, is_needed: bool = True) -> PlacedBodies:
    """Read the bodies that a path is placed among; where they are not needed, a warning says that none could meet.

    Raises ``InputError`` if a mesh or a tool cannot be used, or the length of a tool is not known and bodies of the
    machine are to be kept apart; or if they are needed, and no two could meet.
    """
    problems: list[Problem] = []
    carried = list(_carried(given, problems))
    bodies = guarded_machine(machine_bodies(machine, problems.append))
    tools = _tools(given, placed, problems)
    lengths = _lengths(placed, tools, machine, is_asked=bool(bodies))
    for number, shape in tools.items():
        bodies += guarded_tool(shape, machine, placed.tools[number] or NO_CALL, lengths.get(number, 0.0), number)
    pairs = guarded_pairs(machine, [*bodies, *carried])
    could_meet = any(pair.weight == 1.0 or pair.changes is Changes.PLACE for pair in pairs.kept)
    if not could_meet:
        problems.append(_none_could_meet(machine, is_needed=is_needed))
        if is_needed:
            raise InputError(problems[-1])
    guard = Guard(pairs.kept if could_meet else (), placed.tool, lengths, pairs.left_out)
    if could_meet and not guard.is_changed:
        problems.append(argument_problem("goal", Wording("PLC270", "bodies_always_alike"), severity=Severity.WARNING))
    problems += _other_lengths(placed, lengths, machine)
    if (machine.tool_length is None or machine.tool_lengths) and lengths:
        machine = replace(machine, tool_length=max(lengths.values()), tool_lengths={})
    return PlacedBodies(guard, machine, tuple(dict.fromkeys(problems)))


def _none_could_meet(machine: Machine, *, is_needed: bool) -> Problem:
    """Return what is missing where there are no two bodies to be kept apart."""
    name, severity = ("goal", Severity.ERROR) if is_needed else ("tools", Severity.WARNING)
    return argument_problem(name, Wording("PLC190", "no_two_bodies", machine=machine.key), severity=severity)


def _carried(given: BodiesInput, problems: list[Problem]) -> Iterable[Guarded]:
    """Yield what is clamped with the part."""
    for fixture in fixture_meshes(given.fixtures, problems):
        yield guarded_on_part(fixture, BodyKind.FIXTURE)
    if given.part is not None:
        yield guarded_on_part(read_mesh(given.part, "part", problems), BodyKind.PART)
    if given.stock is not None:
        mesh = stock_mesh(given.stock, problems).named("stock")
        yield guarded_on_part(mesh, BodyKind.PART, is_stock=True)


def stock_mesh(stock: MeshLike, problems: list[Problem]) -> TriangleMesh:
    """Return a stock as a mesh, mm; warnings are added to the problems.

    Raises ``InputError`` if a mesh cannot be used, or the text of a stock is none.
    """
    return stock_shape(stock, problems.append).as_mesh()


def _tools(given: BodiesInput, placed: PlacedInput, problems: list[Problem]) -> dict[int, ToolShape]:
    """Return the bodies of the tools that are called, by their number in ``placed.tools``; one without a form
    is told.
    """
    known = known_tools(given.tools, given.tool_libraries, given.unit, placed.toolpaths)
    found: dict[int, ToolShape] = {}
    for number in placed.used_tools:
        called = placed.tools[number] or NO_CALL
        try:
            found[number] = known.choose([called])[called]
        except InputError as error:
            if placed.tools[number] and (known.stated or known.libraries):
                raise
            first = error.problems[0]
            problems.append(
                warning(
                    first.file, first.line, Wording("PLC280", "tool_not_kept_apart", tool=called, reason=first.wording)
                )
            )
    return found


def _lengths(
    placed: PlacedInput, tools: Mapping[int, ToolShape], machine: Machine, *, is_asked: bool
) -> dict[int, float]:
    """Lengths of the tools, gauge point to tip, mm, by their number; those that nobody states are left out."""
    lengths = {}
    stated = stated_lengths(placed, machine) if machine.tool_lengths else {}
    for number in placed.used_tools:
        length = (tools[number].length if number in tools else 0.0) or stated.get(number, machine.tool_length)
        if length:
            lengths[number] = length
        elif is_asked:
            raise InputError(
                argument_problem(
                    "tool_length", Wording("SIM310", "length_of_tool_unknown", tool=placed.tools[number] or NO_CALL)
                )
            )
    return lengths


def stated_lengths(placed: PlacedInput, machine: Machine) -> dict[int, float]:
    """Lengths of the tools in the spindle, mm, by their number in ``placed.tools``: stated ones, then those of the CL
    files.

    Empty unless each tool has one, and only one.

    Raises ``InputError`` if lengths of single tools are stated, and one is missing.
    """
    of_call: dict[str, set[float]] = {}
    names: dict[str, set[str]] = {}
    for each in tools_of_toolpaths(placed.toolpaths):
        called = each.tool.name if each.number is None else str(each.number)
        of_call.setdefault(called, set()).add(each.tool.set_length)
        names.setdefault(called, set()).add(each.tool.name)
    found = {}
    for number in placed.used_tools:
        called = placed.tools[number]
        keys = [tool_key(name) for name in (called, *sorted(names.get(called, ())))]
        stated = next((machine.tool_lengths[key] for key in keys if key in machine.tool_lengths), machine.tool_length)
        found[number] = of_call.get(called, {0.0}) if stated is None else {stated}
    unknown = [number for number, lengths in found.items() if len(lengths) > 1 or 0.0 in lengths]
    if unknown and machine.tool_lengths:
        raise length_of_tool_missing(placed.tools[unknown[0]])
    return {} if unknown else {number: max(lengths) for number, lengths in found.items()}


def _other_lengths(placed: PlacedInput, lengths: Mapping[int, float], machine: Machine) -> Iterable[Problem]:
    """Yield a warning where tools have other lengths than the one that is stated for all, which programs are checked
    with.
    """
    stated = machine.tool_length
    other = {} if stated is None else {k: own for k, own in lengths.items() if abs(own - stated) > _LIKE_LENGTH}
    if other:
        tools = tuple(f"{placed.tools[k] or NO_CALL} of {own:g} mm" for k, own in other.items())
        yield argument_problem(
            "tool_length", Wording("PLC290", "lengths_differ", stated=stated, tools=tools), severity=Severity.WARNING
        )
