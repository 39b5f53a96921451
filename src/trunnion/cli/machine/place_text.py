"""A placement in lines: the best place, what holds it, how the part is clamped there, and what bodies do."""

from collections.abc import Iterator
from typing import Final

from trunnion.arrays import Floats
from trunnion.cli.wording import in_words, line, part
from trunnion.messages import Wording, phrase
from trunnion.model.clamping import are_one_angle, number
from trunnion.placing.placement import AxisUse, BodyDistance, Limit, PartPlace, Placement, RotaryUse, TurnMargin
from trunnion.placing.table_limits import KEPT
from trunnion.simulation.body_names import body_said
from trunnion.wording import format_duration

#: Turns out of reach that are told one by one.
_MOST: Final = 3

#: What differs by less is printed as the same, mm.
_SAME: Final = 0.0005


def placement_lines(found: Placement) -> Iterator[str]:
    """Yield a placement in lines."""
    best, present = found.best, found.present
    if best is None:
        yield from _none_lines(found)
        return
    if (touching := _touch_line(found)) is not None:
        yield touching
        yield "  " + line("largest_margin_at", zero=_point(best), clamped=_clamped(best))
    elif not best.fits:
        off = -best.margin_mm
        yield line("fits_nowhere", machine=found.machine, off=off, zero=_point(best), clamped=_clamped(best))
    else:
        left = part("to_the_limits", margin=best.margin_mm)
        yield line("best_zero", machine=found.machine, zero=_point(best), clamped=_clamped(best), left=left)
    yield from (f"  {each}" for each in _lines_of_best(found, best))
    if present is not None:
        yield f"  {_present_line(found, best, present)}"
    if found.goal not in ("margin", "collisions") and best.value is not None:
        value = part(f"value_{found.goal}", value=_goal_number(found.goal, best))
        if present is not None:
            value = part("and_at_present", value=value, present=_goal_number(found.goal, present))
        yield f"  {in_words(value)}"
    yield f"  {_share(found)}"
    if best.tilt_deg and (plain := _without_tilt(found)) is not None:
        yield "  " + line("without_fixture_angle", plain=plain)
    if found.region is not None:
        box = found.region.box
        yield "  " + line("zero_anywhere", ends=_ends(box.low, box.high))
        if not found.region.is_box:
            yield "  " + line("zero_not_beyond", ends=_ends(found.region.low, found.region.high))
    if found.unmeasured:
        yield f"  {in_words(phrase('stands_on', values=found.unmeasured))}"


def _none_lines(found: Placement) -> Iterator[str]:
    """Why there is no place at all."""
    off_table = any(turn.table_is_too_small for turn in found.turns)
    tried = part("tried_tilted_turn" if _is_tilted(found) else "tried_turn")
    yield line("place_none_on_table" if off_table else "place_none_reached", machine=found.machine, tried=tried)
    for turn in sorted(found.turns, key=lambda each: abs(each.tilt_deg))[:_MOST]:
        yield "  " + line("obstacle_of_turn", clamped=_clamped(turn), obstacle=turn.why)


def _lines_of_best(found: Placement, best: PartPlace) -> Iterator[str]:
    """How the part is clamped at the best place, what axes use there, and what holds it."""
    if best.fits:
        yield from _sense(found)
    yield from map(_use, best.axes)
    yield from map(_rotary_use, best.rotary)
    yield from _table(found, best)
    yield from _body_lines(found)
    if found.limits:
        yield _held(found, best)


def _present_line(found: Placement, best: PartPlace, present: PartPlace) -> str:
    """Return the place of the definition or of the arguments, and what the best one has more."""
    state = part("to_the_limits", margin=present.margin_mm) if present.fits else part("too_far", off=-present.margin_mm)
    if present.table_mm is not None and -present.table_mm > KEPT:
        state = part("beyond_table", state=state, beyond=-present.table_mm)
    gained: Wording | str = ""
    if found.goal == "margin":
        gain = _gain_text(best.margin_mm - present.margin_mm)
        gained = part("best_place_has", where=_where(best), gain=gain)
    return line("present_zero", zero=_point(present), where=_where(best, present), state=state, gained=gained)


