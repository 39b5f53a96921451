"""A placement as data for JSON; the schema is in ``docs/placing.md``."""

import math
from dataclasses import asdict
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.clamping import clamping_data
from trunnion.placing.placement import AxisUse, BodyDistance, Limit, PartPlace, Placement

_DECIMALS: Final = 6


def placement_data(found: Placement) -> dict[str, object]:
    """A placement as data; the schema is in ``docs/placing.md``."""
    region = found.region
    return {
        "schema": 1,
        "machine": found.machine,
        "files": list(found.files),
        "goal": found.goal,
        "fits": found.fits,
        "best": None if found.best is None else _place(found.best),
        "present": None if found.present is None else _place(found.present),
        "limits": [_limit(limit) for limit in found.limits],
        "share_of_turns": _number(found.share_of_turns),
        "turns": [
            {
                "turn_deg": _number(turn.turn_deg),
                "tilt_deg": _number(turn.tilt_deg),
                "asked": turn.is_asked,
                "fits": turn.fits,
                "margin_mm": None if turn.margin_mm is None else _number(turn.margin_mm),
                "zero_mm": None if turn.zero_mm is None else [_number(value) for value in turn.zero_mm],
                "value": None if turn.value is None else _number(turn.value),
                "obstacle": turn.obstacle,
            }
            for turn in found.turns
        ],
        "region": None
        if region is None
        else {
            "inside_low_mm": _numbers(region.box.low),
            "inside_high_mm": _numbers(region.box.high),
            "low_mm": _numbers(region.low),
            "high_mm": _numbers(region.high),
            "volume_mm3": _number(region.volume),
            "corners_mm": [_numbers(corner) for corner in region.corners],
            "tolerance_mm": _number(region.tolerance),
        },
        "table": None
        if found.table is None
        else {
            "size_mm": found.table.size and list(found.table.size),
            "diameter_mm": found.table.diameter,
            "centre_mm": list(found.table.centre),
        },
        "between_mm": _number(found.between_mm),
        "stated": clamping_data(found.clamping),
        "clamped": clamping_data(found.clamped),
        "distance_mm": None if found.distance_mm is None else _number(found.distance_mm),
        "nearest_anywhere": _nearest(found.nearest_anywhere),
        "most_distance_mm": None if found.most_distance_mm is None else _number(found.most_distance_mm),
        "left_out": [list(names) for names in found.left_out],
        "remarks": [asdict(each) | {"severity": str(each.severity)} for each in found.remarks],
    }


def _place(place: PartPlace) -> dict[str, object]:
    return {
        "zero_mm": [_number(value) for value in place.zero_mm],
        "turn_deg": _number(place.turn_deg),
        "tilt_deg": _number(place.tilt_deg),
        "margin_mm": _number(place.margin_mm),
        "value": None if place.value is None else _number(place.value),
        "planned_s": None if place.planned_s is None else _number(place.planned_s),
        "table_mm": None if place.table_mm is None else _number(place.table_mm),
        "nearest": _nearest(place.nearest),
        "axes": [_axis(axis) for axis in place.axes],
        "rotary": [
            {name: value if isinstance(value, str) else _number(value) for name, value in asdict(axis).items()}
            for axis in place.rotary
        ],
    }


def _nearest(found: BodyDistance | None) -> dict[str, object] | None:
    return None if found is None else asdict(found) | {"distance_mm": _number(found.distance_mm)}


def _axis(axis: AxisUse) -> dict[str, object]:
    return {
        "axis": axis.axis,
        "least_mm": _number(axis.least_mm),
        "greatest_mm": _number(axis.greatest_mm),
        "margin_mm": _number(axis.margin_mm),
        "low": _limit(axis.low),
        "high": _limit(axis.high),
    }


def _limit(limit: Limit) -> dict[str, object]:
    return asdict(limit) | {"limit_mm": _number(limit.limit_mm)}


def _numbers(values: Floats) -> list[float | None]:
    return [_number(value) for value in np.asarray(values).tolist()]


def _number(value: float) -> float | None:
    """A number for JSON; None where there is none, or no limit to it."""
    return round(value, _DECIMALS) + 0.0 if math.isfinite(value) else None
