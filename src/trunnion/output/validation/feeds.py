"""Feeds that are missing, or that a number format distorts."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.controls.words import NumberFormat
from trunnion.errors import Problem, Severity, warning
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Kind, Moves
from trunnion.output.program import Program

#: A feed that is printed with a greater error, as a share of it, is told; one with an error above the second, refused.
TOLD_ERROR: Final = 0.001
REFUSED_ERROR: Final = 0.01

#: The same of a feed in mm/min that the control cannot print nearer: no other unit cures it, and half a step of the
#: dial by which the operator overrides feeds breaks no tool.
_REFUSED_PER_MINUTE: Final = 0.05


def missing_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return the first cut without a feed."""
    moves = motion.operation.moves
    rows = np.flatnonzero((moves.kind != Kind.RAPID) & ~(moves.feed > 0))
    if not len(rows):
        return []
    return [
        Problem(
            program.file_of(motion.operation),
            int(moves.line[rows[0]]),
            Wording(
                "CTL310", "cutting_motion_without" if motion.cl_rows is not None else "cutting_motion_without_feed"
            ),
        )
    ]


def rapid_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return a warning for the first cut at the feed at which lines are rapids: it gets the next lower one."""
    rapid_feed, moves = program.effective_setting("rapid_feed"), motion.operation.moves
    if not rapid_feed:
        return []
    at_feed = (moves.kind != Kind.RAPID) & ~moves.per_rev
    number_format = feed_format(program.control.number_formats(motion.three_axis), per_rev=False)
    rows = np.flatnonzero(at_feed & (np.abs(moves.feed - float(rapid_feed)) < 0.5 * number_format.digit))
    if not len(rows):
        return []
    lower = float(rapid_feed) - number_format.digit
    file, line = program.file_of(motion.operation), int(moves.line[rows[0]])
    return [warning(file, line, Wording("CTL315", "lines_mm_min", rapid_feed=float(rapid_feed), lower=lower))]


def rounded_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return the first feed of an operation that rounding makes another one, or else the first that it changes much.

    A feed that was lowered for the rotary axes is told at most: the CL file cannot write another.
    """
    moves, formats = motion.operation.moves, program.control.number_formats(motion.three_axis)
    if motion.mode is MachiningMode.WITHOUT_TCP or not len(moves):
        return []
    rows = np.flatnonzero((moves.kind != Kind.RAPID) & (moves.feed > 0.0))
    lowered = set(motion.deviations.slowed_feed.tolist())
    found = []
    for k in _first_of_each_feed(moves, rows):
        line, feed, per_rev = int(moves.line[k]), float(moves.feed[k]), bool(moves.per_rev[k])
        problem = rounding_problem(program.file_of(motion.operation), line, formats, feed, per_rev)
        if problem is not None and feed in lowered and feed >= feed_format(formats, per_rev).least:
            problem = replace(problem, severity=Severity.WARNING)
        found += [problem] if problem is not None else []
    return sorted(found, key=lambda problem: problem.severity is not Severity.ERROR)[:1]


def _first_of_each_feed(moves: Moves, rows: Ints) -> list[int]:
    """Return the first of ``rows`` (k,) with each feed, ascending."""
    feed, per_rev = moves.feed[rows], moves.per_rev[rows]
    begins = np.append(True, (feed[1:] != feed[:-1]) | (per_rev[1:] != per_rev[:-1]))[: len(rows)]
    first = []
    for mode in (False, True):
        here = np.flatnonzero(begins & (per_rev == mode))  # few, where a million points have a handful of feeds
        first += rows[here[np.unique(feed[here], return_index=True)[1]]].tolist()
    return sorted(first)


def feed_format(formats: Mapping[str, NumberFormat], per_rev: bool) -> NumberFormat:
    """Return the number format of a feed; a control without feeds per revolution has one only."""
    return formats.get("feed_per_rev", formats["feed"]) if per_rev else formats["feed"]


def rounding_problem(
    file: str, line: int, formats: Mapping[str, NumberFormat], feed: float, per_rev: bool
) -> Problem | None:
    """Return what the digits of a control make of a feed: zero, or another feed; None if they print it well."""
    number_format = feed_format(formats, per_rev)
    if per_rev and number_format.unit == 1.0 and formats["feed"].unit != 1.0:
        return Problem(file, line, Wording("CTL330", "feed_per_revolution_program"))
    printed = number_format.rounded(feed)
    if printed < number_format.least:
        return Problem(
            file,
            line,
            Wording("CTL320", "feed_below_least" if per_rev else "feed_below_least_control", feed=feed),
        )
    error = abs(printed - feed) / feed
    if error <= TOLD_ERROR:
        return None
    refused = error > (REFUSED_ERROR if per_rev else _REFUSED_PER_MINUTE)
    return Problem(
        file,
        line,
        Wording(
            "CTL320", "feed_prints_off" if per_rev else "feed_prints", feed=feed, printed=printed, error=100.0 * error
        ),
        severity=Severity.ERROR if refused else Severity.WARNING,
    )