def _table(found: Placement, best: PartPlace) -> Iterator[str]:
    """Which table the part stands on, and how far from its edge; or that nothing keeps it there."""
    table = found.table
    if table is None:
        return
    x, y = table.centre
    named = (
        part("table_named_on_axis", table=str(table), axis=table.axis, x=x, y=y)
        if table.axis
        else part("table_named", table=str(table), x=x, y=y)
    )
    if best.table_mm is not None:
        yield line("table_left", left=max(best.table_mm, 0.0), named=named)
    elif best.fits and not table.has(best.zero_mm):
        yield line("zero_beyond_table", named=named)


def _held(found: Placement, best: PartPlace) -> str:
    """Return the limits that are told, and what they do."""
    nearest = "nearest_limits" if len(found.limits) > 1 else "nearest_limit"
    variant = "held_conflict" if not best.fits else "held_by" if found.goal == "margin" else nearest
    return line(variant, limits=tuple(dict.fromkeys(map(_limit, found.limits))), overlap=_overlap(found))


def _where(best: PartPlace, place: PartPlace | None = None) -> Wording | str:
    """How the part is clamped at a place, by default the best: where that is not how it is now."""
    if are_one_angle(best.turn_deg, 0.0) and are_one_angle(best.tilt_deg, 0.0):
        return ""
    return part("where_clamped" if place else "where_clamped_between", clamped=_clamped(place or best))


def _clamped(place: PartPlace | TurnMargin) -> Wording:
    turn = number(_once(place.turn_deg))
    if place.tilt_deg:
        return part("clamped_tilted_by", tilt=number(place.tilt_deg), turn=turn)
    return part("clamped_turned_by", turn=turn)


def _once(turn: float) -> float:
    """Return a turn as it is told, from 0 up to 360 degrees."""
    return 0.0 if are_one_angle(turn, 0.0) else turn % 360.0


def _sense(found: Placement) -> Iterator[str]:
    """How the part is clamped: in words that do not ask for a rule of hands."""
    best, stated, whole = found.best, found.clamping, found.clamped
    assert best is not None
    if whole is None:
        return
    if stated is not None and not stated.is_as_drawn:
        yield line("stated_clamping", clamping=stated.said)
    is_tilted = not are_one_angle(whole.tilt, 0.0)
    if is_tilted:
        yield line("fixture_angle_up" if whole.tilt > 0.0 else "fixture_angle_down", angle=number(whole.tilt))
    if not are_one_angle(whole.turn, 0.0):
        yield line("then_turn_the_part" if is_tilted else "turn_the_part", turn=number(_once(whole.turn)))
    if whole.is_as_drawn:
        yield line("part_as_drawn")


def _share(found: Placement) -> str:
    """At how many of the turns that were asked for the part fits, and at how many more around the best."""
    asked = [turn for turn in found.turns if turn.is_asked]
    more = [turn for turn in found.turns if not turn.is_asked]
    fits = sum(turn.fits for turn in asked)
    tried = part("tilted_turns_counted" if _is_tilted(found) else "turns_counted", count=len(asked))
    if not more:
        return line("fits_at_share", fits=fits, tried=tried)
    fitting = sum(turn.fits for turn in more)
    return line("fits_at_share_and_more", fits=fits, tried=tried, more=len(more), fitting=fitting)


def _is_tilted(found: Placement) -> bool:
    """Whether tilts were tried."""
    return len({turn.tilt_deg for turn in found.turns}) > 1


def _without_tilt(found: Placement) -> str | None:
    """Return the best place of those that need no fixture angle; None if none was tried."""
    flat = [turn for turn in found.turns if turn.tilt_deg == 0.0]
    if not flat:
        return None
    best = max(flat, key=lambda turn: -float("inf") if turn.margin_mm is None else turn.margin_mm)
    if best.margin_mm is None:
        small = all(turn.table_is_too_small for turn in flat)
        return line("table_too_small" if small else "path_not_reached")
    margin = best.margin_mm
    left = part("to_the_limits", margin=margin) if margin >= 0.0 else part("fits_nowhere_too_far", off=-margin)
    return in_words(left) + in_words(part("where_clamped", clamped=_clamped(best)))


def _ends(low: Floats, high: Floats) -> str:
    ends = zip("XYZ", low.tolist(), high.tolist(), strict=True)
    return ", ".join(line("axis_ends", axis=name, low=least, high=most) for name, least, most in ends)


