"""Which machines can run CL files or an NC program, and which of them best."""

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Final, Unpack

import numpy as np

from trunnion.definitions import load_table
from trunnion.errors import InputError, MissingExtraError, Problem, Severity, TrunnionError, argument_problem
from trunnion.jobs.arguments import FitArguments, taken
from trunnion.jobs.convert.converting import convert
from trunnion.jobs.describe.assumptions import assumed_places
from trunnion.jobs.inputs.arguments import check_paths, wrong_argument
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike, as_machine, as_toolpaths, stated_reading
from trunnion.jobs.inputs.stated_setup import LengthLike, set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.place.placing import place, unknown_length
from trunnion.jobs.place.posting import post_placed
from trunnion.jobs.post.posting import post
from trunnion.jobs.post.result import PostResult
from trunnion.machines import Machine, shipped_machines
from trunnion.machines.loading import is_example, machine_library
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, phrase, texts
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.placing.placement import AxisUse, Placement
from trunnion.records import dataclass
from trunnion.results import Figure
from trunnion.verification.results import durations

#: Arguments that are the same for all machines: what is wrong with one is no reason of a machine.
_OF_ALL: Final = ("tool_length", "turns")

#: Codes of a name that is no machine, and of a file that is missing.
_NOT_THERE: Final = ("DEF110", "FIL110")

#: The phrase of a reason that a tool without a known length leaves open.
_LENGTH: Final = "give_its_length"

#: Problems of a machine that are told.
_MOST: Final = 3


class FitStatus(StrEnum):
    """Whether a machine can run it; OPEN where the definition leaves open how far linear axes go."""

    FITS = "fits"
    OPEN = "open"
    NOT = "does not fit"


@dataclass(frozen=True, slots=True)
class AxisMargin:
    """What is left to the nearer limit of an axis, mm or degrees; infinite where there is none."""

    axis: str
    unit: str
    margin: Annotated[float, Figure("left", decimals=6)]


@dataclass(frozen=True, slots=True, eq=False)
class MachineFit:
    """What one machine makes of it.

    key        of the definition, or as it was named where that cannot be loaded
    status     whether it can run it
    why        why not, or what is left open; ``reasons`` are the sentences
    seconds    time of the proven program; None: there is none, or its time is not known
    margins    of the linear axes at the place that was found, and of the rotary axes at feed
    missing    how far the linear axes are from reaching it at the best place, mm; None where that is not the reason
    zero_mm    workpiece zero of the best place, machine frame; None: there is no place, or it was not looked for
    turn_deg   turn of the part there, about Z
    unmeasured  values of the definition that this stands on, though nobody has measured them
    """

    key: Annotated[str, Figure("machine", take=lambda key: Path(key).as_posix() if key.endswith(".toml") else key)]
    status: FitStatus
    why: Annotated[tuple[Wording, ...], Figure("reasons", take=texts)] = ()
    seconds: Annotated[float | None, Figure(decimals=3)] = None
    margins: Annotated[tuple[AxisMargin, ...], Figure(after="missing_mm")] = ()
    missing: Annotated[float | None, Figure(unit="mm", decimals=6, after="turn_deg")] = None
    zero_mm: Vector | None = None
    turn_deg: float | None = None
    unmeasured: Annotated[tuple[Wording, ...], Figure("not_measured", take=texts)] = ()

    @property
    def not_measured(self) -> tuple[str, ...]:
        """The values that nobody has measured, in words."""
        return texts(self.unmeasured)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why not, or what is left open, in sentences."""
        return texts(self.why)

    @property
    @Figure(after="status")
    def is_example(self) -> bool:
        """Whether it is a shipped definition of no builder's machine, whose numbers are examples."""
        return is_example(self.key)


