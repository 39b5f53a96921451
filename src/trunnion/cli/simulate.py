"""``trunnion simulate``: what NC programs leave of the stock, and what they hit."""

import argparse
from collections.abc import Iterator
from typing import Final

from trunnion.cli.cl_files import cl_inputs, named_files
from trunnion.cli.results import as_json, print_result
from trunnion.cli.terminal import Terminal
from trunnion.errors import Severity
from trunnion.files import atomic_file, check_outputs
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.papers.reports import check_report_name
from trunnion.jobs.papers.simulation_report import write_simulation_report
from trunnion.jobs.project.file import library_files, project_files
from trunnion.jobs.simulate.data import simulation_data
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.simulating import simulate
from trunnion.model.clamping import Clamping, number
from trunnion.simulation.meshes import check_mesh_name, save_mesh
from trunnion.simulation.setup_findings import NearMiss, SimulationFinding
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.stock.surface import stock_surface
from trunnion.wording import counted, format_duration, one_line

#: Findings that the text shows of each kind; the data has all.
_MOST: Final = 20


def run(arguments: argparse.Namespace) -> int:
    """Simulate programs; 0 if nothing was found, else 1."""
    read = [*arguments.files, *named_files(arguments.cl), *library_files(arguments.libraries), *arguments.subprograms]
    read += [mesh for mesh in (arguments.part, arguments.stock, *arguments.fixtures) if mesh is not None]
    read += project_files(arguments.files)
    if arguments.machine is not None:
        read += machine_files(arguments.machine, load_machine(arguments.machine))
    if arguments.save_stock is not None:
        check_mesh_name(arguments.save_stock)
    if arguments.report is not None:
        check_report_name(arguments.report)
    targets = (arguments.save_stock, arguments.report, arguments.json)
    check_outputs([target for target in targets if target not in (None, "-")], read)
    found = simulate(
        arguments.files,
        machine=arguments.machine,
        stock=arguments.stock,
        part=arguments.part,
        fixtures=arguments.fixtures,
        near=arguments.near,
        tools=arguments.tools,
        libraries=arguments.libraries,
        unit=arguments.unit,
        cl=cl_inputs(arguments.cl),
        subprograms=arguments.subprograms,
        cell=arguments.cell,
        accuracy=arguments.accuracy,
        zero=arguments.zero or None,
        tool_length=arguments.tool_length or None,
        turn=arguments.turn,
        tilt=arguments.tilt,
        stop_at=arguments.stop_at,
        until=arguments.until,
        observer=Terminal(),
    )
    if arguments.save_stock is not None:
        save_mesh(stock_surface(found.simulation.stock), arguments.save_stock, inputs=read)
    if arguments.report is not None:
        write_simulation_report(found, arguments.report, read)
    if arguments.json == "-":
        print_result(as_json(simulation_data(found)))
    else:
        print_result(*map(one_line, simulation_lines(found)))
        if arguments.json is not None:
            with atomic_file(arguments.json, inputs=read) as stream:
                stream.write((as_json(simulation_data(found)) + "\n").encode())
    return 0 if found.passed else 1


def simulation_lines(found: SimulationResult) -> Iterator[str]:
    """A simulation in lines."""
    for operation in found.operations:
        air = f", {operation.air:.0f} mm in air" if operation.air else ""
        yield (
            f"{_of_setup(operation.setup)}{operation.file}:{operation.line}: tool {operation.tool}:"
            f" {operation.removed:.1f} mm³ removed in {format_duration(operation.seconds)}{air}"
        )
    shown = dict[str, int]()
    for finding in found.findings:
        shown[finding.kind] = shown.get(finding.kind, 0) + 1
        if shown[finding.kind] <= _MOST:
            yield _finding_line(finding)
    for kind, count in shown.items():
        if count > _MOST:
            yield f"and {count - _MOST} more: {kind}"
    for miss in found.near[:_MOST]:
        yield _near_line(miss)
    for each in found.setups or (found,):
        if each.left is not None and each.simulation is found.simulation:
            yield _of_setup(each.setup) + _excess_line("left on the part", each.left)
        if each.gouge is not None:
            yield _of_setup(each.setup) + _excess_line("missing from the part", each.gouge)
    for each in found.setups or (found,):
        if Clamping(each.turn, each.tilt).is_turned:
            tilted = f"tilted {number(each.tilt)} degrees about X, then " if each.tilt else ""
            how = f"clamped {tilted}turned {number(each.turn)} degrees about Z"
            yield f"{_of_setup(each.setup)}places are those of the part as it is drawn; it is {how}"
    cell = " x ".join(f"{width:.4g}" for width in found.cell)
    yield f"{found.removed:.1f} mm³ removed; cells of {cell} mm, motions and tools within {found.accuracy:.4g} mm"
    errors = sum(remark.severity is Severity.ERROR for remark in found.remarks)
    parts = [counted(len(found.findings), "finding"), *([counted(errors, "error")] if errors else [])]
    yield "nothing found" if found.passed else f"{' and '.join(parts)}: the program must not run"


def _of_setup(name: str) -> str:
    """How lines about a set-up begin."""
    return f"{name}: " if name else ""


def _finding_line(finding: SimulationFinding) -> str:
    last = f" to line {finding.last_line}" if finding.last_line != finding.line else ""
    x, y, z = finding.place
    block = f" N{finding.block}" if finding.block >= 0 else ""
    return (
        f"{_of_setup(finding.setup)}{finding.file}:{finding.line}:{block} {finding.kind}:"
        f" {finding.between[0]}, {finding.between[1]}: {finding.depth:.3f} mm deep at X{x:.3f} Y{y:.3f} Z{z:.3f}{last}"
    )


def _near_line(miss: NearMiss) -> str:
    x, y, z = miss.place
    block = f" N{miss.block}" if miss.block >= 0 else ""
    where = f"X{x:.3f} Y{y:.3f} Z{z:.3f}"
    return (
        f"{_of_setup(miss.setup)}{miss.file}:{miss.line}:{block} near: {' and '.join(miss.between)}:"
        f" {miss.distance:.3f} mm apart at {where}"
    )


def _excess_line(what: str, excess: Excess) -> str:
    at = excess.places[0].at if excess.places else None
    where = f" at X{at[0]:.3f} Y{at[1]:.3f} Z{at[2]:.3f}" if at else ""
    return f"{what}: {excess.largest:.3f} mm at most{where}, {excess.volume:.2f} mm³"
