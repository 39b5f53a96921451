"""What ``trunnion place`` says of bodies."""

from collections.abc import Iterator
from typing import Final

from trunnion.placing.placement import BodyDistance, Placement

#: What differs by less is printed as the same, mm.
_SAME: Final = 0.0005


def body_lines(found: Placement) -> Iterator[str]:
    """How far bodies are apart at the best place, at the present one, and wherever the part sits."""
    best, present = found.best, found.present
    if best is not None and best.nearest is not None:
        now = "" if present is None or present.nearest is None else f"; at the present zero {_apart(present.nearest)}"
        yield f"nearest to each other: {_apart(best.nearest)}{now}{_gain(found)}"
    if found.most_distance_mm is not None and not found.touching:
        yield f"no place at the turns that were tried keeps bodies farther apart than {found.most_distance_mm:.3f} mm"
    if found.nearest_anywhere is not None:
        yield f"wherever the part sits: {_apart(found.nearest_anywhere)}"


def touch_line(found: Placement) -> str | None:
    """Return what is said first where bodies touch everywhere; None where they do not."""
    if found.goal != "collisions" or found.touching is None:
        return None
    return f"{found.machine}: bodies touch wherever the part sits: {_apart(found.touching)}"


def _apart(nearest: BodyDistance) -> str:
    """Two bodies in words."""
    one, other = nearest.between
    apart = "touch" if nearest.touches else f"are {nearest.distance_mm:.3f} mm apart"
    return f"{one} and {other} {apart} ({nearest.file}:{nearest.line})"


def _gain(found: Placement) -> str:
    """How much farther apart bodies are at the best place than at the present one."""
    best, present = found.best, found.present
    if best is None or present is None or best.nearest is None or present.nearest is None:
        return ""
    return f"; the best place has {gain_text(best.nearest.distance_mm - present.nearest.distance_mm)}"


def gain_text(gain: float) -> str:
    """How much more the best place has than the present one, mm."""
    if abs(gain) < _SAME:
        return "the same"
    return f"{abs(gain):.3f} mm {'more' if gain > 0.0 else 'less'}"