def fit(
    files: Iterable[ToolpathLike] | ToolpathLike, *, observer: Observer = SILENT, **given: Unpack[FitArguments]
) -> tuple[MachineFit, ...]:
    """Tell which machines can run CL files or an NC program, the best first.

    Parameters
    ----------
    files
        CL files, which ``trunnion.post`` would make one program of; with ``machine``, one NC program.
    machines
        Which machines are asked: ``"all"`` shipped ones, names and files with commas between them, or a list of them.
    machine
        The machine that the NC program is for; it is converted into CL data first.
    subprograms
        Files of the subprograms that the NC program calls.
    zero : (3,) float, mm
        Workpiece zero of the NC program on its own machine, where it moves linear axes to positions of the machine.
    tool_length
        Of the tool, gauge point to tip, mm, on all machines, or ``{"1": 110.0, "2": 85.0}`` of each tool; by default
        the greatest that the CL files state for tools in the spindle. Where none is known the answer is open at best.
    units, dialect, strict
        How the CL files are read, as ``trunnion.read_cl`` has it.
    settings
        The same, as for ``trunnion.post``: ``cutcom``, ``open_cycle``, ``spline_tolerance``.
    hooks
        Python files that change the CL files, as for ``trunnion.post``. They are run, on each machine anew.
    turns
        The part is tried at every so many degrees about Z, 5 by default; or the turns themselves, as for
        ``trunnion.place``.
    observer
        Receives the progress and warnings about the files.

    Returns
    -------
    tuple of MachineFit
        Machines that can run it by the time of the proven program, then those whose definitions leave something open,
        then the others by what is missing, each with its reasons. In each of these, examples of machines come last.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or a name is no machine. What is wrong with a machine is its reason.
    RefusedError
        When the NC program has words that are not understood.

    Notes
    -----
    On each machine the part is placed (``trunnion.place``), and posted there with its proof.

    Examples
    --------
    >>> import trunnion
    >>> hub = "tests/golden/yl569/2_hub_rough.cls"
    >>> found = trunnion.fit(hub, machines="yl569,hs664rt", turns=[0.0], tool_length=120.0)
    >>> [(each.key, str(each.status)) for each in found]
    [('yl569', 'fits'), ('hs664rt', 'open')]
    """
    stated = taken(FitArguments, "fit", given)
    check_paths("hooks", stated["hooks"])
    asked, tool_length = _asked(stated["machines"]), stated["tool_length"]
    _check_are_there(asked)
    toolpaths = _toolpaths(files, stated, observer)
    if tool_length is None:
        tool_length = _stated_length(toolpaths)
    found = []
    with observer.progress("fit", len(asked), "machines") as advance:
        for each in asked:
            found.append(_fit(each, toolpaths, tool_length, stated))
            advance(1)
    if tool_length is None and any(reason.variant == _LENGTH for each in found for reason in each.why):
        observer.problems(
            (argument_problem("tool_length", Wording("PLC210", "fits_depend_on_length"), severity=Severity.WARNING),)
        )
    return tuple(sorted(found, key=_rank))


def _rank(each: MachineFit) -> tuple[int, bool, float, float]:
    """Machines that can run it first, of them examples last; the fastest first, of like ones that with most room."""
    order = list(FitStatus).index(each.status), each.is_example
    if each.status is FitStatus.NOT:
        return *order, math.inf if each.missing is None else each.missing, 0.0
    room = min((margin.margin for margin in each.margins if margin.unit == "mm"), default=0.0)
    return *order, math.inf if each.seconds is None else round(each.seconds, 1), -room


def _asked(machines: str | Iterable[MachineLike]) -> list[MachineLike]:
    """Return the machines that are asked, each once."""
    if isinstance(machines, str):
        names = shipped_machines() if machines == "all" else [name.strip() for name in machines.split(",")]
        asked: list[MachineLike] = [name for name in dict.fromkeys(names) if name]
    elif isinstance(machines, Iterable) and not isinstance(machines, bytes):
        asked = list(machines)
    else:
        raise wrong_argument("machines", machines, phrase("give_machines"))
    if not asked or not all(isinstance(each, str | os.PathLike | Machine) for each in asked):
        raise wrong_argument("machines", machines, phrase("give_machines"))
    return asked


def _check_are_there(asked: Sequence[MachineLike]) -> None:
    """Raise ``InputError`` with every name that is no machine and every file that is missing."""
    problems: list[Problem] = []
    for each in asked:
        try:
            as_machine(each, "machines")
        except InputError as error:
            named = "" if isinstance(each, Machine) else os.fspath(each)
            problems += [one for one in error.problems if (one.file, one.line) == (named, 0) and one.code in _NOT_THERE]
    if problems:
        raise InputError(problems)


