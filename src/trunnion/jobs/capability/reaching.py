"""What a machine reaches: tool axes, points with each tilt, the surface of a part, and the points of CL files."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, Unpack

from trunnion.capability.part_reach import facet_reach
from trunnion.capability.path_reach import path_reach
from trunnion.capability.reach import (
    Reach,
    TiltReach,
    reach_remarks,
    sphere_share,
    tilt_reach,
    tilts_between,
)
from trunnion.errors import Problem, warning
from trunnion.jobs.arguments import ReachArguments, taken
from trunnion.jobs.inputs.arguments import check_path, wrong_argument
from trunnion.jobs.inputs.driven_paths import centres_of
from trunnion.jobs.inputs.hooked import hooked_toolpaths
from trunnion.jobs.inputs.reading import MachineLike, as_machine, as_toolpaths, stated_reading
from trunnion.jobs.inputs.stated_setup import check_one_zero, length_of_tool_missing, set_up_machine
from trunnion.jobs.inputs.tool_lengths import called_tools, with_lengths_of_tools
from trunnion.jobs.observer import SILENT, Observer
from trunnion.machines import Machine
from trunnion.machines.machine import tool_key
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.simulation.meshes import load_mesh

_STEPS: Final = (1.0, 45.0)

#: The farthest that a tool may lean from a surface normal, degrees.
_MOST_LEAN: Final = 90.0


def reach(machine: MachineLike, *, observer: Observer = SILENT, **given: Unpack[ReachArguments]) -> Reach:
    """Tell what a machine reaches.

    Parameters
    ----------
    machine
        A name, a path or a ``Machine``.
    cl
        CL files whose points are judged, in one program's coordinates, those of the first operation.
    units, dialect, strict
        How the CL files are read, as ``trunnion.read_cl`` has it.
    settings
        The same, as for ``trunnion.post``: ``cutcom``, ``open_cycle``, ``spline_tolerance``.
    hooks
        Python files that change the CL files, as for ``trunnion.post``. They are run.
    part
        Mesh of a part in workpiece coordinates, mm, each of whose facets the tip is to reach along its normal.
    lean
        How far the tool axis may lean from that normal, degrees.
    zero : (3,) float, mm
        Workpiece zero on the machine; without one, tool axes are judged, but not where a part or a point is.
    tool_length
        From the gauge point of the spindle to the tip, mm, or ``{"1": 110.0, "2": 85.0}`` of each tool. Points are
        judged with the tool of their operation then, and all else with the longest.
    step
        Degrees between tilts, and most between azimuths, from 1 to 45.
    observer
        Receives the progress of reading CL files, and warnings about them.

    Returns
    -------
    Reach
        For each tilt the azimuths that can be had and the volumes of tips; for a part the facets that are not reached.

    Raises
    ------
    InputError
        When a file or an argument cannot be used.

    Notes
    -----
    Volumes are those of tips in the workpiece frame, and do not depend on the workpiece zero. That of one rotary
    position is exact. Those over azimuths have bounds, which allow for the azimuths between those that are tried.
    Nothing is in the way of the tool here: collisions are up to ``simulate``.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.reach("generic_head_head_ca", tool_length=100, step=30)
    >>> [each.tilt for each in found.tilts if each.share == 1.0]
    [0.0, 30.0, 60.0, 90.0]
    """
    found = taken(ReachArguments, "reach", given)
    degrees, part = _number("step", found["step"], *_STEPS), found["part"]
    leaning = _number("lean", found["lean"], 0.0, _MOST_LEAN)
    loaded = set_up_machine(as_machine(machine), found["zero"], found["tool_length"])
    check_one_zero(loaded, Wording("ARG220", "zero_of_no_offset"))
    toolpaths = hooked_toolpaths(
        as_toolpaths(found["cl"], observer, stated_reading(found["settings"], found["strict"])),
        loaded,
        found["hooks"],
    )
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    centres, notices = centres_of(toolpaths, loaded)
    observer.problems(notices)
    machine_of, longest = _machines(loaded, centres)
    surface = None
    if part is not None:
        mesh = load_mesh(check_path("part", part), warn=lambda problem: observer.problems((problem,)))
        surface = facet_reach(longest, mesh, leaning, degrees)
    return Reach(
        longest,
        degrees,
        _of_tilts(longest, degrees, observer),
        sphere_share(longest),
        surface,
        path_reach(machine_of, centres, degrees),
        (
            *reach_remarks(longest, placed=part is not None or bool(toolpaths)),
            *([] if longest is loaded else [_of_longest(longest)]),
        ),
    )


def _machines(loaded: Machine, toolpaths: Sequence[Toolpath]) -> tuple[Callable[[Operation], Machine], Machine]:
    """Return the machine of each operation, with its own tool, and that with the longest; the same for one length.

    Raises ``InputError`` if lengths of single tools are stated, and one is missing.
    """
    if not loaded.tool_lengths:
        return lambda _: loaded, loaded
    known = with_lengths_of_tools(loaded, toolpaths)
    machines, of_length = dict[int, Machine](), dict[float, Machine]()
    for operation, names in called_tools(toolpaths):
        name = next((each for each in names if tool_key(each) in known.tool_lengths), names[0] if names else "")
        own = known.set_up_for(name, 0)
        if own.tool_length is None and len(operation.moves):
            raise length_of_tool_missing(name)
        machines[id(operation)] = of_length.setdefault(own.tool_length or 0.0, own)
    lengths = list(of_length) or [*loaded.tool_lengths.values()]
    longest = replace(loaded, tool_length=max([*lengths, loaded.tool_length or 0.0]), tool_lengths={})
    return lambda operation: machines[id(operation)], longest


def _of_longest(machine: Machine) -> Problem:
    """Return the warning of several lengths: what is reached with a tilt, or of a part, depends on one."""
    return warning(machine.key, 0, Wording("RCH140", "longest_of_tools", length=machine.tool_length))


def _number(name: str, value: object, least: float, most: float) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and least <= value <= most:
        return float(value)
    raise wrong_argument(name, value, phrase("give_degrees_from_to", least=least, most=most))


def _of_tilts(machine: Machine, step: float, observer: Observer) -> tuple[TiltReach, ...]:
    tilts, found = tilts_between(step), []
    with observer.progress(machine.key, len(tilts), "tilts") as advance:
        for tilt in tilts:
            found.append(tilt_reach(machine, tilt, step))
            advance(1)
    return tuple(found)
