"""What speaks against a program before it is written: what it would lack, and what its control cannot be told."""

from collections.abc import Callable, Mapping

import numpy as np

from trunnion.controls.definition import Control
from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.controls.vocabulary import HOLES_IN_PLANES, HOLES_SETTING
from trunnion.controls.words import NumberFormat
from trunnion.errors import Problem, Severity
from trunnion.machines import Mount
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOn,
    Dwell,
    Event,
    GoHome,
    Kind,
    LoadTool,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
)
from trunnion.output.coordinates.axis_coordinates import (
    FEED_AT_TIP,
    feed_format,
    feed_rule,
    feed_words,
    to_axis_coordinates,
)
from trunnion.output.coordinates.tool_vectors import first_row_at_other_pose
from trunnion.output.holes.holes_under_tcp import check_holes_under_tcp
from trunnion.output.program import Program, effective_setting, effective_settings, motion_block_words, template_suffix
from trunnion.planning.holes.cycles import (
    Cycle,
    HoleCycleError,
    SpindleState,
    UnsupportedCycleError,
    cycle_feed,
    cycle_from_event,
    spindle_state_at,
)

#: A feed that is off by more than this part of itself for being rounded is told.
_ROUNDING_LIMIT = 0.01


#: Statements about the form of a program that every program meets.
_DEFAULT_MODES = {("SET", "MODE", "ABSOL"), ("MODE", "MILL"), ("MULTAX",), ("MULTAX", "ON")}


def check_program(program: Program) -> list[Problem]:
    """What the program would lack, or what this control cannot yet be told; errors mean that it must not be written."""
    problems = []
    spindle, in_spindle = False, ""
    rpm: float | None = None
    held = SpindleState(1.0, Sense.CLW)  # where nobody says otherwise
    for motion in program.motions:
        operation = motion.operation
        moves = operation.moves
        problems += _hole_problems(program, motion, held)
        held = spindle_state_at(operation.events, len(moves), held) or held
        for event in operation.events:
            rpm = event.rpm if isinstance(event, SpindleOn) else None if isinstance(event, SpindleOff) else rpm
            problems += _event_problems(program, motion, event, rpm)
        if motion.mode is MachiningMode.TCP and program.control.vectors_exclude_angles:
            problems += _tool_vector_problems(program, motion)
        problems += _normal_problems(program, motion)
        if motion.mode is MachiningMode.WITHOUT_TCP and template_suffix(program, motion):
            problems += _problems_without_tcp(program, motion)
        unfed = np.flatnonzero((moves.kind != Kind.RAPID) & ~(moves.feed > 0))
        if len(unfed):
            problems.append(
                Problem(
                    program.file, int(moves.line[unfed[0]]), "cutting motion without a feed", "put FEDRAT before it"
                )
            )
        problems += _rounded_feed_problems(program, motion)
        unsupported = program.control.family.validate_operation(operation, spindle)
        problems += [Problem(program.file, line, why.what, why.cure) for line, why in unsupported]
        if not motion.starts_operation:
            problems += _next_axis_problems(program, motion)
            continue
        spindle = spindle or any(isinstance(e, SpindleOn) for e in operation.events)
        if not spindle:
            what = f"operation {operation.name} has no spindle speed"
            problems.append(Problem(program.file, operation.line, what, "put SPINDL before it", Severity.WARNING))
        loaded = any(isinstance(e, LoadTool) for e in operation.events) or effective_setting(program, "tool")
        stays = not loaded and operation.tool.name == in_spindle
        if not loaded and operation.tool.name and not stays:
            what = f"operation {operation.name} has no LOAD/TOOL; its tool is called by its name"
            problems.append(
                Problem(program.file, operation.line, what, "--set tool=NUMBER calls it by number", Severity.WARNING)
            )
        if operation.tool.name and (not (loaded or stays) or effective_setting(program, "tool_call") == "name"):
            problems += _unsupported(program, operation.line, _call_by_name, program.control, operation.tool.name)
        in_spindle = operation.tool.name
        if not template_suffix(program, motion):
            what = f"operation {operation.name}: {program.control.name} has no words for {motion.mode}"
            problems.append(Problem(program.file, operation.line, what, "--set mode=… sets another mode"))
        tolerance = operation.intol is not None and operation.outtol is not None
        if _needs_tolerance(program, motion) and not tolerance and not effective_setting(program, "tolerance"):
            fallback = effective_setting(program, "fallback_tolerance")
            what = f"operation {operation.name} has no INTOL and OUTTOL; the tolerance becomes {fallback}"
            problems.append(Problem(program.file, operation.line, what, "--set tolerance=…", Severity.WARNING))
    return [*problems, *_block_skip_problems(program)]


