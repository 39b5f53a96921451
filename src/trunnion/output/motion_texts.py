"""Texts before each motion of a kind, and the words of motions, cycles and coolants that functions have changed."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from io import BytesIO
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.controls.template import Answer, Template, Value
from trunnion.controls.words import ABSENT, WordRangeError
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Coolant, CycleOff, CycleOn, Event, Insert, Kind, Phase
from trunnion.output.blocks.block_writer import CHUNK
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.changed_words import ChangedCoolant, ChangedCycle, ChangedWords, Changer
from trunnion.output.printed_planes import with_printed_planes
from trunnion.output.program import Program
from trunnion.output.template_printing import TemplatePrinting
from trunnion.planning.holes.cycles import HoleCycleError, cycle_from_event
from trunnion.records import dataclass

_KINDS: Final = {Kind.RAPID: "rapid", Kind.LINEAR: "linear", Kind.ARC: "arc"}


@dataclass(frozen=True, slots=True, eq=False)
class _Row:
    """A row of a motion as it is written, the counts of its words, and the values of templates there."""

    motion: Motion
    row: int
    counts: Mapping[str, int]
    values: Mapping[str, Value]


class MotionTexts:
    """What templates and functions say before the motions of a program."""

    def __init__(self, program: Program, printing: TemplatePrinting) -> None:
        self._program, self._printing = program, printing
        templates = program.control.templates
        self._templates = {kind: templates[name] for kind, name in _KINDS.items() if name in templates}

    def joined(self, events: Sequence[Event], index: int, values: Mapping[str, Value]) -> list[Event]:
        """Return the events of a motion with what stands before each of its moves, behind what is switched there.

        index   of the motion in the program
        values  that templates may print there
        """
        found: list[Event] = []
        waiting = list(events)[::-1]
        for new in self._events(index, values) if self._templates else ():
            while waiting and waiting[-1].row <= new.row:
                found.append(waiting.pop())
            found.append(new)
        return found + waiting[::-1]

    @cached_property
    def _blocks(self) -> MotionBlockWriter:
        """What knows the words of blocks."""
        return MotionBlockWriter(with_printed_planes(self._program), BytesIO(), lambda _: None)

    def _events(self, index: int, values: Mapping[str, Value]) -> Iterator[Event]:
        blocks, holes = self._blocks, cycle_rows(self._program.motions[index])
        motion = blocks.use_axis_coordinates(blocks.program.motions[index])
        blocks.begin_motion(motion, str(values["tool"]), from_plane=False, retracted=True)
        motion = replace(motion, operation=motion.as_written())
        moves, splines = motion.operation.moves, motion.operation.splines
        for k in range(len(splines.first)):
            holes[splines[k].first : splines[k].last + 1] = True
        for start in range(0, len(moves), CHUNK):
            rows = slice(start, min(start + CHUNK, len(moves)))
            rapid = np.asarray(moves.kind[rows] == Kind.RAPID)
            table = blocks.words_of_rows(motion, rows, rapid)[0]
            for row in range(rows.start, rows.stop):
                template = self._templates.get(Kind(int(moves.kind[row])))
                if template is not None and not holes[row]:
                    counts = table.words_of_row(row - start)
                    here = {key: count for key, count in counts.items() if count != ABSENT}
                    yield from self._at(_Row(motion, row, here, values), template)

    def _at(self, here: _Row, template: Template) -> Iterator[Event]:
        """Yield the text before a row, and the words that are others in its block."""
        blocks, motion, row, counts = self._blocks, here.motion, here.row, here.counts
        moves = motion.operation.moves
        words = {key: float(_value(blocks, key, count)) for key, count in counts.items()}
        tip, line = tuple(moves.tip[row].tolist()), int(moves.line[row])
        phase, feed = Phase(int(moves.phase[row])), float(moves.feed[row])
        own: dict[str, object] = {
            "row": row, "tip": tip, "axis": tuple(moves.axis[row].tolist()),
            "kind": Kind(int(moves.kind[row])), "phase": phase, "feed": feed, "per_rev": bool(moves.per_rev[row]),
            "words": words, "line": line,
        }  # fmt: skip
        x, y, z = tip
        shown: dict[str, Value] = {"phase": phase.name, "feed": feed, "x": x, "y": y, "z": z}
        values = {**here.values, **{key: None if value != value else value for key, value in shown.items()}}
        try:
            answer = template.answer(values, self._printing.of(motion, values, own=own))
        except WordRangeError as error:
            raise error.at(self._program.file_of(motion.operation), line) from None
        if answer.lines:
            yield Insert(row, line, "\n".join(answer.lines), template.name)
        if changed := _counts(blocks, template, answer.words):
            others = {key: count for key, count in changed.items() if counts.get(key, ABSENT) != count}
            if others:
                yield ChangedWords(row, line, tuple(others.items()), _changer(template))


def _value(blocks: MotionBlockWriter, key: str, count: int) -> float:
    return float(blocks.writer.word(key).format.values(np.array([count]))[0])


def _counts(blocks: MotionBlockWriter, template: Template, words: Mapping[str, float | None]) -> dict[str, int]:
    """Return words that a function has changed, as counts; errors at the function."""
    known = {word.key: word for word in blocks.writer.words}
    found = {}
    for key, value in words.items():
        if key not in known:
            raise _refused(template, "unknown_word", word=key, known=tuple(known))
        number = known[key].format
        if value is not None and not number.least <= value <= number.greatest:
            raise _refused(template, "word_beyond", word=key, value=value, least=number.least, greatest=number.greatest)
        found[key] = ABSENT if value is None else number.count(value)
    return found


def _changer(template: Template) -> Changer:
    return Changer(template.title, *template.place_of(0))


def _refused(template: Template, variant: str, /, **parameters: object) -> InputError:
    wording = Wording("HOK170", variant, **parameters).within("returned", name=template.title)
    return InputError(Problem(*template.place_of(0), wording))


def cycle_rows(motion: Motion) -> Flags:
    """Return the rows that are holes of a cycle, (n,) bool."""
    holes = np.zeros(len(motion.operation.moves), np.bool_)
    for event in motion.operation.events:
        if isinstance(event, CycleOn | CycleOff):
            holes[event.row :] = isinstance(event, CycleOn)
    return holes


# Cycles and coolants

#: Words with numbers of CYCLE: a function may leave out one that the statement does not have.
_CYCLE_WORDS: Final = frozenset(
    {"RAPTO", "CLEAR", "FEDTO", "RTRCTO", "STEP", "DWELL", "MMPM", "MMPR", "CSKDIA", "TLANGL", "NODRAG"}
)


def cycle_words(event: CycleOn) -> dict[str, float]:
    """Return the numbers of a cycle by the words before them: the first of each."""
    return {word: numbers[0] for word, numbers in event.values if numbers}


def changed_cycle(event: CycleOn, answer: Answer) -> CycleOn:
    """Return a cycle with the words that a function has changed.

    Raises ``InputError`` at the function if it is none then.
    """
    source = answer.source
    if not answer.words or source is None:
        return event
    known = cycle_words(event)
    left_out = {word for word, value in answer.words.items() if value is None} & _CYCLE_WORDS
    if unknown := next((word for word in answer.words if word not in known.keys() | left_out), ""):
        raise _refused(source, "unknown_word", word=unknown, known=tuple(known))
    values = []
    for word, numbers in event.values:
        value = answer.words.get(word, numbers[0] if numbers else None)
        if word in answer.words and value is None:
            continue
        values.append((word, numbers if value is None else (value, *numbers[1:])))
    changed = ChangedCycle(event.row, event.line, event.mode, tuple(values), event.words, by=_changer(source))
    try:
        cycle_from_event(changed)
    except HoleCycleError as error:
        raise _refused(source, "no_cycle", fault=error.wording) from None
    return changed


def coolant_words(program: Program, event: Coolant) -> dict[str, float]:
    """Return the words that switch a coolant, as the family has them."""
    control = program.control
    return dict(control.family.event_words(event, control.codes, control.coolant))


def changed_coolant(program: Program, motion: Motion, event: Coolant, answer: Answer) -> Coolant:
    """Return a coolant with the words that a function has changed; errors at the function."""
    source = answer.source
    if not answer.words or source is None:
        return event
    blocks = MotionBlockWriter(program, BytesIO(), lambda _: None)
    blocks.writer.use_words(program.block_words(motion))
    known = coolant_words(program, event)
    if unknown := next((word for word in answer.words if word not in known), ""):
        raise _refused(source, "unknown_word", word=unknown, known=tuple(known))
    words = tuple(_counts(blocks, source, answer.words).items())
    return ChangedCoolant(event.row, event.line, event.kind, words, _changer(source))
