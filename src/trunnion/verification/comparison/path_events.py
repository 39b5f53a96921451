"""Events of two programs that the machine waits at or acts upon, at their places in the path.

In:     the rows of a run in which its tool moves.
Out:    which events come before each of these motions, and after the last one: stops and dwells, the end of the
        program, and what cycles do with the spindle, which the path does not show (a left-hand thread goes where a
        right-hand one does).
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import Run, RunEvent
from trunnion.model.spindle_work import SpindleHole, SpindleTask
from trunnion.verification.checks.compensation_faults import blind_corners
from trunnion.verification.comparison.conditions import conditions

#: What every control has, and messages call it.
_OF_ALL: Final = {"stop": "stop", "optional_stop": "optional stop", "dwell": "dwell"}

_TASKS: Final = {
    SpindleTask.STOP: "a bore that is left with the spindle standing",
    SpindleTask.LIFT: "a bore that is left with the tool lifted off",
    SpindleTask.MANUAL: "a bore that is left by hand",
}

_SENSES: Final = {1: "turns clockwise", -1: "turns counter-clockwise", 0: "stands"}

#: Words that mean the same on the same machine only: those of its builder, and what ends a program of its control.
_OF_MACHINE: Final = {"m": "M", "h": "H", "known": "", "end": "end of the program", "retract": "retract by"}

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
        names = {**_OF_ALL, **(_OF_MACHINE if same_machine else {})}
        found = [(event.before_row, text) for event, text in _texts(run, names)]
        found += list(conditions(run)) if same_machine else []
        found += [
            (row, f"{blocks} blocks without motion within radius compensation, where the control reads {most}")
            for row, blocks in blind_corners(run, most)
        ]
        found += [(hole.first, _spindle_words(run, hole, chuck=same_machine)) for hole in run.spindle_holes]
        found += [(len(run), f"left to the next program: {text}") for text in _left_on(run)] if same_machine else []
        found += [(len(run), text) for text in _switched_behind(run, same_machine)]
        at = np.searchsorted(rows, [row for row, _ in found])
        self._events: dict[int, list[str]] = {}
        for motion, (_, text) in zip(at.tolist(), found, strict=True):
            self._events.setdefault(motion, []).append(text)
        self.motions: Ints = np.unique(at).astype(np.int64)

    def take(self, first: int, end: int) -> list[str]:
        """Return what comes before the motions from ``first`` to ``end`` (exclusive) and has not been taken yet, in
        words.

        Sorted, as the order of what comes at one place makes no difference.
        """
        return sorted(words for motion in self.motions_in(first, end) for words in self._events.pop(motion, ()))

    def motions_in(self, first: int, end: int) -> list[int]:
        """Return the motions from ``first`` to ``end`` (exclusive) that something comes before."""
        low, high = np.searchsorted(self.motions, (first, end)).tolist()
        return [int(motion) for motion in self.motions[low:high]]


def _texts(run: Run, names: Mapping[str, str]) -> Iterator[tuple[RunEvent, str]]:
    """Yield the events that are compared, in words; a stop says whether the spindle turns there."""
    turns = ""
    for event in run.events:
        if event.kind == "spindle":
            turns = str(event.value) if event.value in ("clockwise", "counter-clockwise") else ""
        elif event.kind in names:
            text = _words(names[event.kind], event)
            yield event, f"{text} while the spindle turns {turns}" if turns and event.kind == "stop" else text


def _switched_behind(run: Run, same_machine: bool) -> list[str]:
    """Return what becomes of spindle and coolant behind the last motion: no row shows it. On another machine what the
    end of a program switches off may have no word.
    """
    found = {event.kind: event.value for event in run.events if event.before_row == len(run)}
    if not same_machine and any(event.kind == "end" for event in run.events):
        found = {kind: value for kind, value in found.items() if value != "off"}
    return [f"{kind} {found[kind]} behind the last motion" for kind in ("spindle", "coolant") if kind in found]


def _left_on(run: Run) -> list[str]:
    """Return what the program leaves on at its end, or sets behind its last motion, each once."""
    found = [each.wording.what for each in run.diagnostics if each.code == _LEFT_ON]
    modes = {each.mode: each.word for each in run.mode_words if each.before_row == len(run)}
    found += [f"{mode} {word}" for mode, word in modes.items() if word]
    frames = [event.value for event in run.events if event.kind == "frame"]
    found += [f"a frame, by {frames[-1]}"] if frames and frames[-1] else []
    found += ["TCP on" for event in run.events if event.kind == "end" and event.tcp]
    return list(dict.fromkeys(found))


def _spindle_words(run: Run, hole: SpindleHole, *, chuck: bool) -> str:
    """Return what a cycle does with the spindle, in words that are the same for what is the same.

    chuck  a compensating chuck counts: another machine may do without
    """
    work, row = hole.work, hole.first
    sense = int(run.spindle[row])
    after = work.after if work.after is not None else sense
    then = f", after which the spindle {_SENSES[after]}"
    if work.task is not SpindleTask.TAP:
        return _TASKS[work.task] + then
    hand = {1: "right-hand", -1: "left-hand"}.get(work.hand or sense, "")
    stroke = f" in strokes of {work.stroke:g} mm" if work.stroke else ""
    held = " in a compensating chuck" if chuck and work.floating else ""
    return f"{hand} thread".strip() + held + stroke + then


def _words(name: str, event: RunEvent) -> str:
    if event.kind == "end":
        return name
    value = event.value
    if event.kind == "dwell" and isinstance(value, int | float):
        amount = round(float(value), _DIGITS)
        return f"{name} of {-amount:g} revolutions" if amount < 0 else f"{name} of {amount:g} s"
    if isinstance(value, int | float):
        return f"{name}{value:g}"
    return name if value is None or not isinstance(value, str) else f"{name} {value}".strip()
