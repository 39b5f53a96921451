"""What a machine reaches with each tilt of the tool axis."""

import math
from dataclasses import replace
from itertools import pairwise
from operator import attrgetter
from typing import Annotated, ClassVar, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.capability.part_reach import PartReach
from trunnion.capability.path_reach import PathReach
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine
from trunnion.machines.reach import AxisPoses, PoseBodies, ReachedVolume, axis_poses, pose_bodies, reached_volumes
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Degrees, Figure

#: Directions by which the share of the sphere is found.
_SPREAD: Final = 40_000

#: Points go to the next azimuth on arcs, so half of the way is a little more than half of the chord.
_BENT: Final = 1.05

#: Tilts that differ by less are the same, degrees.
_SAME: Final = 1e-9


@dataclass(frozen=True, slots=True)
class TiltReach:
    """What is reached with one tilt of the tool axis from the workpiece's Z.

    tilt       degrees
    branches   how many rotary positions give the tool axis at each azimuth, from 0 degrees on; one azimuth where the
               tool axis is Z itself, up or down
    one_pose   least and greatest volume of the tips of one rotary position, mm^3, exact; None: no linear axis limits
    some       volume of the points reached at some azimuth, mm^3; None: no linear axis limits
    every      volume of the points reached at every azimuth
    between    how far points of one rotary position go half-way to the next azimuth, at most, mm: bounds allow for it
    """

    tilt: Degrees
    branches: tuple[int, ...]
    one_pose: Annotated[tuple[float, float] | None, Figure(unit="mm3", decimals=1)]
    some: Annotated[ReachedVolume | None, Figure("some_azimuth", unit="mm3")]
    every: Annotated[ReachedVolume | None, Figure("every_azimuth", unit="mm3")]
    between: Annotated[float, Figure("half_way_between", unit="mm", decimals=6)]

    @property
    @Figure("azimuth_share", decimals=6, after="tilt_deg")
    def share(self) -> float:
        """Share of the azimuths at which the tool axis can be had."""
        return sum(count > 0 for count in self.branches) / len(self.branches)


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """What a machine reaches.

    machine  as it was set up, with workpiece zero and tool length if they are known
    step     degrees between tilts, and most between azimuths
    tilts    from 0 to 180 degrees
    sphere   share of all directions that the tool axis can have, to some 0.001
    part     of a part's surface; None: none was given
    paths    of CL files
    remarks  what was assumed
    """

    SCHEMA: ClassVar[int] = 2

    machine: Annotated[
        Machine,
        Figure(take=attrgetter("key")),
        Figure("workpiece_zero", unit="mm", take=attrgetter("workpiece_zero")),
        Figure("tool_length", unit="mm", take=attrgetter("tool_length")),
    ]
    step: Degrees
    tilts: tuple[TiltReach, ...]
    sphere: Annotated[float, Figure("sphere_share", decimals=6, after="step_deg")]
    part: PartReach | None
    paths: Annotated[tuple[PathReach, ...], Figure("files")]
    remarks: tuple[Problem, ...]

    @property
    @Figure("slides_not_judged", after="sphere_share")
    def unjudged_axes(self) -> tuple[str, ...]:
        """Names of the linear axes that part and paths are not held against: limits or places are not known."""
        machine = self.machine
        judged = [k for k in machine.linear if machine.is_placed(k) and machine.axes[k].has_limits]
        return tuple(machine.names[k] for k in machine.linear if k not in judged)

    @property
    def unjudged_slides(self) -> tuple[str, ...]:
        """The name of ``unjudged_axes`` before, which goes with the next version."""
        return self.unjudged_axes


def tilts_between(step: float) -> list[float]:
    """Tilts from 0 to 180 degrees."""
    tilts = [step * k for k in range(math.floor(180.0 / step + _SAME) + 1)]
    return tilts if 180.0 - tilts[-1] < _SAME else [*tilts, 180.0]


