"""``trunnion place``: where on the table a part may sit."""

import argparse
from collections.abc import Iterator
from typing import Final

from trunnion.api.input_files import machine_files
from trunnion.api.placing import place
from trunnion.api.placing_data import placement_data
from trunnion.api.placing_post import post_placed
from trunnion.api.reading import load_machine
from trunnion.cli.cl_files import cl_inputs, named_files
from trunnion.cli.results import as_json, print_result, tell
from trunnion.cli.terminal import Terminal, output_place
from trunnion.errors import InputError, argument_problem
from trunnion.files import atomic_file, check_outputs
from trunnion.placing.placement import AxisUse, Limit, Place, Placement
from trunnion.wording import counted, format_duration, one_line

#: Turns out of reach that are told one by one.
_MOST: Final = 3


def run(arguments: argparse.Namespace) -> int:
    """Place a part; 0 if it fits somewhere, else 1."""
    machine = load_machine(arguments.machine)
    read = [*named_files(arguments.files), *arguments.subprograms, *machine_files(arguments.machine, machine)]
    if arguments.plot is not None:
        from trunnion.api.placing_plot import check_placing_plot

        check_placing_plot(arguments.plot, read)
    targets = (arguments.json, arguments.apply, arguments.plot)
    if arguments.json == arguments.apply == "-":
        what, cure = "go to stdout both", "let one of them go to a file"
        raise InputError(argument_problem("json", f"and apply {what}", cure, code="ARG140"))
    check_outputs([target for target in targets if target not in (None, "-")], read)
    settings = dict(arguments.settings)
    length = arguments.tool_length or settings.get("tool_length")
    found = place(
        cl_inputs(arguments.files),
        machine=machine,
        goal=arguments.goal,
        turns=arguments.only or arguments.turns,
        zero=arguments.zero or settings.get("zero"),
        tool_length=length,
        settings=settings,
        subprograms=arguments.subprograms,
        observer=Terminal(),
    )
    lines = tell if arguments.apply == "-" else print_result
    if arguments.json == "-":
        print_result(as_json(placement_data(found)))
    else:
        lines(*map(one_line, placement_lines(found)))
    if arguments.json not in (None, "-"):
        with atomic_file(arguments.json, inputs=read) as stream:
            stream.write((as_json(placement_data(found)) + "\n").encode())
    if arguments.plot is not None:
        from trunnion.api.placing_plot import write_placing_plot

        write_placing_plot(found, arguments.plot, inputs=read)
    if arguments.apply is not None and found.fits:
        settings = settings if length is None else {**settings, "tool_length": length}
        output = output_place(arguments.apply)
        post_placed(found, machine=machine, output=output, settings=settings, observer=Terminal())
    return 0 if found.fits else 1


def placement_lines(found: Placement) -> Iterator[str]:
    """A placement in lines."""
    best, present = found.best, found.present
    if best is None:
        yield f"{found.machine}: the rotary axes reach the path at no turn"
        for turn in found.turns[:_MOST]:
            yield f"  turned {turn.turn_deg:g} degrees: {turn.obstacle}"
        return
    if not best.fits:
        off = f"{-best.margin_mm:.3f} mm too far at the least"
        yield f"{found.machine}: the part fits nowhere: {off}, at {_point(best)}, turned {best.turn_deg:g} degrees"
    else:
        left = f"{best.margin_mm:.3f} mm to the limits"
        yield f"{found.machine}: best zero {_point(best)}, turned {best.turn_deg:g} degrees: {left}"
    for axis in best.axes:
        yield f"  {_use(axis)}"
    if found.limits:
        what = "it is held by" if best.fits else "these conflict:"
        yield f"  {what} {'; '.join(dict.fromkeys(map(_limit, found.limits)))}{_overlap(found)}"
    if present is not None:
        gain = best.margin_mm - present.margin_mm
        state = f"{present.margin_mm:.3f} mm to the limits" if present.fits else f"{-present.margin_mm:.3f} mm too far"
        gained = "" if found.goal != "margin" else f"; the best place has {gain:.3f} mm more"
        yield f"  present zero {_point(present)}: {state}{gained}"
    if found.goal != "margin" and best.value is not None:
        now = "" if present is None else f"; at the present zero {_number(found.goal, present)}"
        yield f"  {_value(found.goal, best)}{now}"
    fitting = sum(turn.fits for turn in found.turns)
    yield f"  it fits at {fitting} of {counted(len(found.turns), 'turn')}"
    if found.region is not None:
        ends = (
            f"{name} {low:.3f} to {high:.3f}"
            for name, low, high in zip("XYZ", found.region.low, found.region.high, strict=True)
        )
        yield f"  at this turn the zero may be within {', '.join(ends)}"


def _point(place: Place) -> str:
    return ",".join(f"{value:.3f}" for value in place.zero_mm)


def _overlap(found: Placement) -> str:
    """How much travel is missing, where both limits of one slide conflict and nothing else does."""
    ends = {(limit.axis, limit.end) for limit in found.limits}
    if found.fits or found.best is None or len(ends) != 2 or len({axis for axis, _ in ends}) > 1:
        return ""
    return f"; {found.limits[0].axis} needs {-2.0 * found.best.margin_mm:.3f} mm more travel"


def _value(goal: str, place: Place) -> str:
    """The value of a goal in words."""
    what = {
        "rotary": "the rotary axes turn",
        "slides": "the slides travel",
        "time": "at the speeds of the axes it takes",
        "overspeed": "the axes do not reach the feed in",
    }
    return f"{what[goal]} {_number(goal, place)}"


def _number(goal: str, place: Place) -> str:
    value = place.value or 0.0
    if goal == "time":
        return format_duration(value)
    return (
        counted(round(value), "row")
        if goal == "overspeed"
        else f"{value:.1f} {'degrees' if goal == 'rotary' else 'mm'}"
    )


def _use(axis: AxisUse) -> str:
    text = f"{axis.axis} {axis.least_mm:.3f} to {axis.greatest_mm:.3f}"
    if axis.low.limit_mm == -float("inf") and axis.high.limit_mm == float("inf"):
        return f"{text}, no limits stated"
    left = f"{axis.margin_mm:.3f} left" if axis.margin_mm >= 0.0 else f"{-axis.margin_mm:.3f} too far"
    return f"{text} of {axis.low.limit_mm:g} to {axis.high.limit_mm:g}: {left}"


def _limit(limit: Limit) -> str:
    return f"{limit.axis} at {limit.limit_mm:g} ({limit.file}:{limit.line})"
