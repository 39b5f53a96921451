"""Whether the surface's normals that a program says are those of the CL files' contact points.

In:     a run, what was wanted with its normals, and which rows answer to which.
Out:    a check; none where nobody asks for normals and the program says none.

A block that places the rotary axes by their own words has no place for a normal.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.run import Run, Written
from trunnion.model.toolpath import Kind
from trunnion.verification.context import NAMED, Case
from trunnion.verification.matching.expected_path import Part
from trunnion.verification.results import Check, Place

_TITLE: Final = "surface normals against the contact points"
_ROTARY: Final = int(Written.FIRST | Written.SECOND)


def normals(case: Case) -> list[Check]:
    """One check, or none."""
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    asking = [part for part in wanted.parts if _asks(part)]
    if not asking and not len(run.normals):
        return []
    places: list[Place] = []
    bad = right = 0
    largest = limit = 0.0
    for part in asking:
        start, stop = pairs.cl.before(part.first), pairs.cl.before(part.end)
        limit = max(limit, part.allowed.normal)
        for nc, cl in pairs.chunks(start, stop):
            asked, said = _asked(part, cl), _said(run, nc)
            off = np.abs(said - asked).max(axis=1)
            both, cut = np.isfinite(off), run.kind[nc] == Kind.LINEAR
            missing = np.isfinite(asked[:, 0]) & np.isnan(said[:, 0]) & cut & ((run.programmed[nc] & _ROTARY) == 0)
            strange = np.isnan(asked[:, 0]) & np.isfinite(said[:, 0])
            wrong = both & (off > part.allowed.normal)
            right += int(both.sum() - wrong.sum())
            largest = max(largest, float(off[both].max(initial=0.0)))
            texts = (
                (missing, "says no surface normal, and the CL file has a contact point"),
                (strange, "says a surface normal where the CL file has no contact point"),
                (wrong, "the surface normal is off"),
            )
            for rows, text in texts:
                bad += int(rows.sum())
                for k in np.flatnonzero(rows)[: NAMED - len(places)].tolist():
                    value = float(off[k]) if both[k] else 0.0
                    told = f"{text} by {value:.9f}" if both[k] else text
                    places.append(case.place(int(nc[k]), value, told, int(cl[k])))
    summary = f"{right} normals as the contact points have them, largest difference {largest:.9f}"
    if not asking:
        summary = f"{len(run.normals)} normals, and the CL files have no contact points to compare them with"
    if bad:
        summary += f", {bad} are not"
    return [Check("normal", _TITLE, not bad, summary, largest, limit or None, "", tuple(places))]


def _asks(part: Part) -> bool:
    normal = part.operation.moves.normal
    return normal is not None and bool(np.isfinite(normal).any())


def _asked(part: Part, cl: Ints) -> Floats:
    """(k, 3): the normals of CL rows, NaN where there are none."""
    normal = part.operation.moves.normal
    assert normal is not None
    return np.asarray(normal[cl - part.first])


def _said(run: Run, nc: Ints) -> Floats:
    """(k, 3): the normals that rows of the run say, NaN where they say none."""
    found = np.full((len(nc), 3), np.nan)
    if len(run.normals):
        place = np.minimum(np.searchsorted(run.normals.row, nc), len(run.normals) - 1)
        there = run.normals.row[place] == nc
        found[there] = run.normals.vector[place[there]]
    return found
