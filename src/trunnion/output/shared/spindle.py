"""What depends on the spindle: dwells in revolutions, and threads."""

import math

from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.controls.words import NumberFormat
from trunnion.messages import Wording
from trunnion.model.toolpath import Dwell
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, SpindleState


def dwell_seconds(event: Dwell, rpm: float | None) -> float:
    """Return the time of a dwell, seconds; spindle revolutions become the time that they take.

    Raises ``UnsupportedFeatureError`` if revolutions are asked for while the spindle is stopped.
    """
    if not event.revolutions:
        return event.amount
    if rpm is None or not rpm > 0.0:
        raise UnsupportedFeatureError(Wording("CTL420", "dwell_spindle_revolutions_while"))
    return 60.0 * event.amount / rpm


def dwell_text(amount: float, number_format: NumberFormat, factor: float = 1.0, unit: str = "s") -> str:
    """Return a dwell as it is printed: an amount of ``unit``, of which each is printed as ``factor``; one that is
    shorter than the control can wait is as long as it can.

    Raises ``UnsupportedFeatureError`` if it is longer than the control can wait, or no time at all.
    """
    least, greatest = number_format.least / factor, number_format.greatest / factor
    if not 0.0 < amount <= greatest:
        raise UnsupportedFeatureError(
            Wording("CTL420", "dwell_control_waits", amount=amount, unit=unit, least=least, greatest=greatest)
        )
    return number_format.text(factor * max(amount, least))


def cycle_dwell_seconds(cycle: Cycle, spindle: SpindleState | None) -> float:
    """Return the dwell at the bottom of a hole, seconds; spindle revolutions become the time that they take.

    Raises ``HoleCycleError`` if revolutions are asked for while the spindle is stopped.
    """
    if not cycle.dwell or not cycle.dwell_in_revolutions:
        return cycle.dwell
    return 60.0 * cycle.dwell / running_spindle(spindle, "DWELL,REV").rpm


def running_spindle(spindle: SpindleState | None, what: str) -> SpindleState:
    """Return the spindle if it turns.

    Raises ``HoleCycleError`` if it does not: ``what`` needs it.
    """
    if spindle is None or not (spindle.rpm > 0.0 and math.isfinite(spindle.rpm)):
        raise HoleCycleError(Wording("PLN660", "while_spindle_stands", subject=what))
    return spindle


def thread(cycle: Cycle, spindle: SpindleState | None) -> tuple[float, SpindleState]:
    """Return the pitch of a thread, mm, and the spindle that cuts it, whose sense is the hand of the thread.

    Raises ``HoleCycleError`` if the spindle is stopped, or if the cycle has no feed.
    """
    running = running_spindle(spindle, "CYCLE/TAP")
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError(Wording("PLN610", "cycle_tap_without"))
    return cycle.feed if cycle.per_rev else cycle.feed / running.rpm, running
