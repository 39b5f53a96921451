"""``trunnion reach``: which tool axes and points a machine reaches."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.capability.part_reach import PartReach
from trunnion.capability.path_reach import PathReach
from trunnion.capability.reach import Reach, TiltReach
from trunnion.cli.columns import padded
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, part, spoken, together
from trunnion.jobs.capability.reach_report import write_reach_plot
from trunnion.jobs.capability.reaching import reach
from trunnion.jobs.job import Given
from trunnion.machines.reach import ReachedVolume
from trunnion.messages import Wording
from trunnion.wording import position

_DM3: Final = 1e6

#: Columns of the table over tilts, and their widths.
_HEADS: Final = (
    ("tilt", 11), ("azimuths", 10), ("positions", 11), ("one_position", 18), ("every", 27), ("some", 27),
)  # fmt: skip

#: Facets that the text shows; the data has all.
_MOST: Final = 12


def run(given: Given) -> int:
    """Tell and draw what is reached; 0 if all that was asked for is, else 1."""
    terminal = Terminal()
    found = reach(**given.arguments(), observer=terminal)
    terminal.problems(found.remarks)
    if given.plot is not None:
        write_reach_plot(found, given.plot, given.read, spoken())
    show(given, lambda: found, reach_lines(found))
    missed = any(each.no_axis or each.no_travel for each in found.paths)
    return 1 if missed or (found.part is not None and len(found.part.missed)) else 0


def reach_lines(found: Reach) -> Iterator[str]:
    """Yield what is reached, in lines: first what was asked about part and files, then the table over tilts."""
    if found.part is not None:
        yield from _part_lines(found.part, found)
    for path in found.paths:
        yield _path_line(path, found)
    machine, share = found.machine, 100.0 * found.sphere
    if machine.tool_length:
        yield line("machine_with_tool", machine=machine.name, length=machine.tool_length, share=share)
    else:
        yield line("machine_without_tool", machine=machine.name, share=share)
    yield "".join(padded(line(f"head_{head}"), width, right=True) for head, width in _HEADS)
    for each in found.tilts:
        if each.share:
            yield _tilt_line(each)
    none = [each.tilt for each in found.tilts if not each.share]
    if none:
        yield line("no_axis_with_tilts", tilts=_ranges(none, found.step))
    between = max(each.between for each in found.tilts)
    if between:
        yield line("bounds_between", step=found.step, most=between)


def _tilt_line(each: TiltReach) -> str:
    low, high = min(each.branches), max(each.branches)
    positions = f"{low}" if low == high else line("range", low=str(low), high=str(high))
    pose = "" if each.one_pose is None else _dm3(each.one_pose[1])
    volumes = f"{_volume(each.every):>26}{_volume(each.some):>26}"
    return (
        f"{each.tilt:>10g}°{100.0 * each.share:>8.1f} %{padded(positions, 11, right=True)}{pose:>17}{volumes}".rstrip()
    )


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
            parts.append(f"{tilts[start]:g}°" if one else line("tilt_range", low=tilts[start], high=tilts[k - 1]))
            start = k
    return ", ".join(parts)


def _not_judged(found: Reach) -> Wording | None:
    """Return what is not known of linear axes, with what to give; None where all are judged."""
    slides, machine = found.unjudged_axes, found.machine
    if not slides:
        return None
    free = [k for k in machine.linear if not machine.axes[k].has_limits]
    cure = part("give_zero") if machine.workpiece_zero is None else part("give_length")
    cure = part("no_limits_stated") if len(free) == len(slides) else cure
    if len(slides) == len(machine.linear):
        return part("not_judged_all", cure=cure)
    if len(slides) == 1:
        return part("not_judged_one", axis=slides[0], cure=cure)
    return part("not_judged_some", axes=tuple(slides), cure=cure)


def _part_lines(found: PartReach, whole: Reach) -> Iterator[str]:
    near = part("within_of_normal", lean=found.lean) if found.lean else part("along_normal")
    missed = found.missed
    share = {"part": found.name, "share": 100.0 * found.share, "near": near, "count": len(found.area)}
    unknown = _not_judged(whole)
    yield (
        line("share_reached", **share) if unknown is None else line("share_reached_as_known", **share, unknown=unknown)
    )
    for which, why in (
        (~found.axis, part("no_such_axis")),
        (found.axis & ~found.travel, part("beyond_linear_travel")),
    ):
        if which.any():
            tilts = np.degrees(np.arccos(np.clip(found.normal[which, 2], -1.0, 1.0)))
            lost = 100.0 * float(found.area[which].sum() / found.area.sum())
            yield "  " + line("lost_share", why=why, lost=lost, low=tilts.min(), high=tilts.max())
    for k in missed[:_MOST].tolist():
        i, j, n = found.normal[k] + 0.0
        yield "  " + line(
            "facet_missed",
            number=k + 1,
            area=found.area[k],
            place=position(found.centre[k]),
            normal=f"{i:.3f} {j:.3f} {n:.3f}",
            why=part("beyond_linear_travel" if found.axis[k] else "no_such_axis"),
        )
    if len(missed) > _MOST:
        yield "  " + line("and_more", count=len(missed) - _MOST)


def _path_line(path: PathReach, found: Reach) -> str:
    faults = []
    if path.no_axis:
        faults.append(line("axis_not_had", count=path.no_axis, line=path.no_axis_line))
    if path.no_travel:
        faults.append(line("points_beyond", count=path.no_travel, line=path.no_travel_line))
    unknown = _not_judged(found)
    fine = "every_axis_had" if len(found.unjudged_axes) == len(found.machine.linear) else "all_reached"
    low, high = path.tilts
    told = {"file": path.file, "count": path.points, "low": low, "high": high}
    told["told"] = together(*faults) if faults else line(fine)
    return line("path_reached", **told) if unknown is None else line("path_reached_but", **told, unknown=unknown)
