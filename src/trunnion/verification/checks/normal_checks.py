"""Whether the surface's normals that a program says are those of the CL files' contact points.

In:     a run, what was wanted with its normals, and which rows answer to which.
Out:    a check; none where nobody asks for normals and the program says none.

A block that places the rotary axes by their own words has no place for a normal.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import MAX_PLACES, Context
from trunnion.verification.expected.path import Section
from trunnion.verification.results import Check, Place

_TITLE: Final = "surface normals against the contact points"
_ROTARY: Final = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)


def normals(context: Context) -> list[Check]:
    """One check, or none."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    asking = [section for section in expected.sections if _asks(section)]
    if not asking and not len(run.normals):
        return []
    places: list[Place] = []
    bad = right = 0
    largest = limit = 0.0
    for section in asking:
        start, stop = matching.cl.before(section.first), matching.cl.before(section.end)
        limit = max(limit, section.tolerances.normal)
        for nc, cl in matching.pair_chunks(start, stop):
            asked, said = _asked(section, cl), _said(run, nc)
            off = np.abs(said - asked).max(axis=1)
            both, cut = np.isfinite(off), run.kind[nc] == Kind.LINEAR
            missing = np.isfinite(asked[:, 0]) & np.isnan(said[:, 0]) & cut & ((run.programmed[nc] & _ROTARY) == 0)
            strange = np.isnan(asked[:, 0]) & np.isfinite(said[:, 0])
            wrong = both & (off > section.tolerances.normal)
            right += int(both.sum() - wrong.sum())
            largest = max(largest, float(off[both].max(initial=0.0)))
            texts = (
                (missing, "says no surface normal, and the CL file has a contact point"),
                (strange, "says a surface normal where the CL file has no contact point"),
                (wrong, "the surface normal is off"),
            )
            for rows, text in texts:
                bad += int(rows.sum())
                for k in np.flatnonzero(rows)[: MAX_PLACES - len(places)].tolist():
                    value = float(off[k]) if both[k] else 0.0
                    told = f"{text} by {value:.9f}" if both[k] else text
                    places.append(context.place(int(nc[k]), value, told, int(cl[k])))
    summary = f"{right} normals as the contact points have them, largest difference {largest:.9f}"
    if not asking:
        summary = f"{len(run.normals)} normals, and the CL files have no contact points to compare them with"
    if bad:
        summary += f", {bad} are not"
    return [Check("normal", _TITLE, not bad, summary, largest, limit or None, "", tuple(places))]


def _asks(section: Section) -> bool:
    normal = section.operation.moves.normal
    return normal is not None and bool(np.isfinite(normal).any())


def _asked(section: Section, cl: Ints) -> Floats:
    """(k, 3): the normals of CL rows, NaN where there are none."""
    normal = section.operation.moves.normal
    assert normal is not None
    return np.asarray(normal[cl - section.first])


def _said(run: Run, nc: Ints) -> Floats:
    """(k, 3): the normals that rows of the run say, NaN where they say none."""
    found = np.full((len(nc), 3), np.nan)
    if len(run.normals):
        place = np.minimum(np.searchsorted(run.normals.row, nc), len(run.normals) - 1)
        there = run.normals.row[place] == nc
        found[there] = run.normals.vector[place[there]]
    return found