def _rounded_feed_problems(program: Program, motion: Motion) -> list[Problem]:
    """The first feed of an operation that prints as none, and the first that its last digit makes quite another one."""
    moves, form = motion.operation.moves, program.control.number_formats(motion.three_axis)["feed"]
    if motion.mode is MachiningMode.WITHOUT_TCP or not len(moves):
        return []
    anew = np.flatnonzero(np.diff(moves.feed, prepend=np.nan) != 0.0)
    said = anew[(moves.kind[anew] != Kind.RAPID) & (moves.feed[anew] > 0.0)]
    each = (_rounding_problem(form, float(moves.feed[k]), bool(moves.per_rev[k])) for k in said.tolist())
    problems = [Problem(program.file, int(moves.line[k]), *why) for k, why in zip(said, each, strict=True) if why]
    return sorted(problems, key=lambda problem: problem.severity is not Severity.ERROR)[:1]


def _rounding_problem(form: NumberFormat, feed: float, per_rev: bool) -> tuple[str, str, Severity] | None:
    """What a format makes of a feed: none, or quite another one; None where it says the feed."""
    printed = round(feed, form.decimals)
    cure = "say it in mm/min (MMPM)" if per_rev else "raise it"
    if printed < form.least:
        return f"a feed of {feed:g} is less than the control can be told", cure, Severity.ERROR
    if abs(printed - feed) > _ROUNDING_LIMIT * feed:
        return f"a feed of {feed:g} prints as {printed:g}", cure, Severity.WARNING
    return None


def _block_skip_problems(program: Program) -> list[Problem]:
    """Operations that end, or turn to another plane, while blocks are marked to be skipped.

    What leads away from an operation is for every run. A turn is not: without it the blocks behind are somewhere else.
    """
    motions = program.motions
    problems: list[Problem] = []
    on: BlockSkip | None = None
    for k, motion in enumerate(motions):
        for event in motion.operation.events:
            if isinstance(event, BlockSkip):
                on = event if event.on else None
        if on is not None and (k + 1 == len(motions) or motions[k + 1].starts_operation):
            what = f"OPSKIP/ON ends with operation {motion.operation.name}: the way home cannot be skipped"
            problems.append(Problem(program.file, on.line, what, "write OPSKIP/OFF", Severity.WARNING))
            on = None
        elif on is not None:
            line = int(motions[k + 1].operation.moves.line[0])
            what = "the tool axis turns to another plane between blocks that may be skipped"
            problems.append(Problem(program.file, line, what, "write OPSKIP/OFF before it, and OPSKIP/ON behind it"))
    return problems


def _next_axis_problems(program: Program, motion: Motion) -> list[Problem]:
    """What is lacking where an operation goes on from home under another tool axis."""
    kind = template_suffix(program, motion)
    if motion.plane is not None or not kind or f"next_axis_{kind}" in program.control.templates:
        return []
    moves, name = motion.operation.moves, program.control.name
    what = f"holes along another axis than the one before, {motion.mode}: {name} is not told how to go on from home"
    cure = f"write the template next_axis_{kind} into the control's definition, or split the operation"
    return [Problem(program.file, int(moves.line[0]), what, cure)]


def _needs_tolerance(program: Program, motion: Motion) -> bool:
    """Whether an operation's beginning depends on its tolerance, and has none of its own."""
    names = "operation_start", f"approach_{template_suffix(program, motion)}"
    templates = [program.control.templates[name] for name in names if name in program.control.templates]
    fields = {name for each in templates for name, _ in each.fields()}
    return "tolerance" in fields and "three_axis_tolerance" not in fields


def _unsupported(program: Program, line: int, say: Callable[..., object], *arguments: object) -> list[Problem]:
    """Why the control cannot say something; empty where it can."""
    try:
        say(*arguments)
    except UnsupportedFeatureError as why:
        return [Problem(program.file, line, why.what, why.cure)]
    return []


def _call_by_name(control: Control, name: str) -> str:
    return control.family.tool_call(0, name, by_name=True)


