"""Under which keys of ``[control.reading]`` a program reads best: a proposal, which changes nothing by itself.

In:     a program, and the machine that is to run it.
Out:    the keys that the text can tell apart and with which it has fewer errors, keeps within the travel, or has feeds
        that a machine cuts with, with why.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np

from trunnion import readers
from trunnion.errors import InputError
from trunnion.machines import Machine
from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers.program.forms import keys_of
from trunnion.readers.program.settings import family_of, reading_of
from trunnion.records import dataclass

#: A word of a key, or a list of one.
Value: TypeAlias = str | list[str]

#: Texts that can tell a key from its default: key, value, what the program has, and what it must not have.
_TELLS: Final[tuple[tuple[str, Value, str, str], ...]] = (
    ("block_ends", ["*"], r"\*[ \t]*$", ""),
    ("block_ends", [";"], r";[ \t]*$", ""),
    ("block_ends", ["$"], r"\$[ \t]*$", ""),
    ("block_ends", ["LF"], r"LF[ \t]*$", ""),
    ("block_ends", ["EOB"], r"EOB[ \t]*$", ""),
    ("more_comments", [";"], r";", ""),
    ("more_comments", ["'"], r"'", ""),
    ("more_comments", ["!"], r"!", ""),
    ("more_comments", ["//"], r"//", ""),
    ("more_comments", ["{"], r"\{", ""),
    ("nested_comments", "counted", r"\([^()\n]*\(", ""),
    ("program_numbers", ["O"], r"^[ \t]*O[ \t]*[0-9]+[ \t]*(?:\(.*)?$", ""),
    ("program_numbers", [":"], r"^[ \t]*:[ \t]*[0-9]+", ""),
    ("program_numbers", ["%"], r"^[ \t]*%[ \t]*[0-9]+", ""),
    ("tape_marks", "ignored", r"^[ \t]*%[ \t]*$", ""),
    ("numbers_anywhere", "anywhere", r"[0-9.][ \t]*N[0-9]+", ""),
    ("arc_centres", "absolute", r"[IJK][ \t]*[-+]?[.0-9]", r"G9[01]\.1"),
    ("arc_centres", "incremental", r"[IJK][ \t]*[-+]?[.0-9]", r"G9[01]\.1"),
    ("arc_vectors", "from_centre", r"[IJK][ \t]*[-+]?[.0-9]", ""),
    ("arc_vectors", "unsigned", r"[IJK][ \t]*\+?[.0-9]", r"[IJK][ \t]*-"),
    ("start_distances", "incremental", r"[XYZ][ \t]*[-+]?[.0-9]", r"G9[01](?![.0-9])"),
    ("start_plane", "G18", r"G0?[23](?![0-9])", r"G1[789]"),
    ("start_plane", "G19", r"G0?[23](?![0-9])", r"G1[789]"),
    ("behind_circles", "line", r"G0?[23](?![0-9])", ""),
    ("end_in_subprogram", "returns", r"M98", ""),
    ("whole_numbers", "calculator", r"[XYZIJKRF][ \t]*[-+]?[0-9]+(?![.0-9])", ""),
    ("whole_feeds", "increments", r"F[ \t]*[0-9]{4,}(?![.0-9])", ""),
    ("units", "mm", r"F[ \t]*[.0-9]", r"G(?:2[01]|7[01]0?)(?![.0-9])"),
    ("units", "inch", r"F[ \t]*[.0-9]", r"G(?:2[01]|7[01]0?)(?![.0-9])"),
)

#: Feeds with which machines cut, by their mode: mm/min and mm/rev. A machine's rapids say more where they are stated.
_PLAUSIBLE: Final = {94: (1.0, 60_000.0), 95: (0.001, 10.0)}

#: Errors, axes beyond their travel, and feeds with which no machine cuts: the fewer of the first that differ is better.
Score: TypeAlias = tuple[int, int, int]

#: Keys of which either may help only with the other: a centre is right where its place and its numbers are.
_TOGETHER: Final = frozenset({("arc_centres", "whole_numbers"), ("arc_vectors", "whole_numbers")})

#: Keys that feeds alone speak for: in another unit or with other numbers, all ways are shorter or longer.
_OF_FEEDS: Final = frozenset({"units", "whole_feeds"})

#: Longer programs are judged by their beginning.
_MOST_BYTES: Final = 200_000


@dataclass(frozen=True, slots=True)
class Proposal:
    """Keys under which a program reads best; none: it reads best as it is.

    keys    TOML values by their keys
    before  errors, axes beyond their travel, and implausible feeds, without the keys
    after   with them
    why     what each key changes
    role    what the program is, if it looks like a subprogram
    kind    what it is, if it looks like nothing for the control
    """

    keys: dict[str, Value]
    before: Score
    after: Score
    why: tuple[Wording, ...]
    role: Wording | None = None
    kind: Wording | None = None

    def lines(self, words: Words = LIBRARY) -> Iterator[str]:
        """Yield the proposal as TOML to copy, with why as comments."""
        for said in (self.kind, self.role):
            if said is not None:
                yield said.with_cure().text("what", words)
        if not self.keys:
            yield phrase("reads_best_so", errors=self.before[0]).text("what", words)
            return
        yield phrase("reads_better", errors=self.before[0], left=self.after[0]).text("what", words)
        yield "[control.reading]"
        for (key, value), why in zip(self.keys.items(), self.why, strict=True):
            written = f'"{value}"' if isinstance(value, str) else "[" + ", ".join(f'"{each}"' for each in value) + "]"
            yield f"{key} = {written}  # {why.text('what', words)}"


def proposed_reading(program: Path, machine: Machine) -> Proposal:
    """Return the keys under which a program reads best. Nothing is tried that its text cannot tell apart.

    Raises ``InputError`` if the file cannot be read.
    """
    text = program.read_bytes()[:_MOST_BYTES].decode("latin-1")
    keys: dict[str, Value] = {}
    why: dict[str, Wording] = {}
    first = best = _score(program, machine)
    single = list(_candidates(text, machine))
    pairs = [[each, other] for each in single for other in single if (each[0], other[0]) in _TOGETHER]
    for added in [*([each] for each in single), *pairs]:
        if not any(best):
            break
        tried = {**keys, **{key: _joined(keys.get(key), value) for key, value in added}}
        score = _score(program, readers.with_reading(machine, tried))
        if score < best and (_OF_FEEDS.isdisjoint(key for key, _ in added) or score[2] < best[2]):
            said = _why(best, score)
            why |= {key: said for key, _ in added}
            keys, best = tried, score
    kind = _kind(program, readers.with_reading(machine, keys)) if best[0] else None
    return Proposal(keys, first, best, tuple(why[key] for key in keys), readers.role_of(program, machine), kind)


def _why(before: Score, after: Score) -> Wording:
    """Return what a key makes better: a phrase."""
    if after[0] < before[0]:
        return phrase("fewer_errors", before=before[0], after=after[0])
    if after[2] < before[2]:
        return phrase("feeds_plausible", before=before[2], after=after[2])
    return phrase("within_travel", axes=before[1] - after[1])


def _kind(program: Path, machine: Machine) -> Wording | None:
    """Return what a program with errors looks like, if that is nothing for the control.

    Raises ``InputError`` if the file cannot be read.
    """
    errors = readers.with_kind(readers.run_program(program, machine), program).errors
    return next((each.wording for each in errors if each.code == "NC113"), None)


def _candidates(text: str, machine: Machine) -> Iterator[tuple[str, Value]]:
    """Yield keys of the machine's family that it does not state, with values that the text can tell apart."""
    known = {key.name: key.words for key in keys_of(family_of(machine))}
    if "fanuc" in family_of(machine):
        known |= {"whole_numbers": ("calculator",), "whole_feeds": ("increments",)}
    if "heidenhain" not in family_of(machine):
        known["units"] = ("mm", "inch")
    stated = reading_of(machine).keys()
    for key, value, has, has_not in _TELLS:
        if key not in known or key in stated:
            continue
        flags = re.IGNORECASE | re.MULTILINE
        if re.search(has, text, flags) and not (has_not and re.search(has_not, text, flags)):
            yield key, value