def _toolpaths(
    files: Iterable[ToolpathLike] | ToolpathLike, stated: FitArguments, observer: Observer
) -> list[Toolpath]:
    subprograms, zero = check_paths("subprograms", stated["subprograms"]), stated["zero"]
    if stated["machine"] is not None:
        _check_for_cl(stated)
        given = [files] if isinstance(files, str | os.PathLike) else list(files) if isinstance(files, Iterable) else []
        if len(given) != 1 or not isinstance(given[0], str | os.PathLike):
            raise InputError(argument_problem("files", Wording("ARG130", "machine_of_one_program")))
        converted = convert(
            given[0], machine=stated["machine"], to_cl=True, subprograms=subprograms, zero=zero,
            tool_length=stated["tool_length"], observer=observer,
        )  # fmt: skip
        return [converted.toolpath]
    if subprograms or zero is not None:
        name = "subprograms" if subprograms else "zero"
        raise InputError(argument_problem(name, Wording("ARG130", "only_for_programs")))
    toolpaths = as_toolpaths(files, observer, stated_reading(stated["settings"], stated["strict"]))
    if not any(len(operation.moves) for path in toolpaths for operation in path.operations):
        raise InputError(argument_problem("files", Wording("ARG130", "no_motion_in_files")))
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    return toolpaths


def _check_for_cl(stated: FitArguments) -> None:
    """Refuse what says how CL files are read where an NC program is asked about."""
    for name in ("units", "dialect", "strict", "settings"):
        if stated[name]:
            raise InputError(argument_problem(name, Wording("ARG130", "only_for_cl_files")))


def _stated_length(toolpaths: Sequence[Toolpath]) -> float | None:
    """Return the greatest length of a tool in the spindle, mm; None if one that moves has none."""
    lengths = [each.tool.set_length for path in toolpaths for each in path.operations if len(each.moves)]
    return max(lengths) if lengths and min(lengths) > 0.0 else None


def _fit(
    asked: MachineLike,
    toolpaths: Sequence[Toolpath],
    tool_length: LengthLike | None,
    stated: FitArguments,
) -> MachineFit:
    """Return what a machine makes of it; whatever is wrong with the machine is its reason."""
    key, hooks = asked.key if isinstance(asked, Machine) else os.fspath(asked), stated["hooks"]
    try:
        machine = set_up_machine(as_machine(asked, "machines"), None, tool_length)
        if not np.isfinite(machine.limits[list(machine.linear)]).any():
            return _without_limits(machine, toolpaths, hooks)
        found = place(toolpaths, machine=machine, turns=stated["turns"], hooks=hooks)
    except TrunnionError as error:
        if any(problem.argument in _OF_ALL for problem in error.problems):
            raise
        return _does_not_fit(error, key)
    if not found.fits:
        return replace(_beyond(asked, machine, found), unmeasured=found.unmeasured)
    margins = tuple(AxisMargin(each.axis, "mm", each.margin_mm) for each in found.best.axes) if found.best else ()
    # The placement and the program are let go: of a long path they are large, and there are many machines.
    place_of = found.zero_mm, found.turn_deg
    try:
        posted = post_placed(found, machine=machine, hooks=hooks)
    except TrunnionError as error:
        return replace(_does_not_fit(error, machine.key, margins), zero_mm=place_of[0], turn_deg=place_of[1])
    reasons = _open_reasons(machine)
    status = FitStatus.OPEN if reasons else FitStatus.FITS
    margins += _rotary_margins(machine, posted)
    values = tuple(dict.fromkeys((*found.unmeasured, *_unmeasured(posted))))
    return MachineFit(machine.key, status, reasons, _seconds(posted), margins, None, *place_of, values)


def _without_limits(machine: Machine, toolpaths: Sequence[Toolpath], hooks: Sequence[FilePath]) -> MachineFit:
    """On a machine whose linear axes have no limits only rotary axes and the control can be judged."""
    try:
        posted = post(toolpaths, machine=machine, hooks=hooks)
    except TrunnionError as error:
        return _does_not_fit(error, machine.key)
    margins = _rotary_margins(machine, posted)
    fits = MachineFit(machine.key, FitStatus.OPEN, _open_reasons(machine), _seconds(posted), margins)
    return replace(fits, unmeasured=_unmeasured(posted))


def _does_not_fit(error: TrunnionError, key: str, margins: tuple[AxisMargin, ...] = ()) -> MachineFit:
    """Return what an error says of a machine; without a package there is nothing to say of any."""
    if isinstance(error, MissingExtraError):
        raise error
    return MachineFit(key, FitStatus.NOT, _reasons(error), None, margins)


def _unmeasured(posted: PostResult) -> tuple[Wording, ...]:
    return () if posted.standing is None else posted.standing.grounds.unmeasured


