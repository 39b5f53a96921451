"""Verification of any NC program, with or without the CL files that it was made from."""

from dataclasses import replace
from functools import partial
from typing import Unpack

from trunnion import readers, verification
from trunnion.errors import Problem, warning
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.arguments import VerifyArguments, taken
from trunnion.jobs.inputs.arguments import check_observer, check_paths
from trunnion.jobs.inputs.control_settings import written_control
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine
from trunnion.jobs.inputs.stated_setup import LengthLike, ZeroLike, set_up_machine
from trunnion.jobs.inputs.stated_words import with_stated
from trunnion.jobs.inputs.tool_lengths import library_tools, with_lengths_of_tools
from trunnion.jobs.observer import SILENT, Observer, Remembering
from trunnion.jobs.verify.arguments import checked
from trunnion.jobs.verify.expectation import expected, tolerances
from trunnion.jobs.verify.program_warnings import speed_warnings
from trunnion.jobs.verify.reading import ReadProgram, VerifiedMachine, read_program
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.verification import Verification
from trunnion.verification.skip_meanings import with_other_meanings


def verify(
    nc: FilePath | Run, *, machine: MachineLike, observer: Observer = SILENT, **given: Unpack[VerifyArguments]
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
    strict
        Raise an error for unknown statements of the CL files even if the definition says what becomes of them. What the
        proof stands on and nobody has stated or measured fails the check ``basis``.
    frame
        Coordinate system of the program: that of the ``first`` operation, or the CAM's ``absolute`` one.
    zero : (3,) float, mm
        Workpiece zero on the machine; needed to check the travel of the linear axes against their limits.
        ``{"G54": (0, 0, 80), "G55": (150, 0, 80)}`` for each work offset; those without one are not known.
    tool_length
        From the gauge point of the spindle to the tip, mm, of all tools, or ``{"1": 110.0, "2": 85.0}`` of each. Where
        there is none, libraries and CL files may have it.
    tool_libraries, unit
        Tool libraries that have lengths of tools, and the length unit of those that state none.
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
    settings
        Settings that the program was posted with and its CL files do not show, such as
        ``{"same_tool": "clearance", "operation_clearance": 25}``; by default those of the control's definition. And
        values of variables that it reads and does not set, such as ``{"Q13": 10}``.
    assume
        What words do that the reader does not know, as ``[control.known]`` of a definition has it:
        ``{"G65 P9810": "moves nothing"}``. It is believed, and ``standing`` names it.
    radius_register
        What radius compensation works with: ``"difference"``, by how much the tool is larger than in the CL file, or
        ``"radius"``, its radius; by default as the control's definition says.
    cutcom
        What the points under CUTCOM are where the CL files do not say it: those of the tool's ``"centreline"``, which
        is the default, or of the ``"contour"``, where the control has to add the radius.
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
    observer = Remembering(observer)
    found = taken(VerifyArguments, "verify", given)
    stated, settings = with_stated(as_machine(machine), found["settings"], found["assume"])
    found = checked({**found, "settings": settings})
    if (recording := found["recorded"]) is not None:
        from trunnion.jobs.twin.recording import as_recording  # few programs are compared with one

        recording = as_recording(recording)
    on = _set_up(stated, found["zero"], found["tool_length"])
    tools = library_tools(check_paths("tool_libraries", found["tool_libraries"]), found["unit"])
    on = replace(on, machine=with_lengths_of_tools(on.machine, (), tools))
    read = read_program(nc, on, found, observer)
    proof = verification.verify(
        read.run, read.toolpaths, settings=expected(on, read, found), tolerances=tolerances(on, read, found),
        columns=found["columns"],
    )  # fmt: skip
    proof = with_other_meanings(proof, partial(_skipping, on, read, found), has_toolpaths=bool(read.toolpaths))
    proof = replace(proof, clamping=read.clamping)
    observer.problems([*_without_motion(read.run), *speed_warnings(proof)])
    proof = replace(proof, remarks=tuple(observer.found))
    if recording is None:
        return proof
    return verification.with_recording(proof, recording, found["recorded_tolerance"])


def _skipping(
    on: VerifiedMachine, read: ReadProgram, given: VerifyArguments, run: Run, left_out: frozenset[int] | None
) -> Verification:
    """Return the proof of the program with blocks skipped, and the OPSKIP with these numbers; None: by itself."""
    read = replace(read, run=run, toolpaths=[] if left_out is None else read.toolpaths)
    settings = replace(expected(on, read, given), left_out=left_out or frozenset())
    limits = None if left_out is None else tolerances(on, read, given)
    return verification.verify(run, read.toolpaths, settings=settings, tolerances=limits, columns=False)


def _set_up(machine: Machine, zero: ZeroLike | None, tool_length: LengthLike | None) -> VerifiedMachine:
    """Return the machine with its zero and tool; the kernels of its reader are compiled meanwhile."""
    readers.reader_of(machine)
    compile_ahead(kernels.VERIFYING)
    machine = set_up_machine(machine, zero, tool_length)
    return VerifiedMachine(machine, written_control(machine))


def _without_motion(run: Run) -> list[Problem]:
    """Return a warning of a program that moves nothing."""
    if len(run) or run.errors:
        return []
    return [warning(run.files[0], 0, Wording("NC185", "nothing_moves"))]
