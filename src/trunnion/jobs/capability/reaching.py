"""What a machine reaches: tool axes, points with each tilt, the surface of a part, and the points of CL files."""

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
from trunnion.cl.read import ClReading
from trunnion.jobs.arguments import ReachArguments, taken
from trunnion.jobs.inputs.arguments import check_path, wrong_argument
from trunnion.jobs.inputs.driven_paths import centres_of
from trunnion.jobs.inputs.hooked import hooked_toolpaths
from trunnion.jobs.inputs.reading import MachineLike, as_machine, as_toolpaths
from trunnion.jobs.inputs.stated_setup import set_up_for_all
from trunnion.jobs.observer import SILENT, Observer
from trunnion.machines import Machine
from trunnion.messages import phrase
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
    hooks
        Python files that change the CL files, as for ``trunnion.post``. They are run.
    part
        Mesh of a part in workpiece coordinates, mm, each of whose facets the tip is to reach along its normal.
    lean
        How far the tool axis may lean from that normal, degrees.
    zero : (3,) float, mm
        Workpiece zero on the machine; without one, tool axes are judged, but not where a part or a point is.
    tool_length
        From the gauge point of the spindle to the tip, mm.
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
    loaded = set_up_for_all(as_machine(machine), found["zero"], found["tool_length"])
    toolpaths = hooked_toolpaths(
        as_toolpaths(found["cl"], observer, ClReading(found["units"], found["dialect"], found["strict"])),
        loaded,
        found["hooks"],
    )
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    centres, notices = centres_of(toolpaths, loaded)
    observer.problems(notices)
    surface = None
    if part is not None:
        mesh = load_mesh(check_path("part", part), warn=lambda problem: observer.problems((problem,)))
        surface = facet_reach(loaded, mesh, leaning, degrees)
    return Reach(
        loaded,
        degrees,
        _of_tilts(loaded, degrees, observer),
        sphere_share(loaded),
        surface,
        path_reach(loaded, centres, degrees),
        tuple(reach_remarks(loaded, placed=part is not None or bool(toolpaths))),
    )


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