def _open_reasons(machine: Machine) -> tuple[Wording, ...]:
    names = [machine.names[k] for k in machine.linear if not machine.axes[k].has_limits]
    limits = (phrase("no_limits_stated", axes=tuple(names)),) if names else ()
    return limits if len(names) == len(machine.linear) else (*limits, *_length_reasons(machine))


def _length_reasons(machine: Machine) -> tuple[Wording, ...]:
    return tuple(phrase("give_its_length", problem=problem.wording) for problem in unknown_length(machine))


def _beyond(asked: MachineLike, machine: Machine, found: Placement) -> MachineFit:
    """Return a machine whose axes do not reach it at any place."""
    tried = _turns_tried(found)
    if found.best is None:
        obstacles = tuple(turn.why for turn in found.turns if turn.obstacle)
        return MachineFit(machine.key, FitStatus.NOT, (*obstacles[:1], tried))
    beyond = [each for each in found.best.axes if each.margin_mm < 0.0]
    reasons = (*map(_travel_reason, beyond), tried, *_length_reasons(machine))
    missing = -found.best.margin_mm
    too_small = any(_needed(each) > _travel(each) for each in beyond)
    if not too_small and (assumed := _assumed_places(asked, machine)):
        reasons = (phrase("may_fit_with_places", assumed=assumed), *reasons)
        return MachineFit(machine.key, FitStatus.OPEN, reasons, missing=missing)
    margins = tuple(AxisMargin(each.axis, "mm", each.margin_mm) for each in found.best.axes)
    return MachineFit(machine.key, FitStatus.NOT, reasons, None, margins, missing, found.zero_mm, found.turn_deg)


def _assumed_places(asked: MachineLike, machine: Machine) -> Wording | None:
    """Why it is not known where the axes of a machine lie; None if its definition states it."""
    if isinstance(asked, Machine):
        return assumed_places(machine, None)
    return assumed_places(machine, load_table(os.fspath(asked), machine_library(), kind="machine"))


def _turns_tried(found: Placement) -> Wording:
    """At which turns of the part it was tried, with the cure."""
    turns = [turn.turn_deg for turn in found.turns]
    if len(turns) == 1:
        return phrase("tried_at_turn", turn=turns[0])
    return phrase("tried_at_turns", count=len(turns), least=min(turns), most=max(turns))


def _needed(use: AxisUse) -> float:
    return use.greatest_mm - use.least_mm


def _travel(use: AxisUse) -> float:
    return use.high.limit_mm - use.low.limit_mm


def _travel_reason(use: AxisUse) -> Wording:
    """Why the travel of a linear axis is too small, with the lines."""
    travel, needed = _travel(use), _needed(use)
    if needed > travel:
        ends = {"low": f"{use.low.file}:{use.low.line}", "high": f"{use.high.file}:{use.high.line}"}
        return phrase("travel_too_small", axis=use.axis, travel=travel, lacking=needed - travel, **ends)
    end = use.low if use.low.limit_mm - use.least_mm > use.greatest_mm - use.high.limit_mm else use.high
    return phrase(
        "beyond_limit_at_best", axis=use.axis, beyond=-use.margin_mm, limit=end.limit_mm, at=f"{end.file}:{end.line}"
    )


def _rotary_margins(machine: Machine, posted: PostResult) -> tuple[AxisMargin, ...]:
    run = posted.run
    if run is None or not (run.kind != Kind.RAPID).any():
        return ()
    margins = []
    for column in machine.own_rotary:
        axis, values = machine.axes[column], run.joints[run.kind != Kind.RAPID, column]
        room = math.inf if axis.endless else min(float(values.min()) - axis.low, axis.high - float(values.max()))
        margins.append(AxisMargin(axis.name, "deg", room))
    return tuple(margins)


def _seconds(posted: PostResult) -> float | None:
    """Time of the proven program; None where nothing is known of it."""
    if posted.verification is None:
        return None
    seconds, known = durations(posted.verification)
    return float(seconds.sum()) if known.any() else None


def _reasons(error: TrunnionError) -> tuple[Wording, ...]:
    """Return what was wrong, in sentences; errors before warnings, and not what only sums them up."""
    errors = [each for each in error.problems if each.severity is Severity.ERROR and each.code != "CTL940"]
    return tuple(each.said for each in (errors or list(error.problems))[:_MOST])
