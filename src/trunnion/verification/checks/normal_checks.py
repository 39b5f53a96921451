"""Programmed surface normals against the contact points of the CL files.

Blocks that position rotary axes by their own words cannot have a normal. A block that brings the tool back after a
retract to turn has the normal of the point that it comes back to; no other block without a CL point has one.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.messages import Wording
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext, Faults
from trunnion.verification.expected.path import Section
from trunnion.verification.matching.rewind_retracts import find_rewind_retracts
from trunnion.verification.results import Check


def check_normals(context: ComparedContext) -> list[Check]:
    """One check; none where neither the CL files nor the program have normals."""
    run = context.run
    normals = [
        (section, normal)
        for section in context.expected.sections
        if (normal := section.operation.moves.normal) is not None and np.isfinite(normal).any()
    ]
    if not normals and not len(run.normals):
        return []
    found = Faults()
    right = 0
    largest = limit = 0.0
    compared = [np.zeros(0, np.int64)]
    returns = _returns(context)
    for section, normal in normals:
        tolerance = section.tolerances.normal
        limit = max(limit, tolerance)
        for nc, cl in _pairs(context, section, returns):
            compared.append(nc)
            wanted, actual = normal[cl - section.first], _programmed_normals(run, nc)
            off = np.abs(actual - wanted).max(axis=1)
            both, line = np.isfinite(off), run.kind[nc] == Kind.LINEAR
            may_have = line & ((run.programmed[nc] & int(ROTARY_WORDS)) == 0)
            beyond = both & (off > tolerance)
            right += int(both.sum() - beyond.sum())
            largest = max(largest, float(off[both].max(initial=0.0)))
            faults = (
                (np.isfinite(wanted[:, 0]) & np.isnan(actual[:, 0]) & may_have, "missing"),
                (np.isnan(wanted[:, 0]) & np.isfinite(actual[:, 0]), "not_asked"),
                (beyond, "off"),
            )
            for rows, variant in faults:
                own = np.where(both, off, 0.0)
                places = (
                    context.place_with_cl(int(nc[k]), float(own[k]), Wording("normal", variant, off=own[k]), int(cl[k]))
                    for k in np.flatnonzero(rows)
                )
                found.add_rows(int(rows.sum()), places)
    left = np.setdiff1d(run.normals.row, np.concatenate(compared)) if normals else compared[0]
    at_no_point = Wording("normal", "at_no_point")
    found.add_rows(len(left), (context.place(int(row), 0.0, at_no_point) for row in left))
    answer = Wording("normal", "good", count=right, largest=largest)
    if not normals:
        answer = Wording("normal", "no_points", count=len(run.normals))
    if found.count:
        answer = Wording("normal", "some_wrong", answer=answer, count=found.count)
    return [Check("normal", not found.count, answer, largest, limit or None, "", tuple(found.places))]


def _returns(context: ComparedContext) -> tuple[Ints, Ints]:
    """Rows that come back to a CL point from a retract to turn, and the CL rows of these points, (k,) each."""
    matching = context.matching
    found = find_rewind_retracts(context.run, matching.extra, context.expected.max_tip_tolerance)
    at_points = [retract for retract in found if retract.first - 1 in matching.nc]
    rows = [matching.cl[matching.nc.count_before(retract.first - 1)] for retract in at_points]
    return np.array([retract.end - 1 for retract in at_points], np.int64), np.array(rows, np.int64)


def _pairs(context: ComparedContext, section: Section, returns: tuple[Ints, Ints]) -> Iterator[tuple[Ints, Ints]]:
    """Rows of the run and CL rows of one operation that go together."""
    matching = context.matching
    yield from matching.pair_chunks(*matching.pair_range(section.first, section.end))
    here = (returns[1] >= section.first) & (returns[1] < section.end)
    yield returns[0][here], returns[1][here]


def _programmed_normals(run: Run, nc: Ints) -> Floats:
    """Return normals of rows of the run, (k, 3), NaN where there are none."""
    found = np.full((len(nc), 3), np.nan)
    if len(run.normals):
        k = np.minimum(np.searchsorted(run.normals.row, nc), len(run.normals) - 1)
        has_normal = run.normals.row[k] == nc
        found[has_normal] = run.normals.vector[k[has_normal]]
    return found
