"""The simulation of a program that is shown: its stock, and what it finds, become part of the page.

In:     the arguments of ``trunnion.simulate`` that a view has, and the run.
Out:    ``ViewContent`` with stock, deviations and findings.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.compensation.stretches import RegisterValue
from trunnion.errors import InputError, Severity, argument_problem
from trunnion.jobs.inputs.simulation_input import SimulationInput
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.writing import named_run
from trunnion.jobs.simulate.posted import simulate_posted, simulation_checks, simulation_input
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.machines import Machine
from trunnion.messages import Wording, joined, phrase
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.options.words import FRAME_SETTING
from trunnion.simulation.body_names import body_said
from trunnion.simulation.finding import What
from trunnion.simulation.setup_findings import NearMiss, SimulationFinding
from trunnion.simulation.tools.profile import cutting_width
from trunnion.verification import Verification
from trunnion.viewer.content import ViewContent, proof_scene
from trunnion.viewer.shown import Mark
from trunnion.viewer.stock import StockView
from trunnion.wording import position

#: Arguments that mean nothing without stock.
_OF_STOCK: Final = ("near", "cell", "accuracy")

#: What is said of each kind of finding.
_KINDS: Final[Mapping[str, str]] = {
    What.RAPID: "rapid_through_stock", What.GOUGE: "gouge", What.STANDING: "cuts_without_spindle",
    What.SHANK: "shank_into_stock", What.HOLDER: "holder_into_stock", What.BODY: "collision", What.NEAR: "near",
}  # fmt: skip

#: Findings that a page shows of each kind at most, the deepest; near misses: the nearest.
_MOST: Final = 200


def view_simulation(machine: Machine, holds: RegisterValue, frame: str | None, **given: Any) -> SimulationInput | None:
    """Return what is to be simulated, before any work; None without stock.

    frame  the setting of that name of the program

    Raises ``InputError`` if an argument needs stock and there is none, or says nothing.
    """
    if given["stock"] is not None:
        found = simulation_input(given, machine, holds)
        if frame is None:
            return found
        return replace(found, setups=[replace(found.setups[0], settings={FRAME_SETTING: frame})])
    alone = [name for name in _OF_STOCK if given[name] is not None]
    if alone:
        raise InputError([argument_problem(name, Wording("PAG111", "of_a_simulation")) for name in alone])
    return None


def with_stock(
    content: ViewContent,
    given: SimulationInput,
    verification: Verification,
    toolpaths: Sequence[Toolpath],
    observer: Observer,
) -> ViewContent:
    """Simulate a program and add what comes out to what its page shows.

    Raises ``InputError`` if a file cannot be used, nothing says the form of a tool, or the stock is too large for a
    picture.
    """
    run = content.rows.run
    read = verification.run
    found = simulate_posted(given, named_run(read, read.files[0]), toolpaths, observer)
    (job,) = found.simulation.programs
    widths = [cutting_width(job.tools[name]) for name in _cutting(run) if name in job.tools]
    stock = StockView(found.simulation, min(widths, default=math.inf))
    warnings: list[Any] = [each for each in found.remarks if each.severity is not Severity.ERROR]
    warnings = [each for each in warnings if each not in content.scene["remarks"]]
    if found.not_judged:
        warnings.insert(0, f"{joined(found.not_judged)}.")
    warnings += [
        phrase("some_shown", what=phrase(_KINDS[kind]), count=_MOST, all=count)
        for kind, count in _counts(found)
        if count > _MOST
    ]
    checks = (*verification.checks, *simulation_checks(found))
    scene = {
        **content.scene,
        "findings": [*content.scene["findings"], *_findings(found, run)],
        **proof_scene(replace(verification, checks=checks)),
        "stock": {**stock.scene(), "remarks": warnings},
    }
    return replace(content, scene=scene, columns={**content.columns, **stock.columns()}, stock=stock)


def _cutting(run: Run) -> set[str]:
    """Return the tools of a run by their names."""
    return {run.tools[int(index)] for index in run.state.tool.distinct()}


def _counts(found: SimulationResult) -> Iterator[tuple[str, int]]:
    """How many findings there are of each kind, and near misses."""
    yield from Counter(one.kind for one in found.findings).items()
    yield "near", len(found.near)


def _findings(found: SimulationResult, run: Run) -> Iterator[Mark]:
    """Yield what the simulation found, with its rows and places; errors that have no row stand at the first one."""
    files = {Path(file).name: number for number, file in enumerate(run.files)}
    for each in found.remarks:
        if each.severity is Severity.ERROR:
            here = np.flatnonzero((run.line >= each.line) & (run.file == files.get(Path(each.file).name, -1)))
            yield Mark.at(run, "simulation", int(here[0]) if len(here) else 0, each)
    shown = Counter[str]()
    for one in sorted(found.findings, key=lambda finding: -finding.depth):
        shown[one.kind] += 1
        if shown[one.kind] <= _MOST:
            yield Mark.at(run, one.kind, one.row, _found(one), one.place)
    for miss in sorted(found.near, key=lambda miss: miss.distance)[:_MOST]:
        yield Mark.at(run, "near", miss.row, _found(miss), miss.place)


def _found(one: SimulationFinding | NearMiss) -> Wording:
    """Return what does what, how deep or how near, and where; in which meaning of the program, if it has several."""
    first, second = one.between
    place = position(one.place)
    if isinstance(one, NearMiss) and one.rubs:
        what = phrase("finding_rubs", one=body_said(first), other=body_said(second), place=place)
    elif isinstance(one, NearMiss):
        what = phrase("near_each_other", first=first, second=second, distance=one.distance, place=place)
    else:
        kind = phrase(_KINDS[one.kind])
        what = phrase("one_in_another", kind=kind, first=first, second=second, depth=one.depth, place=place)
    return phrase("where_skipped", skipped=one.skipped, what=what) if one.skipped else what