def _event_problems(program: Program, motion: Motion, event: Event, rpm: float | None) -> list[Problem]:
    operation, control = motion.operation, program.control
    place = program.file, event.line
    rows = len(operation.moves)
    if isinstance(event, Dwell):
        formats = control.number_formats(motion.three_axis)
        return _unsupported(program, event.line, control.family.dwell, event, rpm, formats)
    if isinstance(event, LoadTool) and (event.row > 0 or not motion.starts_operation):
        return [Problem(*place, "tool change within an operation", "begin a new operation with the new tool")]
    if isinstance(event, CutterComp) and event.side == "ON":
        return [Problem(*place, "CUTCOM/ON does not say on which side", "write CUTCOM/LEFT or CUTCOM/RIGHT")]
    if isinstance(event, GoHome) and event.row < rows:
        return [Problem(*place, "GOHOME before the operation's end", "begin a new operation after it")]
    if isinstance(event, SelectTool):
        what = f"SELECT/TOOL,{event.number} is not written: the control is told of a tool when it is changed to"
        return [Problem(*place, what, "INSERT/ says what the tool changer wants", Severity.WARNING)]
    if isinstance(event, SetMode) and event.words not in _DEFAULT_MODES:
        what = f"{event.words[0]}/{','.join(event.words[1:])} is not followed: the control's definition has the form"
        return [Problem(*place, what, "compare the program with what it asks for", Severity.WARNING)]
    if isinstance(event, Coolant) and event.kind not in program.control.coolant:
        known = ", ".join(program.control.coolant)
        return [Problem(*place, f"{program.control.name} has no coolant {event.kind}", f"use one of {known}")]
    return []


def _tool_vector_problems(program: Program, motion: Motion) -> list[Problem]:
    """That an operation is said by rotary positions, though vectors are wanted: why, and where."""
    if not program.control.uses_tool_vectors(program.settings):
        return []
    row = first_row_at_other_pose(program.machine, motion, motion_block_words(program, motion))
    if row < 0:
        return []
    what = "for the tool's vector here the control could choose another rotary position than the planned one: operation"
    what = f"{what} {motion.operation.name} is written with rotary positions"
    cure = "nothing, or orientation=angles, which says so of all operations"
    return [Problem(program.file, int(motion.operation.moves.line[row]), what, cure, Severity.WARNING)]


def _normal_problems(program: Program, motion: Motion) -> list[Problem]:
    """What speaks against saying the surface's normals of an operation, and where it has none."""
    operation, problems = motion.operation, list[Problem]()
    moves = operation.moves
    if moves.normal is None or not np.isfinite(moves.normal).any():
        return []
    place, name = (program.file, operation.line), operation.name
    off = "leave the setting normals out"
    if motion.mode is MachiningMode.WITHOUT_TCP:
        what = f"operation {name}: surface normals without TCP, where X, Y and Z are slides"
        problems.append(Problem(*place, what, off))
    if motion.mode is MachiningMode.TCP and effective_setting(program, "orientation") != "vector":
        what = f"operation {name}: with TCP the control would stand the tool on the surface's normal"
        problems.append(Problem(*place, what, "--set orientation=vector says the tool axis beside it"))
    if len(operation.arcs.row):
        what = "a circle, on which no surface normal can be said: the control would not compensate the tool there"
        problems.append(Problem(program.file, int(moves.line[operation.arcs.row[0]]), what, "output lines only"))
    without = (moves.kind == Kind.LINEAR) & ~np.isfinite(moves.normal[:, 0])
    between = without[:-1] & (moves.line[:-1] == moves.line[1:]) & np.isfinite(moves.normal[1:, 0])
    if between.any():
        what = "a point between CL points, where nobody knows the surface's normal"
        line = int(moves.line[int(np.argmax(between))])
        problems.append(Problem(program.file, line, what, "leave the setting axis_tolerance out"))
    elif without.any():
        what = f"operation {name}: {int(without.sum())} of {len(moves)} points have no contact point"
        how = "the control does not compensate the tool there"
        problems.append(Problem(*place, what, how, Severity.WARNING))
    return problems


def _problems_without_tcp(program: Program, motion: Motion) -> list[Problem]:
    """What cannot be said where nobody holds the tip."""
    operation, problems = motion.operation, []
    moves = operation.moves
    if any(isinstance(event, CutterComp) and event.side != "OFF" for event in operation.events):
        what = "cutter radius compensation without TCP would be that of the slides"
        problems.append(Problem(program.file, operation.line, what, "output the path without CUTCOM"))
    formats = program.control.number_formats(motion.three_axis)
    slides = to_axis_coordinates(program.machine, motion, formats["angle"].decimals)
    cuts = slides.rotary_moves & (moves.kind != Kind.RAPID) & (moves.feed > 0)
    turned = np.flatnonzero(cuts & moves.per_rev)
    if len(turned):
        what = "a feed per revolution without TCP while rotary axes turn"
        problems.append(Problem(program.file, int(moves.line[turned[0]]), what, "output it in mm/min (FEDRAT/MMPM)"))
    rows = np.flatnonzero(cuts)
    rule = feed_rule(program.control, effective_settings(program))
    form = formats[feed_format(rule)]
    _, slow, fast = feed_words(slides.select(rows), moves.feed[rows], rule, form)
    if slow.any():
        row = int(rows[np.argmax(slow)])
        took = slides.tip_length[row] / moves.feed[row]
        what = f"a block takes {took:.0f} minutes; inverse time has room for {1.0 / form.least:g}"
        cure = "output the toolpath with points nearer to each other, or a higher feed"
        if rule != "inverse_time":
            what, cure = f"F of a block would be below {form.least:g}, the least that there is", "ask for a higher feed"
        problems.append(Problem(program.file, int(moves.line[row]), what, cure))
    if fast.any():
        what = f"{int(fast.sum())} blocks so short that F would be above {form.greatest:g}: they take as long as that"
        place = program.file, int(moves.line[rows[np.argmax(fast)]])
        problems.append(Problem(*place, what, "a wider tolerance puts fewer points in", Severity.WARNING))
    heads = [axis.name for axis in program.machine.axes if axis.is_rotary and axis.mount is Mount.TOOL]
    if rule == FEED_AT_TIP and heads:
        what = f"rotary_feed is tip, and {' and '.join(heads)} turns in the head, which the control leaves out"
        problems.append(Problem(program.file, operation.line, what, "leave the setting rotary_feed out"))
    shorter = np.flatnonzero(slides.wraps.any(axis=1))
    if len(shorter) and "primary_shortest" not in program.control.family.WORDS and not program.control.shorter_way:
        what = "a rotary axis goes past the end of the turn that it displays, and would go the longer way"
        cure = 'write output = "none" for the axis in the machine\'s definition'
        problems.append(Problem(program.file, int(moves.line[shorter[0]]), what, cure))
    return problems


