"""Impellers, machined: from a definition to CL files and one proven program of all operations."""

import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple, Unpack

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.cl.writers import WRITERS
from trunnion.controls import load_control
from trunnion.errors import InputError, Problem, argument_problem, warning
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.machining import StepPaths, step_paths
from trunnion.impeller.material import material_before, order_problems, side_problems
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.paths.toolpaths import CuttingData, operation_of
from trunnion.impeller.steps import StepKind, file_stem
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.arguments import ImpellerArguments, taken
from trunnion.jobs.impeller.cut import CutStep, ImpellerCut
from trunnion.jobs.impeller.files import ImpellerFiles, output_folder
from trunnion.jobs.impeller.models import load_impeller, model_impeller
from trunnion.jobs.impeller.settings import operation_settings, program_settings
from trunnion.jobs.impeller.step_times import step_times
from trunnion.jobs.impeller.windings import winding_problems
from trunnion.jobs.inputs.arguments import check_observer, wrong_argument
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine, read_cl
from trunnion.jobs.inputs.settings import check_tolerance
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.papers.writing import PostPapers
from trunnion.jobs.post.post_job import PostJob, prepare
from trunnion.jobs.post.posting import post_toolpaths
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post.writing import named_run
from trunnion.jobs.result_output import PaperFiles, open_target
from trunnion.jobs.simulate.posted import simulation_checks
from trunnion.jobs.simulate.report import simulation_content
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.simulating import simulate
from trunnion.machines import Machine
from trunnion.machines.inverse import inverse
from trunnion.machines.spindle_range import spindle_speed_fault
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Operation, Tool, Toolpath
from trunnion.reporting.simulation_page import render_simulation_page
from trunnion.simulation.meshes import picture
from trunnion.simulation.stock.surface import stock_surface
from trunnion.simulation.tools.library import LibraryTool
from trunnion.simulation.tools.sizes import ToolKind
from trunnion.verification import durations

#: How closely the model follows the surfaces where a simulation compares with it, as a part of the width of its cells.
_MODEL: Final = 0.1


def cut_impeller(
    impeller: Impeller | FilePath,
    *,
    machine: MachineLike,
    output: FilePath,
    observer: Observer = SILENT,
    **given: Unpack[ImpellerArguments],
) -> ImpellerCut:
    """Machine an impeller: tool paths of all its operations, CL files, and one program for all of them, proven.

    Parameters
    ----------
    impeller
        Of ``trunnion.load_impeller``, or its definition, with ``[[operation]]`` and ``[[tool]]`` (docs/impeller.md).
    machine
        As for ``trunnion.post``. Tool axes keep to what its rotary axes reach.
    output
        Folder, made if there is none: it takes a CL file for each operation of the definition, the main program with
        its subprograms, the report of the proof, and what is made of the simulation. They appear together, or not at
        all.
    operations
        Names of operations, to make these only; by default all.
    settings
        As for ``trunnion.post``. ``programs`` is ``operations`` where the control has subprograms, and ``mode`` is
        ``tcp`` where it has TCP.
    cell
        Width in mm of the cells in which the program is simulated, and what it leaves compared with the model; the
        folder gets the report of that and a picture. None: it is not simulated.
    observer
        Receives the progress, warnings and the proof.

    Returns
    -------
    ImpellerCut
        Steps with their toolpaths, times and clearances; the proof; the files.

    Raises
    ------
    InputError
        As ``load_impeller``; if the definition has no operations or none of a name; if the spindle does not have their
        speeds; or a step cannot be made, with the place and what helps.
    RefusedError
        As ``post``: when the program must not run. Nothing is written.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.cut_impeller(
    ...     "examples/impeller/impeller.toml", machine="yl569", output="build/impeller", operations=["STOCK_ROUGHING"],
    ... )
    >>> found
    ImpellerCut(passed=True, 1 steps)
    """
    check_observer(observer)
    stated = taken(ImpellerArguments, "impeller", given)
    cell = stated["cell"]
    check_tolerance("cell", cell, optional=True)
    found = impeller if isinstance(impeller, Impeller) else load_impeller(impeller)
    observer.problems(found.remarks)
    definition = found.definition
    chosen = _chosen(found, stated["operations"])
    loaded = as_machine(machine)
    _check_speeds(found, chosen, loaded)
    remarks = tuple(order_problems(found, chosen))
    observer.problems(remarks)
    control = load_control(loaded.control)
    stem = file_stem(definition.name)
    own = program_settings(control, definition.name, stem)
    job = prepare(loaded, {**own, **(stated["settings"] or {})}, columns=True)
    read = [*definition.files, *machine_files(machine, loaded)]
    with output_folder(output) as folder:
        files = ImpellerFiles(folder, stem, control.extension)
        files.check_own()
        try:
            cut = _cut(_Cutting(found, chosen, loaded, files, read, cell), job, observer)
            return replace(cut, remarks=(*remarks, *cut.remarks))
        finally:
            files.remember_report()


