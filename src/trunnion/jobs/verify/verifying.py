"""Verification of any NC program, with or without the CL files that it was made from."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, Literal

from trunnion import readers, verification
from trunnion.controls import Control, load_control
from trunnion.controls.setting_rules import tool_number
from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.inputs.arguments import (
    check_choice,
    check_observer,
    check_paths,
    check_whole,
    checked_angles,
    wrong_argument,
)
from trunnion.jobs.inputs.cl_statements import replace_unknown_statements
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike, as_machine, as_run, as_toolpaths
from trunnion.jobs.inputs.settings import (
    check_operation_names,
    check_tolerance,
    m_code,
    set_up_machine,
    work_offset_setting,
)
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.twin.recording import as_recording
from trunnion.jobs.verify.program_warnings import program_warnings
from trunnion.machines import Machine
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.model.clamped_toolpaths import clamped_after, stated_clamping, turned_toolpaths
from trunnion.model.clamping import Clamping
from trunnion.model.recording import Recording
from trunnion.model.run import Run
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.placing.program_heads import stated_place, unlike_cl_files, unlike_zero
from trunnion.verification import (
    ExpectedValues,
    OperationSettings,
    PrintedDigits,
    Tolerances,
    Verification,
    tolerances_in_planes,
)

#: How far the tip may be off its CL point, mm; and in a program in inches, half of 0.0001 inch.
_DEFAULT_TOLERANCE: Final = 0.001
_DEFAULT_INCH_TOLERANCE: Final = 0.0013

#: How far a recorded machine may be off its path, mm and degrees.
DEFAULT_RECORDED_TOLERANCE: Final = 0.05

#: Lines stand for arcs within this, mm, where programs for the control can be read but not written.
_READ_CHORD: Final = 0.001


def verify(
    nc: FilePath | Run,
    *,
    machine: MachineLike,
    cl: ToolpathLike | Iterable[ToolpathLike] = (),
    subprograms: Sequence[FilePath] = (),
    tolerance: float = _DEFAULT_TOLERANCE,
    span: float | None = None,
    span_tip: float | None = None,
    tool: str | int = "",
    work_offset: str | None = None,
    edge: int | str | None = None,
    units: str | None = None,
    dialect: str | None = None,
    frame: Literal["first", "absolute"] = "first",
    zero: str | Iterable[float] | None = None,
    tool_length: str | float | None = None,
    recorded: FilePath | Recording | None = None,
    recorded_tolerance: float = DEFAULT_RECORDED_TOLERANCE,
    feed: Literal["programmed", "fastest"] = "programmed",
    feed_limit: float | None = None,
    columns: bool = True,
    hooks: Sequence[FilePath] = (),
    turn: float = 0.0,
    tilt: float = 0.0,
    observer: Observer = SILENT,
) -> Verification:
    """Verify an NC program: read it, run it, and compare it with the CL files that it was made from.

    Parameters
    ----------
    nc
        The program: a path, or its run (``trunnion.read_program``), which keeps the machine that it was read for.
    machine
        The machine that runs it: a name, a path or a ``Machine``.
    cl
        Its CL files in the order in which they are cut. Without them the program is checked by itself: travel, speeds,
        modal state, words.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    tolerance
        How far coordinates may be off, mm, and rotary axes, degrees. The default is 0.0013 mm for a program in inches,
        half of 0.0001 inch, and wider in tilted planes, by what their origins and angles are rounded.
    span
        How far the tool axis may be off its way between points, degrees; by default as the control's definition says.
    span_tip
        The same for the tip without TCP, and for lines that stand for arcs, mm; the latter by default within the chord
        tolerance of the control's definition.
    tool
        Tool that is called in place of the CL file's.
    work_offset
        Such as ``"G55"``, or ``"G54,TOP:G55"`` with others for single operations of the CL files; by default that of
        the control's definition where there is a CL file.
    edge
        Number of the cutting edge (D); by default that of the control's definition where there is a CL file.
    units
        Length unit of the CL files, ``"mm"`` or ``"inch"``; one that states another is warned of.
    dialect
        What the CL files are written in, as ``read_cl`` has it; by default their content decides.
    frame
        Coordinate system of the program: that of the ``first`` operation, or the CAM's ``absolute`` one.
    zero : (3,) float, mm
        Workpiece zero on the machine; needed to check the travel of the linear axes against their limits.
    tool_length
        From the gauge point of the spindle to the tip, mm; for programs without TCP.
    recorded
        What the machine did: a recording of ``trunnion record``, or its file. Each of its positions is compared with
        the path of the program; with the linear axes in the machine's own coordinates, ``zero`` and ``tool_length`` are
        needed.
    recorded_tolerance
        How far a recorded tip may be off the path, mm, and its tool axis, degrees.
    feed
        ``"fastest"`` for a program that was posted with that setting: its feeds are judged by what the axes reach
        (check ``reach``), not by those of the CL files.
    feed_limit
        The setting ``feed_limit`` of that post, mm/min.
    columns
        Work out the columns of the result, (n,) each: ``seconds``, ``tip_feed`` (mm/min) and ``cl_line``. A report
        needs them; without them a program of any length takes little memory.
    hooks
        The Python files that the program was posted with: they change the CL files as they did then. They are run:
        name none that you have not read.
    turn, tilt
        Of the part, degrees, where it is clamped otherwise than it is drawn, as ``trunnion.post_placed`` posts it:
        first the tilt about X of the program's coordinate system, then the turn about Z, right-handed. The CL files are
        turned so before they are compared.
    observer
        Receives the progress of reading CL files, and warnings about them and about the program.

    Returns
    -------
    Verification
        ``passed``; ``checks`` with their worst values, limits and places; ``run``, the program in columns.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no reader knows the control. A program that is wrong raises
        nothing: its checks have failed.

    Examples
    --------
    >>> import trunnion
    >>> folder = "tests/golden/yl569/"
    >>> found = trunnion.verify(folder + "2_hub_rough.expected.mpf", machine="yl569", cl=folder + "2_hub_rough.cls")
    >>> found.passed
    True
    """
    check_observer(observer)
    check_choice("frame", frame, ("first", "absolute"))
    check_choice("feed", feed, ("programmed", "fastest"))
    limit = _feed_limit(feed_limit, feed)
    if feed == "fastest" and (isinstance(cl, tuple | list) and not cl):
        what = "is fastest, and only CL files say what feeds may be at most"
        raise InputError(argument_problem("feed", what, "name them with cl", code="ARG130"))
    if units is not None:
        check_choice("units", units, ("mm", "inch"))
    tool = _tool(tool)
    edge = None if edge is None else check_whole("edge", edge, 1)
    check_tolerance("tolerance", tolerance)
    check_tolerance("span", span, optional=True)
    check_tolerance("span_tip", span_tip, optional=True)
    check_tolerance("recorded_tolerance", recorded_tolerance)
    hook_files = check_paths("hooks", hooks)
    if hook_files and isinstance(cl, tuple | list) and not cl:
        what, cure = "change CL files, and there are none", "name them with cl"
        raise InputError(argument_problem("hooks", what, cure, code="ARG130"))
    angles = checked_angles(turn, tilt)
    if any(angles) and isinstance(cl, tuple | list) and not cl:
        what, cure = "is that of CL files, and there are none", "name them with cl"
        raise InputError(argument_problem("turn" if angles[0] else "tilt", what, cure, code="ARG130"))
    recording = None if recorded is None else as_recording(recorded)
    loaded = as_machine(machine)
    readers.reader_of(loaded)
    compile_ahead(kernels.VERIFYING)
    loaded = set_up_machine(loaded, zero, tool_length)
    control = written_control(loaded)
    defaults = default_settings(loaded)
    toolpaths = as_toolpaths(cl, units, False, observer, dialect)
    run = as_run(nc, loaded, subprograms)
    observer.problems(program_warnings(run))
    if len(run.normals):
        from trunnion.cl.surface_normals import with_normals

        toolpaths = [with_normals(toolpath) for toolpath in toolpaths]
    if hook_files:
        given = {"tool": tool, "work_offset": work_offset, "edge": edge, "cl_units": units, "dialect": dialect}
        toolpaths = _changed_by_hooks(toolpaths, hook_files, loaded, control, given)
    toolpaths = replace_unknown_statements(toolpaths, control, loaded)
    stated, clamped = stated_clamping(toolpaths), None
    if toolpaths:
        clamped = clamped_after(stated, angles, toolpaths[0].file)
        toolpaths = turned_toolpaths(toolpaths, *angles, absolute=frame == "absolute")
    if not isinstance(nc, Run):
        program, turned_by = Path(nc), Clamping(*angles)
        observer.problems(
            unlike_zero(program, loaded)
            if clamped is None
            else unlike_cl_files(program, turned_by, clamped, stated, loaded)
        )
        clamped = clamped or stated_place(program).clamping
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    if edge is None and toolpaths and "edge" in defaults:
        edge = int(defaults["edge"])
    offset, by_operation = _work_offsets(work_offset, loaded, control, toolpaths)
    found = verification.verify(
        run,
        toolpaths,
        tolerances=_with_feed_digit(
            _tolerances(run, tolerance, span_tip, control), control if feed == "fastest" else None
        ),
        settings=ExpectedValues(
            tool=tool,
            work_offset=offset,
            edge=edge,
            by_operation={name: OperationSettings(tool, own, edge) for name, own in by_operation.items()},
            span=span,
            span_tip=span_tip,
            absolute=frame == "absolute",
            rapid_feed=rapid_feed_of(loaded),
            below_rapid_feed=below_rapid_feed(rapid_feed_of(loaded), control),
            rigid_tap=m_code(defaults.get("rigid_tap", "")),
            blocks_in_compensation=control.blocks_in_compensation if control else 1,
            stops_in_compensation=control.stops_in_compensation if control else False,
            axis_tolerance=control.axis_tolerance if control else AxisTolerance(),
            fastest_feed=feed == "fastest",
            feed_limit=limit,
            feeds_as_programmed=True,
        ),
        columns=columns,
    )
    found = replace(found, clamping=clamped)
    if not len(run) and not run.errors:
        what, cure = "there is no motion in it: nothing of a path was checked", "give the program that moves the tool"
        observer.problems([Problem(run.files[0], 0, what, cure, Severity.WARNING, code="NC185")])
    return found if recording is None else verification.with_recording(found, recording, recorded_tolerance)


def _changed_by_hooks(
    toolpaths: list[Toolpath],
    files: Sequence[Path],
    machine: Machine,
    control: Control | None,
    settings: Mapping[str, str | int | None],
) -> list[Toolpath]:
    """What hooks make of toolpaths; they see the settings that are given."""
    from trunnion.hooks.calling import Hooks
    from trunnion.hooks.files import load_hooks  # few verifications have hooks

    texts = {name: str(value) for name, value in settings.items() if value not in (None, "")}
    return Hooks(load_hooks(files), machine.name, control.name if control else "", texts).change(toolpaths)


def _with_feed_digit(
    tolerances: Tolerances | Callable[[Operation], Tolerances], control: Control | None
) -> Tolerances | Callable[[Operation], Tolerances]:
    """Tolerances that allow for the last digit of a feed that the control prints, if there is one."""
    if control is None:
        return tolerances
    digit = 0.5 * control.formats["feed"].five_axis.digit
    if isinstance(tolerances, Tolerances):
        return replace(tolerances, feed=digit)
    return lambda operation: replace(tolerances(operation), feed=digit)


def _feed_limit(limit: float | None, feed: str) -> float | None:
    """A feed limit, checked."""
    if limit is None:
        return None
    if feed != "fastest":
        raise InputError(
            argument_problem("feed_limit", "is for feed=fastest only", "write feed=fastest too", code="ARG130")
        )
    if isinstance(limit, bool) or not isinstance(limit, int | float) or not 0.0 < limit < math.inf:
        raise InputError(
            argument_problem("feed_limit", f"is {limit!r}", "write a number above 0, mm/min", code="ARG220")
        )
    return float(limit)


def _tolerances(
    run: Run, tolerance: float, span_tip: float | None, control: Control | None
) -> Tolerances | Callable[[Operation], Tolerances]:
    """How far coordinates and angles may be off; by default as much more in tilted planes as is rounded there."""
    chord = control.arcs.chord_tolerance if control else _READ_CHORD
    chord = max(chord, tolerance) if span_tip is None else span_tip
    if tolerance != _DEFAULT_TOLERANCE:
        return Tolerances(tip=tolerance, angle=tolerance, chord=chord)
    in_inches = bool(run.state.inches.values.any())
    tip = _DEFAULT_INCH_TOLERANCE if in_inches else tolerance
    formats = control.formats if control else {}
    pair = formats.get("plane_angle") or formats.get("angle")
    angle = pair.five_axis.digit if pair else tolerance
    # The default is half a digit of inches, and a whole one of millimetres, which most controls have.
    digits = PrintedDigits(2.0 * tip if in_inches else tip, angle)
    return tolerances_in_planes(run, Tolerances(tip=tip, angle=tolerance, chord=chord), digits)


def _tool(tool: object) -> str:
    """The tool that is called in place of the CL file's, as a run names it; empty for none."""
    text = str(tool).strip('"') if isinstance(tool, str | int) and not isinstance(tool, bool) else None
    if text is None or tool_number(text) == 0 or text.startswith("-"):
        raise wrong_argument("tool", tool, "give the number of a tool, such as 5, or its name")
    return text


