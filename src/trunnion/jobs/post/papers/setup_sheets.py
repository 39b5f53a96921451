"""The setup sheet of a post: what is known of machine, tools, operations and files, and what is left to a person."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from trunnion.errors import Severity
from trunnion.jobs.post.operation_setups import setup_notices
from trunnion.jobs.post.papers import MADE_BY
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.result import PostResult
from trunnion.machines import Machine
from trunnion.messages import foreign, phrase
from trunnion.model.clamping_notices import PLACED_NOTICES
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.run import NO_OFFSET, Run
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CycleOn,
    Insert,
    Kind,
    Operation,
    Sense,
    SpindleOn,
    Stop,
    Tool,
)
from trunnion.output.compensation_entries import CompensationEntry, entries_at_control, entries_of
from trunnion.output.coordinates.extents import cut_box
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls
from trunnion.reporting.content import collect_content
from trunnion.reporting.html_text import format_number
from trunnion.reporting.page_words import on_sheet, page_words, word
from trunnion.reporting.path_drawing import DrawnBody, path_drawing
from trunnion.reporting.remarks import remark_groups
from trunnion.reporting.setup_sheet import (
    CutRanges,
    SetupSheet,
    SheetFile,
    SheetOperation,
    SheetTool,
    cut_ranges,
    displayed_extent,
)
from trunnion.reporting.text import clean
from trunnion.reporting.usage import OperationUsage
from trunnion.simulation.tools.profile import Role, Section
from trunnion.verification import Verification
from trunnion.wording import one_line

if TYPE_CHECKING:  # imported where a program is simulated
    from trunnion.jobs.simulate.result import SimulationResult

#: Coolants whose words are of the builder of a machine, as people call them.
_OTHER_COOLANTS: Final = {"THRU": "through the tool", "AIR": "air", "TAP": "for tapping"}

#: Kinds of tools, as the words of CL files have them.
_KINDS: Final = {"MILL": "mill", "TCUTTER": "T-cutter", "BARREL": "barrel cutter", "DRILL": "drill"}

#: Warnings of a post that a sheet repeats.
_MOST_WARNINGS = 20


def setup_sheet(
    program: Program,
    job: PostJob,
    result: PostResult,
    verification: Verification,
    files: Sequence[SheetFile],
    bodies: Sequence[DrawnBody] = (),
) -> SetupSheet:
    """Return the sheet of a program that was posted and proven, in the language of the page that is made.

    ``bodies`` are drawn with its path.
    """
    run, machine = verification.run, program.machine
    content = collect_content(replace(verification, program=Path(verification.program).name), program.control.name)
    shown = tuple(displayed_extent(*each) for each in zip(machine.own_axes, content.axes, strict=True))
    content = replace(content, axes=shown)
    calls = ToolCalls(program).calls
    operations = tuple(_operations(program, verification, content.operations, [call for call, *_ in calls]))
    rotary = tuple(machine.names[k] for k in machine.rotary_words)
    return SetupSheet(
        content=content,
        version=MADE_BY,
        title=clean(program.effective_setting("title")),
        part=clean(next((toolpath.part for toolpath in result.toolpaths if toolpath.part), "")),
        may_run=result.passed,
        simulated=None if result.simulation is None else result.simulation.passed,
        offsets=_offsets(run),
        zero=machine.workpiece_zero,
        tool_length=machine.tool_length,
        system=_system(program, job),
        rotary=rotary,
        tools=tuple(_with_bodies(_tools(calls, operations, run, machine), job, result.simulation)),
        operations=operations,
        start=tuple(_start(program, run, operations, rotary)),
        to_check=tuple(clean(one_line(text)) for text in _to_check(program, job, result, run)),
        files=tuple(replace(file, name=clean(file.name)) for file in files),
        picture=path_drawing(run, bodies),
        untimed=_untimed(machine),
    )


def _untimed(machine: Machine) -> str:
    """Return what times leave out because the definition does not state it."""
    left_out = (
        ("rapids", any(axis.rapid is None for axis in machine.own_axes)),
        ("speeding_up", any(axis.acceleration is None for axis in machine.own_axes)),
        ("tool_changes", machine.facts.tool_change_s is None),
    )
    names = tuple(on_sheet(what) for what, is_left_out in left_out if is_left_out)
    return on_sheet("left_out", names=names) if names else ""


def _offsets(run: Run) -> tuple[str, ...]:
    values = [int(value) for value in dict.fromkeys(run.state.work_offset.values.tolist())]
    return tuple(clean(run.work_offset_name(value)) for value in values if value not in (0, NO_OFFSET))


def _zeros_to_set(offsets: Sequence[str], is_placed: bool) -> str:
    """Return what to check of the work offsets of a program."""
    if not offsets:
        return on_sheet("set_machine_placed" if is_placed else "set_machine_zero")
    if len(offsets) == 1:
        return on_sheet("set_offset_placed" if is_placed else "set_offset", name=offsets[0])
    return on_sheet("set_offsets_placed" if is_placed else "set_offsets", names=tuple(offsets[:-1]), last=offsets[-1])


def _check_of_zeros(run: Run, machine: Machine) -> str:
    """Return what to check of the workpiece zeros: limits of the linear axes were proven for those that are known."""
    values = dict.fromkeys(run.state.work_offset.values.tolist())
    unknown = [int(value) for value in values if machine.zeros.get(int(value), machine.workpiece_zero) is None]
    unknown = [value for value in unknown if value not in (0, NO_OFFSET)] if machine.zeros else unknown
    if machine.workpiece_zero is None and not machine.zeros:
        return on_sheet("check_travel")
    names = tuple(clean(run.work_offset_name(value)) for value in unknown)
    return on_sheet("check_zero_of_some", names=names) if names else on_sheet("check_zero")


def _system(program: Program, job: PostJob) -> str:
    if job.options.absolute_frame:
        return on_sheet("absolute_system")
    name = program.motions[0].operation.name
    return clean(on_sheet("system_of", name=name)) if name else on_sheet("system_of_first")


def _operations(
    program: Program, verification: Verification, usages: Sequence[OperationUsage], calls: Sequence[str]
) -> Iterator[SheetOperation]:
    starts = [k for k, motion in enumerate(program.motions) if motion.starts_operation]
    groups = [program.motions[first:end] for first, end in pairwise([*starts, len(program.motions)])]
    rows = zip(groups, verification.operations, usages, calls, strict=True)
    for number, (motions, own, usage, call) in enumerate(rows, 1):
        yield SheetOperation(
            number=number,
            name=clean(own.name),
            method="" if _is_of_holes(motions) else clean(program.method_of(motions[0].operation)),
            mode=", ".join(dict.fromkeys(word(motion.mode.value) for motion in motions)),
            tool=clean(call),
            cl_file=clean(Path(own.cl_file).name),
            seconds=usage.seconds,
            cutting_seconds=usage.cutting_seconds,
            box=_box(motions),
            cuts=_with_asked_coolant(cut_ranges(verification.run, own), motions, program.control.coolant),
            notes=tuple(dict.fromkeys((*_entries(program, motions, call), *_notes(motions)))),
        )


def _entries(program: Program, motions: Sequence[Motion], call: str) -> Iterator[str]:
    """Yield what the operator enters for radius compensation."""
    for each in entries_of(program, motions, call):
        is_radius = each.contour or each.holds == "radius"
        path = word("contour" if each.contour else "tool's centre")
        entry = "enter_radius" if is_radius else "enter_difference"
        yield on_sheet(entry, path=path, value=_entered(each), where=_place_of_entry(each))


def _entered(each: CompensationEntry) -> str:
    """Return what is entered."""
    what, size = word(each.size_name), each.size
    if each.contour or each.holds == "radius":
        return on_sheet("entered_whole", what=what)
    return on_sheet("entered_less", what=what, size=size) if size else on_sheet("entered_less_cam", what=what)


def _place_of_entry(each: CompensationEntry) -> str:
    """Return where it is entered, and when twice that is."""
    place = on_sheet("in_register", number=each.register) if each.register else on_sheet("in_table")
    return on_sheet("twice_if", place=place, condition=each.doubled_if) if each.doubled_if else place


def _notes(motions: Sequence[Motion]) -> Iterator[str]:
    """Yield what a setter must know of an operation: pitches, and where it stops."""
    rpm, sense = 0.0, Sense.CLW
    for event in (event for motion in motions for event in motion.operation.events):
        match event:
            case SpindleOn():
                rpm, sense = event.rpm, event.sense
            case BlockSkip() if event.on:
                yield on_sheet("may_skip")
            case Stop():
                yield on_sheet("optional_stop") if event.optional else on_sheet("stop")
            case CycleOn() if event.mode[:1] == ("TAP",):
                values = dict(event.values)
                per_minute = values.get("MMPM", (0.0,))[0] / rpm if rpm else 0.0
                if pitch := values.get("MMPR", (per_minute,))[0]:
                    hand = "left_hand_pitch" if sense is Sense.CCLW else "pitch"
                    yield on_sheet(hand, pitch=format_number(pitch))


def _with_asked_coolant(cuts: CutRanges, motions: Sequence[Motion], codes: Mapping[str, int]) -> CutRanges:
    """Return ranges with the coolants that the CL file asks for, and that have words of the builder of the machine."""
    asked = {event.kind for motion in motions for event in motion.operation.events if isinstance(event, Coolant)}
    seen = cuts.coolant.split(", ") if cuts.coolant else []
    others = [
        f"{word(said)} ({name}, M{codes[name]})" if name in codes else f"{word(said)} ({name})"
        for name, said in _OTHER_COOLANTS.items()
        if name in asked and said not in seen
    ]
    return replace(cuts, coolant=", ".join((*map(word, seen), *others)))


def _with_bodies(
    tools: Iterable[SheetTool], job: PostJob, simulation: "SimulationResult | None"
) -> Iterator[SheetTool]:
    """Yield tools with what libraries and arguments say of them, where the CL file says nothing."""
    for tool in tools:
        if simulation is not None:
            shape = simulation.tools.get(tool.call)
        else:
            shape = None if job.sheet_tools is None else job.sheet_tools.find(tool.call)
        if shape is None:
            yield tool
            continue
        holder = [section for section in shape.sections if section.role is Role.HOLDER]
        yield replace(
            tool,
            name=tool.name or clean(shape.description or shape.name),
            flute_length=tool.flute_length or shape.flute_length,
            stick_out=tool.stick_out or (holder[0].bottom if holder else 0.0),
            set_length=tool.set_length or (0.0 if shape.is_drawn_only else shape.length),
            holder=tool.holder or ", ".join(map(_holder_piece, holder)),
        )


def _holder_piece(section: Section) -> str:
    """Return a piece of a holder in words, such as ``Ø40 × 50 mm``."""
    widest = max(max(each.start[0], each.end[0]) for each in section.outline)
    return f"Ø{format_number(2.0 * widest)} × {format_number(section.top - section.bottom)} mm"


def _is_of_holes(motions: Sequence[Motion]) -> bool:
    """Whether an operation makes holes, which are neither roughed nor finished."""
    return any(isinstance(event, CycleOn) for motion in motions for event in motion.operation.events)


def _box(motions: Sequence[Motion]) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
    box = cut_box(motions)
    if box is None:
        return None
    (x0, y0, z0), (x1, y1, z1) = box[0].tolist(), box[1].tolist()
    return (x0, y0, z0), (x1, y1, z1)


def _tools(
    calls: Sequence[tuple[str, int, Operation]], operations: Sequence[SheetOperation], run: Run, machine: Machine
) -> Iterator[SheetTool]:
    """Each tool once, in the order in which they are called."""
    tools: dict[str, list[int]] = {}
    for number, (call, _, _) in enumerate(calls):
        tools.setdefault(call, []).append(number)
    for call, used in tools.items():
        _, register, operation = calls[used[0]]
        tool = operation.tool
        stated = machine.set_up_for(call, 0).tool_length
        own_register = register or (int(call) if call.isdecimal() else 0)
        yield SheetTool(
            call=clean(call),
            name=clean(tool.name),
            kind=_kind(tool, [calls[number][2] for number in used]),
            diameter=tool.diameter,
            corner_radius=tool.corner_radius,
            length=tool.length,
            flute_length=tool.flute_length,
            stick_out=tool.extension,
            set_length=tool.set_length or stated or 0.0,
            holder=clean(tool.holder),
            register=own_register if run.uses_length_numbers else 0,
            operations=tuple(number + 1 for number in used),
            seconds=sum(operations[number].cutting_seconds for number in used),
        )


def _kind(tool: Tool, operations: Sequence[Operation]) -> str:
    """Return what a tool is, in words; empty where the CL file does not say.

    CL files call taps and reamers drills as well: one that does not only drill is of unknown kind.
    """
    modes = {event.mode[:1] for each in operations for event in each.events if isinstance(event, CycleOn)}
    if tool.kind == "DRILL" and modes - {("DRILL",)}:
        return ""
    if tool.kind == "MILL" and tool.diameter > 0.0 and abs(2.0 * tool.corner_radius - tool.diameter) < 1e-6:
        return word("ball mill")
    if tool.kind == "DRILL" and tool.tip_angle:
        return on_sheet("drill_with_tip", angle=format_number(tool.tip_angle))
    return word(_KINDS.get(tool.kind, ""))


def _start(program: Program, run: Run, operations: Sequence[SheetOperation], rotary: Sequence[str]) -> Iterator[str]:
    """Yield what stands at the beginning of the program, and where it can be entered."""
    first = operations[0] if operations else None
    if first is not None:
        yield on_sheet("first_tool", tool=first.tool)
    if len(run) and run.machine_frame[0]:
        yield on_sheet("begins_at_machine")
    elif len(run):
        yield on_sheet("begins_at_workpiece")
    cuts = np.flatnonzero(run.kind != Kind.RAPID)
    if len(cuts):
        joints = run.positions(cuts[:1]).joints[0]
        axes = list(zip(rotary, run.machine.rotary_words, strict=True))
        shown = {k: float(run.machine.axes[k].displayed(joints[k : k + 1], 3)[0]) for _, k in axes}
        turned = ", ".join(f"{name} {shown[k] + 0.0:.3f}°" for name, k in axes)
        if turned:
            yield on_sheet("axes_at_first_cut", turned=turned)
    if program.effective_setting("restart") == "on":
        yield on_sheet("enter_anywhere")
    else:
        yield on_sheet("start_at_beginning")


def _to_check(program: Program, job: PostJob, result: PostResult, run: Run) -> Iterator[str]:
    """Yield what the proof cannot see."""
    yield _zeros_to_set(_offsets(run), any(notice.startswith(PLACED_NOTICES) for notice in job.notices))
    for notice in job.notices:
        if notice.startswith(PLACED_NOTICES):
            yield f"{notice}."
    single = list(setup_notices(job, result.toolpaths)) if job.setups or job.settings.get("delta_length") else []
    for notice in dict.fromkeys(single):
        yield on_sheet("check_notice", notice=notice)
    yield _check_of_zeros(run, program.machine)
    if any(motion.mode is MachiningMode.WITHOUT_TCP for motion in program.motions):
        yield on_sheet("measure_without_tcp")
    if entries_at_control(program):
        yield on_sheet("check_compensated_tools")
    else:
        yield on_sheet("check_tools")
    yield on_sheet("check_clamping")
    if result.simulation is None:
        yield on_sheet("no_simulation")
    else:
        yield on_sheet("simulation_knew", count=len(result.simulation.findings))
        if (collisions := result.simulation.collisions_said) is not None:
            yield on_sheet("look_for", what=collisions)
        if (cuts := result.simulation.cuts_said) is not None:
            yield on_sheet("measure", what=cuts)
    yield on_sheet("check_machine")
    inserted = [
        event.text.strip()
        for motion in program.motions
        for event in motion.operation.events
        if isinstance(event, Insert)
    ]
    if inserted:
        texts = "; ".join(dict.fromkeys(inserted))
        yield on_sheet("check_inserts", texts=texts[:300])
    warnings = remark_groups(problem for problem in result.problems if problem.severity is Severity.WARNING)
    for remark in warnings[:_MOST_WARNINGS]:
        more = phrase("more_like_it", count=remark.count - 1) if remark.count > 1 else foreign("")
        yield on_sheet("warning", text=remark.said("what", page_words()), more=more)
    if len(warnings) > _MOST_WARNINGS:
        yield on_sheet("more_warnings", count=len(warnings) - _MOST_WARNINGS)
    for problem in result.problems:
        if problem.severity is Severity.ERROR:
            yield on_sheet("overruled", what=problem.wording)
    yield on_sheet("first_part")