def unsupported_cycle_reasons(
    control: Control, settings: Mapping[str, str]
) -> Callable[[Cycle, SpindleState | None], str]:
    """Why a control has no cycle for a hole; empty where it has, or where the CL file leaves something out."""
    known = {**control.settings, **{key: value for key, value in settings.items() if value}}
    formats = control.number_formats(three_axis=True)

    def why(cycle: Cycle, spindle: SpindleState | None) -> str:
        try:
            control.family.cycle_call(cycle, 0.0, spindle, known, formats)
        except UnsupportedCycleError as error:
            return error.what
        except HoleCycleError:
            pass
        return ""

    return why


def _hole_problems(program: Program, motion: Motion, held: SpindleState) -> list[Problem]:
    """What the cycles of a motion ask for and this control cannot be told; ``held``: the spindle before it."""
    if not any(isinstance(event, CycleOn) for event in motion.operation.events):
        return []
    operation, problems = motion.as_written(), list[Problem]()
    moves, settings = operation.moves, effective_settings(program)
    turns = motion.mode is MachiningMode.TCP and program.control.turns_between_holes(settings)
    level = {} if turns else {HOLES_SETTING: HOLES_IN_PLANES}
    told: list[Problem] = []
    for event in operation.events:
        if not isinstance(event, CycleOn):
            continue
        try:
            cycle = cycle_from_event(event)
            if motion.mode in (MachiningMode.TCP, MachiningMode.WITHOUT_TCP) and not turns:
                how = "with TCP" if motion.mode is MachiningMode.TCP else "without TCP"
                what = f"CYCLE/{cycle.method} {how}: no cycle goes along a tilted axis there, and no motion can make it"
                planes = MachiningMode.TILTED in program.control.modes(effective_settings(program))
                cure = (
                    "leave the setting mode out, or end the cut before the tool axis changes"
                    if planes
                    else "clamp the part so that these holes stand along +Z, or post for a control with tilted planes"
                )
                if HOLES_SETTING in settings and motion.mode is MachiningMode.TCP:
                    cure += f", or turn the tool from hole to hole (--set {HOLES_SETTING}=…)"
                raise HoleCycleError(what, cure)
            spindle = spindle_state_at(operation.events, event.row, held)
            formats = program.control.number_formats(motion.three_axis)
            program.control.family.cycle_call(cycle, 0.0, spindle, settings | level, formats)
            feed, per_rev = cycle_feed(cycle, spindle, float(moves.feed[event.row]), False)
            if not feed > 0.0:
                raise HoleCycleError("CYCLE without a feed", "write MMPM,feed, or FEDRAT before it")
            coarse = _rounding_problem(formats["feed"], feed, per_rev) if not cycle.method.startswith("TAP") else None
            if coarse:
                told.append(Problem(program.file, event.line, *coarse))
            low = event.row > 0 and moves.tip[event.row - 1, 2] < moves.tip[event.row, 2] + cycle.rapid_height - 1e-6
            if low and not turns and moves.kind[event.row - 1] != Kind.RAPID:
                cure = "draw the tool back before the cycle"
                raise HoleCycleError("CYCLE while the tool is below the height of RAPTO", cure)
        except HoleCycleError as error:
            problems.append(Problem(program.file, event.line, error.what, error.cure))
    if turns and not problems:
        problems = [Problem(program.file, e.line, e.what, e.cure) for e in check_holes_under_tcp(operation)]
    return [*problems, *told]