def default_settings(machine: Machine) -> Mapping[str, str]:
    """The settings of a control's definition; usual ones where its programs can be read but not written."""
    control = written_control(machine)
    return control.settings if control else {"edge": "1"}


def written_control(machine: Machine) -> Control | None:
    """The control of a machine; None where its programs can be read but not written."""
    try:
        return load_control(machine.control.unread_copy())
    except InputError:
        return None


def below_rapid_feed(feed: float | None, control: Control | None) -> float | None:
    """The feed that cuts at the feed of rapids have instead, mm/min; None where rapids are written as rapids."""
    return None if feed is None or control is None else feed - control.formats["feed"].five_axis.digit


def rapid_feed_of(machine: Machine) -> float | None:
    """The feed at which lines are rapids on a machine, mm/min; None where rapids are written as rapids."""
    feed = default_settings(machine).get("rapid_feed")
    return float(feed) if feed else None


def _work_offsets(
    text: str | None, machine: Machine, control: Control | None, toolpaths: Sequence[Toolpath]
) -> tuple[int | None, dict[str, int | None]]:
    """The work offset that a program must have (None: any, the same throughout), and those of single operations."""
    if text is None and not toolpaths:
        return None, {}
    values = list(control.values_by_operation("work_offset", str(text))) if control and text is not None else []
    own = {name: work_offset_setting(value, machine) for name, value in values if name}
    if own:
        names = [operation.name for toolpath in toolpaths for operation in toolpath.operations]
        check_operation_names({name: {"work_offset": ""} for name in own}, {}, names)
        text = next((value for name, value in values if not name), None)
    default = default_settings(machine).get("work_offset", "G54")
    return work_offset_setting(default if text is None else str(text), machine), own