def _rotary_use(axis: RotaryUse) -> str:
    use = part("degrees_ends", axis=axis.axis, low=axis.least_deg + 0.0, high=axis.greatest_deg + 0.0)
    if axis.margin_deg == float("inf"):
        return line("use_without_limits", use=use)
    left = part("still_left", left=max(axis.margin_deg, 0.0))
    return line("use_of_limits", use=use, low=axis.low_deg, high=axis.high_deg, left=left)


def _use(axis: AxisUse) -> str:
    use = part("axis_ends", axis=axis.axis, low=axis.least_mm, high=axis.greatest_mm)
    if axis.low.limit_mm == -float("inf") and axis.high.limit_mm == float("inf"):
        return line("use_limits_not_stated", use=use)
    left = part("still_left", left=axis.margin_mm) if axis.margin_mm >= 0.0 else part("too_far_by", off=-axis.margin_mm)
    return line("use_of_limits", use=use, low=axis.low.limit_mm, high=axis.high.limit_mm, left=left)


def _point(place: PartPlace) -> str:
    return ",".join(f"{value:.3f}" for value in place.zero_mm)


def _overlap(found: Placement) -> Wording | str:
    """How much travel is missing, where both limits of one linear axis conflict and nothing else does."""
    ends = {(limit.axis, limit.end) for limit in found.limits}
    if found.fits or found.best is None or len(ends) != 2 or len({axis for axis, _ in ends}) > 1:
        return ""
    return part("needs_more_travel", axis=found.limits[0].axis, more=-2.0 * found.best.margin_mm)


def _goal_number(goal: str, place: PartPlace) -> Wording:
    value = place.value or 0.0
    if goal == "time":
        planned = value if place.planned_s is None else place.planned_s
        return part("time_by_speeds", planned=format_duration(planned), time=format_duration(value))
    if goal == "overspeed":
        return part("rows_counted", count=round(value))
    return part("degrees_of_travel" if goal == "rotary" else "mm_of_travel", value=value)


def _limit(limit: Limit) -> Wording:
    if limit.file:
        return part("limit_at", axis=limit.axis, limit=limit.limit_mm, file=limit.file, line=limit.line)
    edge = limit.end.split()[-1]  # that of a table
    if edge == "rim":
        return part("table_rim", limit=limit.limit_mm)
    return part("table_edge", edge=edge, limit=limit.limit_mm)


def _body_lines(found: Placement) -> Iterator[str]:
    """How far bodies are apart at the best place, at the present one, and wherever the part sits."""
    best, present = found.best, found.present
    if best is not None and best.nearest is not None:
        before = None if present is None else present.nearest
        now = "" if before is None else part("now_at_present", apart=_apart(before))
        yield line("nearest_bodies", apart=_apart(best.nearest), now=now, gained=_gain(best.nearest, before))
    if found.most_distance_mm is not None and not found.touching:
        yield line("no_place_farther", most=found.most_distance_mm)
    if found.nearest_anywhere is not None:
        yield line("wherever_it_sits", apart=_apart(found.nearest_anywhere))


def _touch_line(found: Placement) -> str | None:
    """Return what is said first where bodies touch everywhere; None where they do not."""
    if found.goal != "collisions" or found.touching is None:
        return None
    return line("bodies_touch_everywhere", machine=found.machine, apart=_apart(found.touching))


def _apart(nearest: BodyDistance) -> Wording:
    """Two bodies, and how far they are apart."""
    one, other = map(body_said, nearest.between)
    place = {"one": one, "other": other, "file": nearest.file, "line": nearest.line}
    if nearest.touches:
        return part("bodies_touch", **place)
    return part("bodies_apart", **place, distance=nearest.distance_mm)


def _gain(best: BodyDistance, present: BodyDistance | None) -> Wording | str:
    """How much farther apart bodies are at the best place than at the present one."""
    if present is None:
        return ""
    return part("best_place_has", where="", gain=_gain_text(best.distance_mm - present.distance_mm))


def _gain_text(gain: float) -> Wording:
    """How much more the best place has than the present one, mm."""
    if abs(gain) < _SAME:
        return part("gain_none")
    return part("gain_more" if gain > 0.0 else "gain_less", gain=abs(gain))
