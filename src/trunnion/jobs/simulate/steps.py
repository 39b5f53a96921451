"""Set-ups that are simulated one after another: the stock that one leaves is that of the next."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Final, TypeAlias

from trunnion import readers, simulation
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jit import compile_ahead
from trunnion.jobs.inputs.arguments import check_choice, check_whole
from trunnion.jobs.inputs.settings import check_tolerance
from trunnion.jobs.inputs.simulation_input import (
    SimulationInput,
    leaves_stock_to_cl,
    told_with_places,
    with_decided_stock,
)
from trunnion.jobs.observer import Observer, Untold
from trunnion.jobs.simulate.meanings import in_other_meanings
from trunnion.jobs.simulate.result import SimulationResult, join_results, make_result
from trunnion.jobs.simulate.setups import prepare_setup
from trunnion.machines.forward import tool_axis_rows
from trunnion.messages import Wording
from trunnion.options.words import FRAME_SETTING
from trunnion.simulation.cutting.shares import JoinedShares, Share
from trunnion.simulation.meshes import DEVIATION
from trunnion.simulation.prepared_setup import PreparedSetup
from trunnion.simulation.steps import CuttingOptions, SetupSteps
from trunnion.simulation.stock.solids import StockShape, check_narrow_tools, default_cell, stock_shape
from trunnion.simulation.tools.profile import cutting_width
from trunnion.verification.kinematics.axis_motion_kernel import axis_motion_rows

#: Part of a cell within which motions are simulated by default.
_TOLERANCE: Final = 0.1

#: The greatest part of a cell by which motions may be off.
_COARSEST: Final = 0.5

#: Part of the tolerance of motions within which exact surfaces of CAD files become facets.
_FACETS: Final = 0.25


def simulate_setups(given: SimulationInput, observer: Observer, shares: JoinedShares | None = None) -> SimulationResult:
    """Read everything, then cut the stock in one set-up after another; ``shares`` are those of ``cut_setup_share``.

    Raises ``InputError`` when a file or an argument cannot be used, or nothing says the form of a tool.

    Raises ``DamagedShareError`` if the shares cannot be used.
    """
    with told_with_places(given.places):
        if shares is not None:
            _check_sharing(given)
        steps, shape, setups, remarks, stock_from = _prepared(given, observer, shares)
        stops = given.stop_at == "first"
        results = list(_cut(steps, shape, setups, remarks, stops=stops))
        if not (stops and results[-1].findings):
            again = partial(_cut_again, steps, Untold(observer), shape, stops=stops)
            results = in_other_meanings(results, list(zip(given.setups, setups, strict=True)), again, observer)
        return replace(join_results(results), stock_from=stock_from)


def _cut(
    steps: SetupSteps,
    shape: StockShape,
    setups: Sequence[PreparedSetup],
    remarks: Sequence[list[Problem]],
    *,
    stops: bool,
) -> Iterator[SimulationResult]:
    """Yield what cutting in each set-up comes to, up to the one with the first finding if it ``stops`` there."""
    for own, told in zip(setups, remarks, strict=True):
        result = make_result(steps.follow(own, shape, told))
        yield result
        if stops and result.findings:
            return


def _cut_again(
    steps: SetupSteps,
    observer: Observer,
    shape: StockShape,
    setups: Sequence[PreparedSetup],
    remarks: Sequence[list[Problem]],
    *,
    stops: bool,
) -> Iterator[SimulationResult]:
    """Yield what cutting the stock from the beginning comes to in other set-ups."""
    return _cut(steps.again(observer), shape, setups, remarks, stops=stops)


def cut_setup_share(given: SimulationInput, share: Share, observer: Observer) -> bytes:
    """Read everything, and cut some tiles of the stock: the bytes that ``shares.JoinedShares`` takes.

    Raises ``InputError`` as ``simulate_setups``; and if there are several set-ups, or it is to end at the first
    finding.
    """
    with told_with_places(given.places):
        _check_sharing(given)
        steps, shape, (own,), (told,), _ = _prepared(given, observer)
        return steps.share(own, shape, share, told)


def _check_sharing(given: SimulationInput) -> None:
    """Refuse to divide what is not known from single tiles."""
    if len(given.setups) > 1:
        raise InputError(argument_problem("tiles", Wording("SIM116", "several_setups", count=len(given.setups))))
    if given.stop_at == "first":
        raise InputError(argument_problem("tiles", Wording("SIM116", "stops_at_first_finding")))


_Prepared: TypeAlias = tuple["SetupSteps", StockShape, Sequence[PreparedSetup], Sequence[list[Problem]], str]


def _prepared(given: SimulationInput, observer: Observer, shares: JoinedShares | None = None) -> _Prepared:
    """Return what cuts, the stock, the set-ups as they were read, what is remarked of each, and the CL file that states
    the stock.
    """
    design = simulation.DESIGN_KERNELS if any(each.part is not None for each in given.setups) else ()
    # The second process begins with the largest, the last one; what is saved at the end is left to it.
    called = (*readers.KERNELS, tool_axis_rows, axis_motion_rows, *design, *simulation.KERNELS)
    compile_ahead((*simulation.SURFACE_KERNELS, *called))
    check_choice("stop_at", given.stop_at or "none", ("none", "first"))
    for name, value in (("cell", given.cell), ("accuracy", given.accuracy), ("near", given.near)):
        check_tolerance(name, value, optional=True)
    threads = None if given.threads is None else check_whole("threads", given.threads, 1)
    remarks: list[list[Problem]] = [[] for _ in given.setups]
    deviation = _deviation(given)
    is_known = not leaves_stock_to_cl(given.stock)
    shape = stock_shape(given.stock, remarks[0].append, deviation) if is_known else None
    setups, problems = [], list[Problem]()
    for each, told in zip(given.setups, remarks, strict=True):
        try:
            with told_with_places(each.places, each.name):
                setups.append(prepare_setup(each, told, observer, deviation))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(dict.fromkeys(problems))
    if shape is None:
        is_absolute = (given.setups[0].settings or {}).get(FRAME_SETTING) == "absolute"
        given = with_decided_stock(given, setups[0].drawn, is_absolute=is_absolute)
        shape = stock_shape(given.stock)
    widths = {name: cutting_width(tool) for each in setups for name, tool in each.tools.items()}
    cell = given.cell or default_cell(shape, min(widths.values(), default=math.inf))
    check_narrow_tools(widths, cell)
    if given.accuracy is not None and given.accuracy > _COARSEST * cell:
        raise InputError(
            argument_problem(
                "accuracy",
                Wording("SIM121", "coarser_than_cells", accuracy=given.accuracy, cell=cell, most=_COARSEST * cell),
            )
        )
    simulation.check_cell(shape, cell)
    tolerance, to_first = given.accuracy or _TOLERANCE * cell, given.stop_at == "first"
    options = CuttingOptions(cell, tolerance, given.near or 0.0, to_first, threads)
    return SetupSteps(options, observer, shares), shape, setups, remarks, given.stock_from


def _deviation(given: SimulationInput) -> float:
    """How far facets of exact surfaces may be off them, mm: a part of the accuracy that is asked for."""
    if given.accuracy is not None:
        return _FACETS * given.accuracy
    return DEVIATION if given.cell is None else _FACETS * _TOLERANCE * given.cell
