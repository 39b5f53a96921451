"""Events of two programs that the machine waits at or acts upon, at their places in the path.

In:     the rows of a run in which its tool moves.
Out:    which events come before each of these motions, and after the last one: stops and dwells, the end of the
        program, and what cycles do with the spindle, which the path does not show (a left-hand thread goes where a
        right-hand one does).
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Ints, distinct
from trunnion.messages import Wording
from trunnion.model.run import EventValue, Run, RunEvent
from trunnion.model.spindle_work import SpindleHole, SpindleTask
from trunnion.verification.checks.compensation_faults import blind_corners
from trunnion.verification.comparison.conditions import conditions
from trunnion.verification.event_words import event_word
from trunnion.verification.spindle_words import TURNING

#: What every control has.
_OF_ALL: Final = ("stop", "optional_stop", "dwell")

_TASKS: Final = {
    SpindleTask.STOP: "bore_standing", SpindleTask.LIFT: "bore_lifted", SpindleTask.MANUAL: "bore_by_hand",
}  # fmt: skip
_THREADS: Final = {1: "right_hand_thread", -1: "left_hand_thread", 0: "thread"}

_THEN: Final = {1: "then_clockwise", -1: "then_counter_clockwise", 0: "then_stands"}

#: Words that mean the same on the same machine only: those of its builder, and what ends a program of its control.
_OF_MACHINE: Final = ("m", "h", "known", "end", "retract")

#: Stops that have a word besides.
_WITH_WORD: Final = {"stop": "stop_for", "optional_stop": "optional_stop_for"}

#: Of diagnostics of what the next program begins with.
_LEFT_ON: Final = "NC351"

#: Dwells are the same within this, seconds or revolutions: programs print no more digits.
_DIGITS: Final = 3


class PathEvents:
    """The events of one program by the motion before which they come; that after the last one is ``len(rows)``.

    rows          (n,) the rows in which the tool moves
    most          blocks without motion across which the control finds the next corner within radius compensation
    same_machine  the other program is for the same machine
    """

    def __init__(self, run: Run, rows: Ints, most: int, *, same_machine: bool) -> None:
        kinds = (*_OF_ALL, *(_OF_MACHINE if same_machine else ()))
        found = [(event.before_row, said) for event, said in _events(run, kinds)]
        found += list(conditions(run)) if same_machine else []
        found += [
            (row, Wording("comparison", "blocks_compensated", blocks=blocks, most=most))
            for row, blocks in blind_corners(run, most)
        ]
        found += [(hole.first, _spindle_work(run, hole, chuck=same_machine)) for hole in run.spindle_holes]
        left_on = _left_on(run) if same_machine else ()
        found += [(len(run), Wording("comparison", "left_on", what=what)) for what in left_on]
        last = int(rows[-1]) if len(rows) else -1
        found += [(len(run), said) for said in _switched_behind(run, last, same_machine)]
        at = np.searchsorted(rows, [row for row, _ in found])
        self._events: dict[int, list[Wording]] = {}
        for motion, (_, said) in zip(at.tolist(), found, strict=True):
            self._events.setdefault(motion, []).append(said)
        self.motions: Ints = distinct(at).astype(np.int64)

    def take(self, first: int, end: int) -> dict[str, list[Wording]]:
        """Return what comes before the motions from ``first`` to ``end`` (exclusive) and has not been taken yet, by
        what is said of it: that is the same for what is the same.

        Sorted, as the order of what comes at one place makes no difference.
        """
        found: dict[str, list[Wording]] = {}
        for motion in self.motions_in(first, end):
            for said in self._events.pop(motion, ()):
                found.setdefault(said.what, []).append(said)
        return dict(sorted(found.items()))

    def motions_in(self, first: int, end: int) -> list[int]:
        """Return the motions from ``first`` to ``end`` (exclusive) that something comes before."""
        low, high = np.searchsorted(self.motions, (first, end)).tolist()
        return [int(motion) for motion in self.motions[low:high]]


def _events(run: Run, kinds: Sequence[str]) -> Iterator[tuple[RunEvent, Wording]]:
    """Yield the events of some kinds, and what is said of them: of a stop, whether the spindle turns there."""
    turns: EventValue = None
    for event in run.events:
        if event.kind == "spindle":
            turns = event.value if event.value in TURNING else None
        elif event.kind in kinds:
            said = _said(event)
            if turns and event.kind == "stop":
                said = Wording("comparison", "stop_while_turning", stop=said, sense=event_word(turns))
            yield event, said


def _switched_behind(run: Run, last: int, same_machine: bool) -> list[Wording]:
    """Return what becomes of spindle, coolant and tool behind the ``last`` row in which the tool moves: no such row
    shows it. On another machine what the end of a program switches off, or puts away, may have no word.
    """
    found = {event.kind: event.value for event in run.events if event.before_row > last}
    if not same_machine:
        found.pop("tool_change", None)
        if any(event.kind == "end" for event in run.events):
            found = {kind: value for kind, value in found.items() if value != "off"}
    kinds = [kind for kind in ("spindle", "coolant", "tool_change") if kind in found]
    return [Wording("comparison", kind, word=event_word(found[kind])) for kind in kinds]


def _left_on(run: Run) -> list[Wording]:
    """Return what the program leaves on at its end, or sets behind its last motion, each once."""
    found = [each.wording for each in run.diagnostics if each.code == _LEFT_ON]
    modes = {each.mode: each.word for each in run.mode_words if each.before_row == len(run)}
    found += [Wording("comparison", "mode_left_on", mode=mode, word=word) for mode, word in modes.items() if word]
    found += [Wording("comparison", "known", word=event.value) for event in run.events if event.kind == "variable"]
    frames = [event.value for event in run.events if event.kind == "frame"]
    found += [Wording("comparison", "frame_left_on", word=frames[-1])] if frames and frames[-1] else []
    found += [Wording("comparison", "tcp_left_on") for event in run.events if event.kind == "end" and event.tcp]
    return list({said.what: said for said in found}.values())


def _spindle_work(run: Run, hole: SpindleHole, *, chuck: bool) -> Wording:
    """Return what a cycle does with the spindle, which is said in the same way where it is the same.

    chuck  a compensating chuck counts: another machine may do without
    """
    work, row = hole.work, hole.first
    sense = int(run.spindle[row])
    after = work.after if work.after is not None else sense
    if work.task is not SpindleTask.TAP:
        return Wording("comparison", _THEN[after], work=Wording("comparison", _TASKS[work.task]))
    said = Wording("comparison", _THREADS[work.hand or sense])
    if chuck and work.floating:
        said = Wording("comparison", "in_chuck", work=said)
    if work.stroke:
        said = Wording("comparison", "in_strokes", work=said, stroke=f"{work.stroke:g}")
    return Wording("comparison", _THEN[after], work=said)


def _said(event: RunEvent) -> Wording:
    value, kind = event.value, event.kind
    if kind == "dwell" and isinstance(value, int | float):
        amount = round(float(value), _DIGITS)
        return Wording("comparison", "dwell_of_turns" if amount < 0 else "dwell_of_seconds", amount=f"{abs(amount):g}")
    if not value and not isinstance(value, int | float):
        return Wording("comparison", kind, word="")
    word = f"{value:g}" if isinstance(value, int | float) else str(value)
    return Wording("comparison", _WITH_WORD.get(kind, kind), word=word)