def _joined(before: Value | None, value: Value) -> Value:
    return [*before, *value] if isinstance(before, list) and isinstance(value, list) else value


def _score(program: Path, machine: Machine) -> Score:
    """Return what speaks against a reading of a program."""
    try:
        run = readers.run_program(program, machine)
    except InputError as error:
        return len(error.problems) + _MOST_BYTES, 0, 0
    at_part = ~run.machine_frame
    spans = np.ptp(run.joints[at_part], axis=0) if at_part.any() else np.zeros(len(machine.axes))
    beyond = [
        not axis.is_rotary and axis.has_limits and bool(span > axis.high - axis.low)
        for axis, span in zip(machine.axes, spans.tolist(), strict=True)
    ]
    return len(run.errors), sum(beyond), _implausible_feeds(run)


def _implausible_feeds(run: Run) -> int:
    """Return how many different feeds of cuts no machine of the kind has."""
    rapids = [axis.rapid for axis in run.machine.axes if axis.rapid and not axis.is_rotary]
    cuts = run.kind != Kind.RAPID
    count = 0
    for mode, (least, most) in _PLAUSIBLE.items():
        feeds = np.unique(run.feed[cuts & (run.feed_mode == mode)])
        most = max(rapids) if mode == 94 and rapids else most
        count += int(((feeds < least) | (feeds > most)).sum())
    return count
