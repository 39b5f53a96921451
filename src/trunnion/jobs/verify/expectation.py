"""What a program that anyone may have written is expected to be: its tolerances, and what its settings say.

In:     a program that was read, and the arguments of its verification.
Out:    tolerances and settings for ``trunnion.verification.verify``.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from trunnion.controls import Control, load_control
from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.jobs.arguments import VerifyArguments
from trunnion.jobs.inputs.control_settings import default_settings
from trunnion.jobs.inputs.settings import as_texts, check_operation_names, check_settings, split_by_operation
from trunnion.jobs.inputs.stated_offsets import with_stated_offsets
from trunnion.jobs.verify.arguments import DEFAULT_TOLERANCE
from trunnion.jobs.verify.expected_values import expected_values
from trunnion.jobs.verify.reading import ReadProgram, VerifiedMachine
from trunnion.machines.loading import DEMANDS
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.verification import ExpectedValues, PrintedDigits, Tolerances, tolerances_in_planes

#: Added to half a digit, so that a value half-way between two digits is inside.
_SLACK: Final = 1e-9

#: In a program in inches, half of 0.0001 inch, mm.
_DEFAULT_INCH_TOLERANCE: Final = 0.0013

#: Lines stand for arcs within this, mm, where programs for the control can be read but not written.
_READ_CHORD: Final = 0.001


def expected(on: VerifiedMachine, read: ReadProgram, given: VerifyArguments) -> ExpectedValues:
    """Return what the program is expected to be; without CL files it may have any work offset and edge.

    Raises ``InputError`` if a work offset is none of the control's, or that of an operation which there is not; or if a
    setting of the post is none of the control's, or its definition has mistakes.
    """
    usual = default_settings(on.control)
    settings = {"work_offset": "G54", **usual}
    if not read.toolpaths:
        settings = {key: value for key, value in usual.items() if key not in ("work_offset", "edge")}
    offset, of_operations = _work_offsets(given["work_offset"], on.control, read.toolpaths)
    own = {"tool": given["tool"], "work_offset": offset, "edge": given["edge"]}
    own[RADIUS_REGISTER_SETTING] = given["radius_register"]
    settings |= {key: str(value) for key, value in own.items() if value is not None}
    repeated, own_repeated = _repeated(on, read, given)
    settings |= repeated
    single = {name: {**own_repeated.get(name, {})} for name in (*own_repeated, *of_operations)}
    for name, value in of_operations.items():
        single[name]["work_offset"] = value
    every = {**repeated, **({"work_offset": offset} if offset else {})}
    _, own_settings = with_stated_offsets(read.toolpaths, (on.machine, on.control), every, single)
    by_operation = {name: {**settings, **values} for name, values in own_settings.items()}
    return replace(
        expected_values(on.control, on.machine, settings, by_operation),
        span=given["span"],
        span_tip=given["span_tip"],
        absolute=given["frame"] == "absolute",
        fastest_feed=given["feed"] == "fastest",
        feed_limit=given["feed_limit"],
        feeds_as_programmed=True,
        demands=DEMANDS if given["strict"] else (),
    )


def _repeated(
    on: VerifiedMachine, read: ReadProgram, given: VerifyArguments
) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Return the settings of the post that are given again, and those of single operations by their names."""
    texts = given["settings"]
    if not texts:
        return {}, {}
    control = on.control or load_control(on.machine.control)
    program, own = split_by_operation(as_texts(texts), control, on.machine)
    check_settings(program, control, on.machine)
    check_operation_names(own, program, [each.name for toolpath in read.toolpaths for each in toolpath.operations])
    return program, own


def _work_offsets(
    text: str | None, control: Control | None, toolpaths: Sequence[Toolpath]
) -> tuple[str | None, dict[str, str]]:
    """Return the work offset that is given for all operations, and those of single operations by their names."""
    if control is None or text is None:
        return text, {}
    values = list(control.values_by_operation("work_offset", str(text)))
    own = {name: value for name, value in values if name}
    if not own:
        return text, {}
    names = [operation.name for toolpath in toolpaths for operation in toolpath.operations]
    check_operation_names({name: {"work_offset": ""} for name in own}, {}, names)
    return next((value for name, value in values if not name), None), own


def tolerances(
    on: VerifiedMachine, read: ReadProgram, given: VerifyArguments
) -> Tolerances | Callable[[Operation], Tolerances]:
    """How far the program may be off; by default as much more in tilted planes as is rounded there.

    Feeds may be off by half of the last digit that the control prints: it is 1 mm/min on some.
    """
    found = _in_planes(on.control, read, given)
    pair = on.control.formats.get("feed") if on.control else None
    if pair is None:
        return found
    if pair.inch and read.run.state.inches.values.any():
        pair = pair.inch
    feed = max(Tolerances().feed, *(0.5 * each.digit + _SLACK for each in (pair.five_axis, pair.three_axis)))
    if isinstance(found, Tolerances):
        return replace(found, feed=feed)
    return lambda operation: replace(found(operation), feed=feed)


def _in_planes(
    control: Control | None, read: ReadProgram, given: VerifyArguments
) -> Tolerances | Callable[[Operation], Tolerances]:
    tolerance = given["tolerance"]
    chord = control.arcs.chord_tolerance if control else _READ_CHORD
    chord = max(chord, tolerance) if given["span_tip"] is None else given["span_tip"]
    if tolerance != DEFAULT_TOLERANCE:
        return Tolerances(tip=tolerance, angle=tolerance, chord=chord)
    in_inches = bool(read.run.state.inches.values.any())
    tip = _DEFAULT_INCH_TOLERANCE if in_inches else tolerance
    formats = control.formats if control else {}
    pair = formats.get("plane_angle") or formats.get("angle")
    angle = pair.five_axis.digit if pair else tolerance
    # The default is half a digit of inches, and a whole one of millimetres, which most controls have.
    digits = PrintedDigits(2.0 * tip if in_inches else tip, angle)
    return tolerances_in_planes(read.run, Tolerances(tip=tip, angle=tolerance, chord=chord), digits)
