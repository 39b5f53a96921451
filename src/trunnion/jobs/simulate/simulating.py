"""Simulation of NC programs: what they leave of the stock, what they hit, and the part that comes out."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Unpack

from trunnion.errors import InputError, argument_problem
from trunnion.jobs.arguments import SimulateArguments, taken
from trunnion.jobs.inputs.arguments import check_observer
from trunnion.jobs.inputs.bodies import listed
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.simulation_input import Places, SetupInput, SimulationInput
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.project.file import is_project, read_project
from trunnion.jobs.project.keys import OF_ONE_SETUP, OF_PROJECT
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.steps import simulate_setups
from trunnion.messages import Wording
from trunnion.model.run import Run

#: Arguments of the simulation as a whole.
_WHOLE: Final = (*(each.name for each in OF_PROJECT if each.name != "until"), "threads")


def simulate(
    nc: FilePath | Run | Iterable[FilePath | Run], *, observer: Observer = SILENT, **given: Unpack[SimulateArguments]
) -> SimulationResult:
    """Cut stock with NC programs as the control runs them, and find what they must not do.

    Parameters
    ----------
    nc
        A program or several, in the order in which they cut the same stock: paths, or their runs. Or one project file
        (``.toml``; docs/projects.md), which has programs, stock and all others; what is given here stands in place of
        it.
    machine
        The machine that runs them: a name, a path or a ``Machine``. Only a project may leave it out.
    stock
        ``"box:X,Y,Z[,x0,y0,z0]"`` with its sizes and its lowest corner (0,0,0 by default), ``"cylinder:D,H[,z0]"``
        standing on Z = z0 (0 by default) about X0 Y0, mm in the workpiece frame, or a closed mesh. By default, and as
        ``"cl"``, that which the CL files state (``$$-> STOCK``); the result has the file as ``stock_from``.
    part
        The design, a closed mesh in the workpiece frame.
    fixtures
        Meshes in the workpiece frame, which nothing may touch. They, the part and the bodies of the machine are checked
        against each other and against the tool; the machine's only where ``zero`` and the tools' lengths are known.
    near
        Distance in mm from which on bodies are told that do not touch; by default only those that do.
    tools
        Tools as text, such as ``"3=ball:10,length=60,flutes=20"``, or as bodies; they come first.
    tool_libraries
        Tool libraries, for tools that ``tools`` does not have.
    unit
        Length unit of LinuxCNC's tool tables, which state none.
    cl
        CL files, for tools that neither has.
    units, dialect, strict
        How the CL files are read, as ``trunnion.read_cl`` has it.
    hooks
        Python files that change these CL files, as for ``trunnion.post``. They are run; those of a project are not.
    subprograms
        Files of the subprograms that the programs call. No others are opened.
    cell
        Width of the cells, mm; by default the 200th part of the stock's longest side, and at most half of the narrowest
        tool.
    accuracy
        How far motions may be off, mm; by default a tenth of a cell.
    stop_at
        ``"first"``: end after the block of the first finding.
    until
        N number of the block before which the last program ends.
    radius_register
        As for ``verify``: the tool's centre goes beside the path under radius compensation.
    settings, assume
        How the CL files are read, as for ``trunnion.post``; values of variables that the programs read and do not set,
        and what words do that the reader does not know, as for ``verify``.
    zero, tool_length
        As for ``verify``: without both, machine positions (G53, M91) are taken as retracts along the tool axis.
    turn, tilt
        Of the part, degrees, where it is clamped otherwise than it is drawn, as for ``verify``. Stock, part and
        fixtures are given as they are drawn, and so are all places that are told; CL files are turned.
    threads
        How many; by default as many as there are processors. The result is the same.
    observer
        Receives progress and warnings.

    Returns
    -------
    SimulationResult
        ``passed``; ``findings``, ``left`` and ``gouge``, ``operations``, and the stock in ``simulation``.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or nothing says the form of a tool.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.simulate(
    ...     "tests/golden/yl569/2_hub_rough.expected.mpf", machine="yl569",
    ...     stock="box:80,40,40,-10,-20,-40", tools=["2=ball:8,length=80,flutes=40"], cell=1.0,
    ... )
    >>> [(operation.tool, round(operation.removed / 1000.0)) for operation in found.operations]
    [('2', 2)]
    """
    check_observer(observer)
    return simulate_setups(as_simulation_input(nc, given), observer)


def as_simulation_input(nc: FilePath | Run | Iterable[FilePath | Run], given: SimulateArguments) -> SimulationInput:
    """Return what is simulated: arguments of ``simulate`` by their names.

    Raises ``InputError`` if they contradict each other, or what a project would state is missing.
    """
    own: dict[str, Any] = {**taken(SimulateArguments, "simulate", given)}
    for each in ("units", "dialect"):  # which are settings
        own.pop(each)
    until, whole = own.pop("until"), {name: own.pop(name) for name in _WHOLE}
    programs = listed("nc", nc, Run)
    project = next((Path(each) for each in programs if not isinstance(each, Run) and is_project(Path(each))), None)
    if project is not None:
        if len(programs) > 1:
            raise InputError(argument_problem("nc", Wording("SIM111", "project_among_programs", project=project)))
        stated = [name for name, value in {**whole, **own}.items() if not _is_left_out(value)]
        return _overruled(read_project(project, stated), whole, own, until)
    if own.get("machine") is None:
        raise InputError(argument_problem("machine", Wording("SIM110", "missing")))
    if whole.get("stock") is None:
        if _is_left_out(own.get("cl")):
            raise InputError(argument_problem("stock", Wording("SIM110", "missing")))
        whole["stock"] = ""  # that of the CL files
    setup = SetupInput(programs=programs, until=until, **own)
    return SimulationInput(setups=[setup], **whole)


def _overruled(
    project: SimulationInput, whole: Mapping[str, Any], own: Mapping[str, Any], until: str | int | None
) -> SimulationInput:
    """Return a project with what was given in its place."""
    stated = {name: value for name, value in own.items() if not _is_left_out(value)}
    several = [name for name in OF_ONE_SETUP if name in stated and len(project.setups) > 1]
    if several:
        raise InputError([argument_problem(name, Wording("SIM111", "of_all_setups")) for name in several])
    last: dict[str, Any] = {} if until is None else {"until": until}
    settings = stated.pop("settings", {})
    setups = [
        replace(
            each,
            settings={**(each.settings or {}), **settings},
            places=_without(each.places, stated),
            **stated,
            **(last if each is project.setups[-1] else {}),
        )
        for each in project.setups
    ]
    over = {name: value for name, value in whole.items() if value is not None}
    return replace(project, setups=setups, places=_without(project.places, over | stated), **over)


def _is_left_out(value: object) -> bool:
    return value is None or value is False or (isinstance(value, list | tuple | dict) and not value)


def _without(places: Places, names: Iterable[str]) -> Places:
    """Return the places of arguments that were not given otherwise."""
    return {name: place for name, place in places.items() if name not in names}
