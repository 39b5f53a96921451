"""What a machine reaches as data and as a picture.

In:     ``Reach``.
Out:    plain data, or the file of the picture.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.capability.part_reach import PartReach
from trunnion.capability.reach import Reach, TiltReach
from trunnion.files import OutputPlace, atomic_file, check_outputs
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import check_output_name
from trunnion.machines.reach import ReachedVolume
from trunnion.reporting.reach_picture import ReachPicture, TiltOfPicture, reach_picture
from trunnion.reporting.text import clean

#: Decimals of volumes, mm^3.
_DECIMALS: Final = 1


def check_reach_plot(file: FilePath, inputs: Iterable[FilePath]) -> OutputPlace:
    """The place of a picture; raises ``InputError`` if it cannot be written, or is one of the files that are read."""
    place = check_output_name("plot", file, (".svg",), "reach is drawn as SVG")
    check_outputs([file], inputs)
    return place


def write_reach_plot(found: Reach, file: FilePath, inputs: Iterable[FilePath] = ()) -> None:
    """Draw the sphere of tool axes, and the volume of tips over the tilt.

    Raises
    ------
    InputError
        When the name does not end in ``.svg``, the file cannot be written, or it is one of ``inputs``.
    """
    read = list(inputs)
    with atomic_file(check_reach_plot(file, read), inputs=read) as sink:
        sink.write(reach_picture(_picture(found)).encode())


def reach_data(found: Reach) -> dict[str, Any]:
    """Reach as data; volumes in mm^3."""
    machine = found.machine
    return {
        "schema": 1,
        "machine": machine.key,
        "workpiece_zero_mm": None if machine.workpiece_zero is None else list(machine.workpiece_zero),
        "tool_length_mm": machine.tool_length,
        "step_deg": found.step,
        "sphere_share": round(found.sphere, 6),
        "slides_not_judged": list(found.unjudged_axes),
        "tilts": [_tilt_data(each) for each in found.tilts],
        "part": None if found.part is None else _part_data(found.part),
        "files": [
            {
                "file": each.file,
                "points": each.points,
                "tilt_deg": [round(tilt, 6) for tilt in each.tilts],
                "no_tool_axis": {"points": each.no_axis, "first_line": each.no_axis_line or None},
                "no_travel": {"points": each.no_travel, "first_line": each.no_travel_line or None},
            }
            for each in found.paths
        ],
        "remarks": [
            {"file": r.file, "line": r.line, "what": r.what, "cure": r.cure, "code": r.code} for r in found.remarks
        ],
    }


def _tilt_data(each: TiltReach) -> dict[str, Any]:
    return {
        "tilt_deg": each.tilt,
        "azimuth_share": round(each.share, 6),
        "branches": list(each.branches),
        "one_pose_mm3": None if each.one_pose is None else [round(volume, _DECIMALS) for volume in each.one_pose],
        "some_azimuth_mm3": _volume_data(each.some),
        "every_azimuth_mm3": _volume_data(each.every),
        "half_way_between_mm": round(each.between, 6),
    }


def _volume_data(volume: ReachedVolume | None) -> dict[str, float] | None:
    if volume is None:
        return None
    return {
        "at_least": round(volume.low, _DECIMALS),
        "likely": round(volume.likely, _DECIMALS),
        "at_most": round(volume.high, _DECIMALS),
    }


def _part_data(part: PartReach) -> dict[str, Any]:
    return {
        "name": part.name,
        "lean_deg": part.lean,
        "facets": len(part.area),
        "area_mm2": round(float(part.area.sum()), 6),
        "reached_share": round(part.share, 6),
        "no_tool_axis": np.flatnonzero(~part.axis).tolist(),
        "no_travel": np.flatnonzero(part.axis & ~part.travel).tolist(),
    }


def _picture(found: Reach) -> ReachPicture:
    machine = found.machine
    length = "" if machine.tool_length is None else f", tool {machine.tool_length:g} mm"
    return ReachPicture(
        clean(f"{machine.name}{length}: {100.0 * found.sphere:.0f} % of all directions"),
        [
            TiltOfPicture(
                each.tilt, each.branches, 0.0 if each.one_pose is None else each.one_pose[1],
                _triple(each.some), _triple(each.every),
            )
            for each in found.tilts
        ],
        found.step,
        [(clean(Path(each.file).name), *each.tilts) for each in found.paths],
    )  # fmt: skip


def _triple(volume: ReachedVolume | None) -> tuple[float, float, float] | None:
    return None if volume is None else (volume.low, volume.likely, volume.high)