def tool_axes_at(tilt: float, step: float) -> Floats:
    """Tool axes of a tilt at azimuths from 0 degrees on, at most ``step`` degrees apart, (n, 3)."""
    angle = math.radians(tilt)
    if tilt < _SAME or 180.0 - tilt < _SAME:
        return np.array([[0.0, 0.0, 1.0 if tilt < _SAME else -1.0]])
    count = math.ceil(360.0 / step - _SAME)
    azimuth = 2.0 * np.pi / count * np.arange(count)
    across = math.sin(angle)
    return np.column_stack((across * np.cos(azimuth), across * np.sin(azimuth), np.full(count, math.cos(angle))))


def sphere_share(machine: Machine) -> float:
    """Share of all directions that the tool axis can have, from directions spread evenly over the sphere."""
    index = np.arange(_SPREAD) + 0.5
    height, azimuth = 1.0 - 2.0 * index / _SPREAD, index * math.pi * (3.0 - math.sqrt(5.0))
    across = np.sqrt(1.0 - height * height)
    axes = np.column_stack((across * np.cos(azimuth), across * np.sin(azimuth), height))
    return float((axis_poses(machine, axes).branches > 0).mean())


def tilt_reach(machine: Machine, tilt: float, step: float) -> TiltReach:
    """Return what is reached with a tilt, degrees, at azimuths at most ``step`` degrees apart."""
    axes = tool_axes_at(tilt, step)
    poses = axis_poses(machine, axes, step)
    branches = tuple(poses.branches.tolist())
    if not _has_travel(machine):
        return TiltReach(tilt, branches, None, None, None, 0.0)
    bodies = pose_bodies(machine, poses.rotary)
    between = _between(poses, bodies)
    some, every = reached_volumes(bodies, poses.direction, len(axes), between=between)
    volumes = bodies.volume.tolist() or [0.0]
    return TiltReach(tilt, branches, (min(volumes), max(volumes)), some, every, float(between.max(initial=0.0)))


def _between(poses: AxisPoses, bodies: PoseBodies) -> Floats:
    """How far the corners of each body go on the way half-way to the nearest one of the next azimuth, (k,) mm.

    At a pole the next angle of the free axis is meant. Where a neighbour cannot be had the others' greatest way counts.
    """
    count, k = len(poses.branches), len(bodies.volume)
    if not k:
        return np.zeros(0)
    if count == 1:
        parts, closes = [np.array([row]) for row in range(k)], False
    else:
        groups = np.searchsorted(poses.direction, np.arange(count + 1))
        parts, closes = [np.arange(first, end) for first, end in pairwise(groups)], True
    ways = np.full(k, np.nan)
    for at, own in enumerate(parts):
        for beside in (at - 1, at + 1):
            if not closes and not 0 <= beside < len(parts):
                continue
            other = parts[beside % len(parts)]
            if len(own) and len(other):
                apart = np.linalg.norm(bodies.corners[own][:, None] - bodies.corners[other][None], axis=3).max(axis=2)
                ways[own] = np.fmax(ways[own], apart.min(axis=1))
    greatest = float(np.nanmax(ways)) if np.isfinite(ways).any() else 0.0
    return np.asarray(_BENT * 0.5 * np.where(np.isnan(ways), greatest, ways))


def _has_travel(machine: Machine) -> bool:
    """Whether all linear axes have limits."""
    return bool(np.isfinite(machine.limits[list(machine.linear)]).all())


def reach_remarks(machine: Machine, placed: bool) -> list[Problem]:
    """Return what was assumed."""
    found = []
    missing = [machine.names[k] for k in machine.linear if not np.isfinite(machine.limits[k]).all()]
    if missing:
        found.append(Problem(machine.key, 0, Wording("RCH210", "no_limits_stated", missing=tuple(missing))))
    if machine.tool_length is None and any(machine.depends_on_length(column) for column in machine.linear):
        found.append(Problem(machine.key, 0, Wording("RCH140", "tool_length_not")))
    if placed and machine.workpiece_zero is None:
        found.append(Problem(machine.key, 0, Wording("RCH130", "workpiece_zero_not")))
    elif placed and machine.tool_length is None:
        found.append(Problem(machine.key, 0, Wording("RCH140", "tool_length_not_known")))
    return [replace(each, severity=Severity.WARNING) for each in found]