class _Cutting(NamedTuple):
    """What is cut, and where its files go.

    chosen  names of the steps
    inputs  files that are read
    cell    of the simulation, mm; None: there is none
    """

    impeller: Impeller
    chosen: Sequence[str]
    machine: Machine
    files: ImpellerFiles
    inputs: Sequence[FilePath]
    cell: float | None


def _cut(cutting: _Cutting, job: PostJob, observer: Observer) -> ImpellerCut:
    """As ``cut_impeller``: all files appear when it ends."""
    found, chosen, machine, files, inputs, cell = cutting
    definition = found.definition
    job = replace(job, papers=PaperFiles(report=files.report), can_force=False)
    with open_target(files.program, papers={"report": files.report}, inputs=inputs) as target:
        naming = job.control.subprograms if job.subprograms(target.files, target.path) is not None else None
        steps = [step for step in definition.steps if step.name in chosen]
        files.check_others(target.files, steps, found, naming, simulated=cell is not None)
        compile_ahead(kernels.POSTING)
        made, texts, toolpaths = [], [], []
        with observer.progress("tool paths", len(chosen), "steps") as advance:
            for paths in step_paths(found, reachable_axes(machine), chosen, observer.progress):
                file = files.cl_file(paths.step)
                text = cl_text(step_toolpath(paths, definition.name, str(file)))
                made.append(paths)
                texts.append((file, text))
                toolpaths.append(replace(read_cl(io.BytesIO(text)), file=str(file)))
                advance(1)
        own_settings = operation_settings(made, job.control, job.settings, job.own_settings)
        job = replace(job, own_settings=own_settings)
        papers: list[PostPapers] = []
        result = post_toolpaths(toolpaths, job, target, observer, papers)
        for file, text in texts:
            target.files.add_file(file.name).write(text)
        cut = tuple(_steps(found, made, toolpaths, result))
        beside = [each for one in cut for each in side_problems(definition.file, one.step, one.before, one.clearance)]
        beside += [_shared(definition.file, one) for one in made if one.share < 1.0]
        beside += [each for one in made for each in _one_layer(definition.file, one)]
        for one in cut:
            names = [operation.name for operation in one.toolpath.operations]
            own_motions = [motion for motion in result.motions if motion.operation.name in names]
            beside += winding_problems(definition.file, one.step, own_motions, machine)
        observer.problems(beside)
        simulated = None
        if cell is not None:
            simulated = _simulated(found, machine, cut, result, cell, observer)
            page = render_simulation_page(simulation_content(simulated))
            target.files.add_file(files.simulation.name).writelines(page)
            target.files.add_file(files.picture.name).write(picture(stock_surface(simulated.simulation.stock)))
        for each in papers:
            _with_simulation(each, simulated).write()
    return ImpellerCut(found, cut, result, tuple(file for file, _ in texts), simulated, tuple(beside))


def _with_simulation(papers: PostPapers, simulated: SimulationResult | None) -> PostPapers:
    """Return the papers with what the simulation found as checks: the report of the proof and its own say the same."""
    proven = papers.result.verification
    if simulated is None or proven is None:
        return papers
    proven = replace(proven, checks=(*proven.checks, *simulation_checks(simulated)))
    return replace(papers, result=replace(papers.result, verification=proven))


def _chosen(impeller: Impeller, names: Sequence[str]) -> list[str]:
    """Return the names of the steps to be made.

    Raises ``InputError`` if the definition has none, or none of a name.
    """
    known = [step.name for step in impeller.definition.steps]
    if not known:
        raise InputError(argument_problem("impeller", Wording("IMP310", "no_operations")))
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise wrong_argument("operations", names, phrase("give_names"))
    if unknown := [name for name in names if name not in known]:
        raise InputError(
            [
                argument_problem(
                    "operations", Wording("IMP310", "no_such_operation", operation=repr(name), known=tuple(known))
                )
                for name in unknown
            ]
        )
    return [name for name in known if name in names or not names]


def _check_speeds(impeller: Impeller, chosen: Sequence[str], machine: Machine) -> None:
    """Raise ``InputError`` for spindle speeds that the machine does not have, before minutes go into paths."""
    definition = impeller.definition
    faults = [(step.name, spindle_speed_fault(machine, step.rpm)) for step in definition.steps if step.name in chosen]
    if problems := [
        Problem(definition.file, 0, Wording("IMP311", "spindle_speed_impossible", operation=name, fault=fault))
        for name, fault in faults
        if fault
    ]:
        raise InputError(problems)


def reachable_axes(machine: Machine) -> Callable[[Floats], Flags]:
    """Tells of tool axes (n, 3) whether the rotary axes of a machine reach them within their travel, (n,)."""
    columns = list(machine.rotary)
    limits = machine.limits[columns]

    def reachable(axes: Floats) -> Flags:
        found = inverse(machine, np.zeros_like(axes), axes)
        angles = found.joints[:, :, columns, None] + np.array([-360.0, 0.0, 360.0])
        inside = (angles >= limits[:, 0, None]) & (angles <= limits[:, 1, None])
        return np.asarray(found.reachable & inside.any(axis=3).all(axis=2).any(axis=0))

    return reachable


