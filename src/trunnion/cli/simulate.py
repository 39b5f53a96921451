"""``trunnion simulate``: what NC programs leave of the stock, and what they hit."""

from collections.abc import Iterator
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_words, line, part, spoken, together
from trunnion.jobs.job import Given
from trunnion.jobs.simulate.report import write_simulation_report
from trunnion.jobs.simulate.result import SimulationResult, bodies_stand_lines, travel_lines
from trunnion.jobs.simulate.simulating import simulate
from trunnion.messages import word_said
from trunnion.model.clamping import Clamping, number
from trunnion.simulation.meshes import save_mesh
from trunnion.simulation.setup_findings import NearMiss, SimulationFinding
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.stock.surface import stock_surface
from trunnion.wording import format_duration, position

#: Findings that the text shows of each kind; the data has all.
_MOST: Final = 20


def run(given: Given) -> int:
    """Simulate programs; 0 if nothing was found, else 1."""
    found = simulate(**given.arguments(), observer=Terminal())
    if given.save_stock is not None:
        save_mesh(stock_surface(found.simulation.stock), given.save_stock, inputs=given.read)
    if given.report is not None:
        write_simulation_report(found, given.report, given.read, spoken())
    show(given, lambda: found, simulation_lines(found))
    return 0 if found.passed else 1


def simulation_lines(found: SimulationResult) -> Iterator[str]:
    """Yield a simulation in lines."""
    for operation in found.operations:
        removed = line(
            "removed_in",
            file=operation.file,
            line=operation.line,
            tool=operation.tool,
            volume=operation.removed,
            time=format_duration(operation.seconds),
        )
        air = line("of_it_in_air", length=operation.air) if operation.air else ""
        yield f"{_of_setup(operation.setup)}{removed}{air}"
    shown = dict[str, int]()
    for finding in found.findings:
        shown[finding.kind] = shown.get(finding.kind, 0) + 1
        if shown[finding.kind] <= _MOST:
            yield _line(finding)
    for kind, count in shown.items():
        if count > _MOST:
            yield line("and_more_of_kind", count=count - _MOST, kind=word_said(kind))
    for miss in found.near[:_MOST]:
        yield _line(miss)
    for each in found.setups or (found,):
        if each.left is not None and each.simulation is found.simulation:
            yield _of_setup(each.setup) + _excess_line("left_on_part", each.left)
        if each.gouge is not None:
            doubt = line("not_under_compensation") if each.cuts_not_checked else ""
            yield _of_setup(each.setup) + together(_excess_line("missing_from_part", each.gouge), doubt)
    for each in found.setups or (found,):
        if Clamping(each.turn, each.tilt).is_turned:
            variant = "clamped_tilted" if each.tilt else "clamped_turned"
            told = line(variant, tilt=number(each.tilt), turn=number(each.turn))
            yield f"{_of_setup(each.setup)}{told}"
    if found.stock_from:
        yield line("stock_of_cl_file", file=found.stock_from)
    cell = " x ".join(f"{width:.4g}" for width in found.cell)
    yield line("removed_in_all", volume=found.removed, cell=cell, accuracy=found.accuracy)
    yield from bodies_stand_lines(found, spoken())
    yield from travel_lines(found, spoken())
    yield found.line(spoken())


def _of_setup(name: str) -> str:
    """How lines about a set-up begin."""
    return f"{name}: " if name else ""


def _line(each: SimulationFinding | NearMiss) -> str:
    block = f" N{each.block}" if each.block >= 0 else ""
    said = in_words(each.said)
    if each.among is not None:
        said = line("in_stretch", finding=each.said, stretch=each.among)
    return f"{_of_setup(each.setup)}{each.file}:{each.line}:{block} {said}"


def _excess_line(variant: str, excess: Excess) -> str:
    at = excess.places[0].at if excess.places else None
    where = part("at_place", place=position(at)) if at else ""
    return line(variant, most=excess.largest, where=where, volume=excess.volume)
