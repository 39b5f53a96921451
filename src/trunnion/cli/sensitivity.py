"""``trunnion sensitivity``: which number of a machine's geometry a program depends on."""

import argparse
from collections.abc import Iterator

from trunnion.capability.sensitivity import ErrorExtent, NumberSensitivity, Sensitivity
from trunnion.cli.results import as_json, print_result
from trunnion.cli.terminal import Terminal
from trunnion.files import atomic_file, check_outputs
from trunnion.jobs.capability.sensitivity import sensitivity
from trunnion.jobs.capability.sensitivity_report import (
    amount_text,
    check_sensitivity_report,
    place_text,
    sensitivity_data,
    write_sensitivity_report,
    zero_text,
)
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.wording import counted, one_line


def run(arguments: argparse.Namespace) -> int:
    """Rank the numbers, print and draw them."""
    machine = load_machine(arguments.machine)
    read = [arguments.file, *arguments.subprograms, *machine_files(arguments.machine, machine)]
    if arguments.report is not None:
        check_sensitivity_report(arguments.report, read)
    check_outputs([each for each in (arguments.report, arguments.json) if each not in (None, "-")], read)
    found = sensitivity(
        arguments.file,
        machine=machine,
        subprograms=arguments.subprograms,
        zero=arguments.zero,
        tool_length=arguments.tool_length,
        length=arguments.length,
        angle=arguments.angle,
        zero_at=arguments.zero_at,
    )
    Terminal().problems(found.remarks)
    if arguments.report is not None:
        write_sensitivity_report(found, arguments.report, read)
    if arguments.json == "-":
        print_result(as_json(sensitivity_data(found)))
        return 0
    if arguments.json is not None:
        with atomic_file(arguments.json, inputs=read) as sink:
            sink.write((as_json(sensitivity_data(found)) + "\n").encode())
    print_result(*map(one_line, sensitivity_lines(found)))
    return 0


def sensitivity_lines(found: Sensitivity) -> Iterator[str]:
    """A sensitivity as a table."""
    wide = max(len(each.number.name) for each in found.numbers)
    yield f"{found.run.files[0]}: {counted(found.motions, 'motion')} at feed; workpiece zero {_zero_words(found)}"
    yield (
        "errors of the tip in mm: the largest, with its block (at), and the root of the mean square over all motions"
        " (rms); axis deg: the largest of the tool axis"
    )
    if found.zero_at is not None:
        yield "zero set: what is on the part after the workpiece zero was set with the same error; as it is: all of it"
    zeroed = f"{'zero set: mm':>12}  {'at':<18} {'rms':>8}  " if found.zero_at is not None else ""
    yield f"{'number':<{wide}} {'off by':>8}  {zeroed}{'as it is: mm':>12}  {'at':<18} {'rms':>8}  axis deg"
    for each in found.numbers:
        yield _line(each, found, wide)
    if found.idle:
        yield "without effect: " + ", ".join(number.name for number in found.idle)


def _zero_words(found: Sensitivity) -> str:
    return "not set" if found.zero_at is None else f"set {zero_text(found.zero_at)}"


def _line(each: NumberSensitivity, found: Sensitivity, wide: int) -> str:
    parts = "".join(_extent(part, found) for part in (each.zeroed, each.tip) if part is not None)
    axis = f"{each.axis_deg:.6f}" if each.axis_deg else "-"
    return f"{each.number.name:<{wide}} {amount_text(each):>8}  {parts}{axis:>8}"


def _extent(extent: ErrorExtent, found: Sensitivity) -> str:
    return f"{extent.largest:>12.5f}  {place_text(extent, found.run):<18} {extent.rms:>8.5f}  "
