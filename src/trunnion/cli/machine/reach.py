"""``trunnion reach``: which tool axes and points a machine reaches."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.capability.part_reach import PartReach
from trunnion.capability.path_reach import PathReach
from trunnion.capability.reach import Reach, TiltReach
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.jobs.capability.reach_report import write_reach_plot
from trunnion.jobs.capability.reaching import reach
from trunnion.jobs.job import Given
from trunnion.machines.reach import ReachedVolume
from trunnion.wording import counted, position

_DM3: Final = 1e6

#: Facets that the text shows; the data has all.
_MOST: Final = 12


def run(given: Given) -> int:
    """Tell and draw what is reached; 0 if all that was asked for is, else 1."""
    terminal = Terminal()
    found = reach(**given.arguments(), observer=terminal)
    terminal.problems(found.remarks)
    if given.plot is not None:
        write_reach_plot(found, given.plot, given.read)
    show(given, lambda: found, reach_lines(found))
    missed = any(each.no_axis or each.no_travel for each in found.paths)
    return 1 if missed or (found.part is not None and len(found.part.missed)) else 0


def reach_lines(found: Reach) -> Iterator[str]:
    """Yield what is reached, in lines: first what was asked about part and files, then the table over tilts."""
    if found.part is not None:
        yield from _part_lines(found.part, found)
    for path in found.paths:
        yield _path_line(path, found)
    machine = found.machine
    length = "no tool" if not machine.tool_length else f"a tool of {machine.tool_length:g} mm"
    yield f"{machine.name} with {length}: {100.0 * found.sphere:.1f} % of all tool axes"
    yield "tilt from Z  azimuths  positions  one position dm³       at every azimuth dm³        at some azimuth dm³"
    for each in found.tilts:
        if each.share:
            yield _tilt_line(each)
    none = [each.tilt for each in found.tilts if not each.share]
    if none:
        yield f"no tool axis with a tilt of {_ranges(none, found.step)}"
    between = max(each.between for each in found.tilts)
    if between:
        yield (
            f"bounds allow for tool axes between those tried, every {found.step:g}°: half-way points move by up to"
            f" {between:.0f} mm; a smaller --step narrows them"
        )


def _tilt_line(each: TiltReach) -> str:
    low, high = min(each.branches), max(each.branches)
    positions = f"{low}" if low == high else f"{low} to {high}"
    pose = "" if each.one_pose is None else _dm3(each.one_pose[1])
    volumes = f"{_volume(each.every):>26}{_volume(each.some):>26}"
    return f"{each.tilt:>10g}°{100.0 * each.share:>8.1f} %{positions:>11}{pose:>17}{volumes}".rstrip()


def _volume(volume: ReachedVolume | None) -> str:
    if volume is None:
        return ""
    if volume.high - volume.low <= 5e-4 * volume.high:
        return _dm3(volume.likely)
    return f"{_dm3(volume.likely)} ({_dm3(volume.low)}–{_dm3(volume.high)})"


def _dm3(volume: float) -> str:
    return f"{volume / _DM3:.1f}"


def _ranges(tilts: list[float], step: float) -> str:
    """Tilts that follow each other, as ranges."""
    parts, start = [], 0
    for k in range(1, len(tilts) + 1):
        if k == len(tilts) or tilts[k] - tilts[k - 1] > step * 1.001:
            one = tilts[start] == tilts[k - 1]
            parts.append(f"{tilts[start]:g}°" if one else f"{tilts[start]:g}° to {tilts[k - 1]:g}°")
            start = k
    return ", ".join(parts)


def _not_judged(found: Reach) -> str:
    """Return what is not known of linear axes, in words, with what to give; empty where all are judged."""
    slides, machine = found.unjudged_axes, found.machine
    if not slides:
        return ""
    free = [k for k in machine.linear if not machine.axes[k].has_limits]
    cure = "give --zero" if machine.workpiece_zero is None else "give --tool-length"
    cure = "the machine states no limits" if len(free) == len(slides) else cure
    names = "linear axes are" if len(slides) == len(machine.linear) else f"{' and '.join(slides)} {_is(len(slides))}"
    return f"{names} not judged ({cure})"


def _is(count: int) -> str:
    return "is" if count == 1 else "are"


def _part_lines(part: PartReach, found: Reach) -> Iterator[str]:
    near = "along its normal" if not part.lean else f"within {part.lean:g}° of its normal"
    missed = part.missed
    share = f"{100.0 * part.share:.1f} % of the surface is reached {near} ({counted(len(part.area), 'facet')})"
    if unknown := _not_judged(found):
        share += f" as far as it is known: {unknown}"
    yield f"{part.name}: {share}"
    for which, why in (
        (~part.axis, "no such tool axis"),
        (part.axis & ~part.travel, "beyond the travel of the linear axes"),
    ):
        if which.any():
            tilts = np.degrees(np.arccos(np.clip(part.normal[which, 2], -1.0, 1.0)))
            lost = 100.0 * float(part.area[which].sum() / part.area.sum())
            yield f"  {why}: {lost:.1f} %, normals tilted from {tilts.min():.1f}° to {tilts.max():.1f}°"
    for k in missed[:_MOST].tolist():
        i, j, n = part.normal[k] + 0.0
        why = "beyond the travel of the linear axes" if part.axis[k] else "no such tool axis"
        yield (
            f"  facet {k + 1}: {part.area[k]:.1f} mm² at {position(part.centre[k])},"
            f" normal {i:.3f} {j:.3f} {n:.3f}: {why}"
        )
    if len(missed) > _MOST:
        yield f"  and {len(missed) - _MOST} more"


def _path_line(path: PathReach, found: Reach) -> str:
    tilts = f"tilts from {path.tilts[0]:.2f}° to {path.tilts[1]:.2f}°"
    faults = []
    if path.no_axis:
        faults.append(
            f"the tool axis of {counted(path.no_axis, 'point')} cannot be had, first in line {path.no_axis_line}"
        )
    if path.no_travel:
        faults.append(f"{counted(path.no_travel, 'point')} beyond the travel, first in line {path.no_travel_line}")
    unknown = _not_judged(found)
    fine = "every tool axis can be had" if len(found.unjudged_axes) == len(found.machine.linear) else "all reached"
    told = "; ".join(faults) or fine
    return f"{path.file}: {counted(path.points, 'point')}, {tilts}: {told}{'; but ' if unknown else ''}{unknown}"
