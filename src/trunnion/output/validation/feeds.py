"""Feeds that are missing, or that a number format distorts."""

from typing import Final

import numpy as np

from trunnion.controls.words import NumberFormat
from trunnion.errors import Problem, Severity
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Kind
from trunnion.output.program import Program

#: A rounding error above this share of a feed is worth a warning.
_ROUNDING_LIMIT: Final = 0.01


def missing_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return the first cut without a feed."""
    moves = motion.operation.moves
    rows = np.flatnonzero((moves.kind != Kind.RAPID) & ~(moves.feed > 0))
    if not len(rows):
        return []
    return [Problem(program.file, int(moves.line[rows[0]]), "cutting motion without a feed", "put FEDRAT before it")]


def rounded_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return the first feed of an operation that prints as zero, or else the first that rounding changes much."""
    moves, number_format = motion.operation.moves, program.control.number_formats(motion.three_axis)["feed"]
    if motion.mode is MachiningMode.WITHOUT_TCP or not len(moves):
        return []
    changes = np.flatnonzero(np.diff(moves.feed, prepend=np.nan) != 0.0)
    rows = changes[(moves.kind[changes] != Kind.RAPID) & (moves.feed[changes] > 0.0)]
    found = (
        rounding_problem(program.file, int(moves.line[k]), number_format, float(moves.feed[k]), bool(moves.per_rev[k]))
        for k in rows.tolist()
    )
    problems = [problem for problem in found if problem is not None]
    return sorted(problems, key=lambda problem: problem.severity is not Severity.ERROR)[:1]


def rounding_problem(file: str, line: int, number_format: NumberFormat, feed: float, per_rev: bool) -> Problem | None:
    """Return what a number format makes of a feed: zero, or another feed; None if it prints it well."""
    printed = round(feed, number_format.decimals)
    cure = "write it in mm/min (MMPM)" if per_rev else "raise it"
    if printed < number_format.least:
        return Problem(file, line, f"a feed of {feed:g} is below the least that the control reads", cure)
    if abs(printed - feed) > _ROUNDING_LIMIT * feed:
        return Problem(file, line, f"a feed of {feed:g} prints as {printed:g}", cure, Severity.WARNING)
    return None