def step_toolpath(paths: StepPaths, part: str, file: str) -> Toolpath:
    """Return the operations of a step as the content of a CL file."""
    step = paths.step
    data = CuttingData(step.rpm, step.feed, step.lead_feed, step.coolant, step.tolerance)
    tool = cl_tool(paths.tool)
    operations: list[Operation] = [
        operation_of(name, path, tool, step.tool, paths.radius, data)
        for name, path in zip(paths.names, paths.paths, strict=True)
    ]
    return Toolpath(file, tuple(operations), part)


def cl_tool(tool: LibraryTool) -> Tool:
    """Return a tool as CL files describe it: its cutter."""
    sizes = tool.sizes
    radius = 0.0 if sizes.kind is ToolKind.FLAT else sizes.diameter / 2.0
    centre = (0.0, radius) if sizes.kind is ToolKind.TAPER_BALL else None
    name = tool.name or f"T{tool.number}"
    return Tool(
        "MILL", name, sizes.diameter, radius, sizes.length, sizes.side_angle, flute_length=sizes.flute_length,
        corner_centre=centre,
    )  # fmt: skip


def cl_text(toolpath: Toolpath) -> bytes:
    """Return a toolpath as a CL file.

    Raises ``InputError`` if it cannot hold it.
    """
    sink = io.BytesIO()
    WRITERS["clsf"](toolpath).write(sink)
    return sink.getvalue()


def _steps(
    impeller: Impeller, made: Sequence[StepPaths], toolpaths: Sequence[Toolpath], result: PostResult
) -> Iterator[CutStep]:
    """Yield the steps with the times of their operations."""
    before = {
        step.name: stands for step, stands in zip(impeller.definition.steps, material_before(impeller), strict=False)
    }
    assert result.verification is not None
    seconds, _ = durations(result.verification)
    of_operation = iter(result.verification.operations)
    files = result.subprograms
    is_each = len(files) == sum(len(one.operations) for one in toolpaths)
    for paths, toolpath in zip(made, toolpaths, strict=True):
        points = sum(len(operation.moves) for operation in toolpath.operations)
        clearance: dict[str, PartClearance] = {}
        for one in (*paths.clearance, *(one for axes in paths.axes for one in axes.clearance)):
            if one.part not in clearance or one.distance < clearance[one.part].distance:
                clearance[one.part] = one
        rows = [next(of_operation) for _ in toolpath.operations]
        own = tuple(float(seconds[each.first : each.end].sum()) for each in rows)
        times = step_times(paths.step.feed, toolpath.operations, rows, result.verification)
        flanks = tuple((one.cut.left.overcut, one.cut.left.undercut) for one in paths.flanks)
        programs, files = (files[: len(own)], files[len(own) :]) if is_each else ((), files)
        yield CutStep(
            paths.step, toolpath, points, own, times, tuple(clearance.values()), before[paths.step.name], flanks,
            Path(toolpath.file), programs,
        )  # fmt: skip


def _shared(file: str, paths: StepPaths) -> Problem:
    """Return the warning about a step that keeps only a share of its clearances."""
    cutter, shank, holder, _ = paths.step.clearance
    return warning(
        file,
        paths.step.line,
        Wording(
            "IMP330",
            "clearances_kept_in_part",
            step=paths.step.name,
            share=paths.share,
            cutter=cutter,
            shank=shank,
            holder=holder,
        ),
    )


def _one_layer(file: str, paths: StepPaths) -> Iterator[Problem]:
    """Yield the warning about a step that takes the whole depth of a channel at once, and more than its ball's
    radius.
    """
    step, passes = paths.step, [one for family in paths.families for one in family.passes]
    if (
        step.kind is StepKind.CHANNEL_ROUGHING
        and step.step_down > paths.radius
        and not any(one.layer for one in passes)
    ):
        yield warning(
            file, step.line, Wording("IMP331", "whole_depth_in_one_layer", step=step.name, step_down=step.step_down)
        )


def _simulated(
    impeller: Impeller, machine: Machine, steps: Sequence[CutStep], result: PostResult, cell: float, observer: Observer
) -> SimulationResult:
    """Return what the program leaves of the stock, compared with the model."""
    definition = impeller.definition
    stock = definition.stock
    called = {one.step.tool for one in steps}
    assert result.run is not None
    return simulate(
        named_run(result.run, str(result.output)),
        machine=machine,
        stock=f"cylinder:{stock.diameter:g},{stock.height:g},{stock.bottom:g}",
        part=model_impeller(impeller, tolerance=max(_MODEL * cell, 0.005)).mesh,
        tools=[tool.shape() for tool in definition.tools if tool.number in called],
        cell=cell,
        observer=observer,
    )
