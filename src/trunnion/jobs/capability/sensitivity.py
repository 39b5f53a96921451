"""Where the tool goes over a program when a number of the machine's geometry is not what its definition says."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final, Unpack

import numpy as np

from trunnion.capability.sensitivity import Sensitivity, program_sensitivity
from trunnion.capability.tip_errors import joints_at_zero
from trunnion.errors import InputError, Problem, Severity
from trunnion.jobs.arguments import SensitivityArguments, taken
from trunnion.jobs.inputs.arguments import check_observer, wrong_argument
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine, as_run
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.machines import Machine
from trunnion.machines.unmeasured import POSITIONS, unmeasured_values
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.model.run_samples import joint_samples
from trunnion.verification.grounds import grounds_of

#: The most that they may be off: derivatives tell small errors only.
_MOST: Final = {"length": 10.0, "angle": 3600.0}


def sensitivity(
    nc: FilePath | Run, *, machine: MachineLike, observer: Observer = SILENT, **given: Unpack[SensitivityArguments]
) -> Sensitivity:
    """Tell how far the tip is off over a program for each geometry number of the machine that is not true.

    Parameters
    ----------
    nc
        The program: a path, or its run (``trunnion.read_program``), which keeps the machine that it was read for.
    machine
        The machine that runs it: a name, a path or a ``Machine``.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    zero : (3,) float, mm
        Workpiece zero on the machine. The errors of directions, and on tables those of points, depend on it.
    tool_length
        From the gauge point of the spindle to the tip, mm.
    length
        How far points, lengths and zeros are off, mm.
    angle
        How far directions and displayed angles are off, seconds of arc.
    zero_at
        Where the rotary axes stood when the workpiece zero was set by the tool or a probe: ``home``, or their values in
        degrees, such as ``"C=0,B=30"`` or a mapping. What the error is there is then in the zero, and only the rest of
        it is at the tip. ``none`` or None: nothing was set.
    observer
        Receives the progress.

    Returns
    -------
    Sensitivity
        Each number with its largest error over the program and the place of it, the worst first.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or the program has no motion at feed.

    Notes
    -----
    The control works out axis values with the numbers of the definition, and the iron has others: the tip is off by the
    derivative of the forward map with respect to the number, times its error. Motions are judged at their ends, and
    within arcs and turns at least every 5 degrees.

    Examples
    --------
    >>> import trunnion
    >>> file = "tests/golden/yl569/3_blade_finish.expected.mpf"
    >>> found = trunnion.sensitivity(file, machine="yl569", zero=(0, 0, 100), tool_length=120)
    >>> found.numbers[0].number.name
    'gauge point X'
    """
    check_observer(observer)
    stated = taken(SensitivityArguments, "sensitivity", given)
    for name in _MOST:
        _check_amount(name, stated.get(name))
    run = as_run(nc, set_up_machine(as_machine(machine), stated["zero"], stated["tool_length"]), stated["subprograms"])
    pose, off = _zero_pose(run.machine, stated["zero_at"]), (stated["length"], stated["angle"])
    with observer.progress("sensitivity", len(run), "motions") as advance:
        found = program_sensitivity(run, pose, *off, tuple(_remarks(run)), advance)
    if not found.motions:
        raise InputError(Problem(run.files[0] if run.files else "nc", 0, Wording("RCH110", "nothing_cut")))
    values = unmeasured_values(run.machine, POSITIONS, joint_samples(run))
    return replace(found, grounds=grounds_of((run,), (value.said for value in values)))


def _check_amount(name: str, value: object) -> None:
    """Refuse how far numbers are off unless it is a small amount."""
    if isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value <= _MOST[name]:
        return
    raise wrong_argument(name, value, phrase("give_positive_at_most", most=_MOST[name]))


def _remarks(run: Run) -> list[Problem]:
    """Return what was assumed."""
    machine, file = run.machine, run.files[0] if run.files else "nc"
    found = []
    if run.errors:
        found.append(
            Problem(file, run.errors[0].line, Wording("RCH120", "places_not_understood", count=len(run.errors)))
        )
    if machine.workpiece_zero is None:
        found.append(Problem(file, 0, Wording("RCH130", "zero_taken")))
    if machine.tool_length is None:
        found.append(Problem(file, 0, Wording("RCH140", "length_taken")))
    return [replace(each, severity=Severity.WARNING) for each in found]


def _zero_pose(machine: Machine, zero_at: str | Mapping[str, float] | None) -> dict[str, float] | None:
    """Where the rotary axes stood when the zero was set, degrees by names; None: nothing was set.

    Raises ``InputError`` if it names something else than rotary axes, or no angles, or the linear axes cannot reach the
    zero there.
    """
    pose = _stated_pose(machine, zero_at)
    if pose is not None and np.isnan(joints_at_zero(machine, pose)).any():
        text = ",".join(f"{name}={value:g}" for name, value in pose.items())
        raise wrong_argument("zero_at", text, phrase("give_other_pose"))
    return pose


def _stated_pose(machine: Machine, zero_at: str | Mapping[str, float] | None) -> dict[str, float] | None:
    names = [machine.names[k] for k in machine.own_rotary]
    home = {name: machine.axis(name).home for name in names}
    if zero_at is None or zero_at == "none":
        return None
    if zero_at == "home":
        return home
    example = ",".join(f"{name}=0" for name in names)
    cure = phrase("give_pose", example=example)
    if isinstance(zero_at, str):
        parts = [part.partition("=") for part in zero_at.split(",")]
        given: Mapping[str, object] = {name.strip(): value for name, _, value in parts}
        if len(given) < len(parts):
            raise wrong_argument("zero_at", zero_at, phrase("give_each_axis_once", example=example))
    elif isinstance(zero_at, Mapping):
        given = zero_at
    else:
        raise wrong_argument("zero_at", zero_at, cure)
    for name in given:
        if name not in names:
            remedy = phrase("no_rotary_axis", name=name, example=example) if name else cure
            raise wrong_argument("zero_at", str(zero_at), remedy)
    try:
        pose = home | {name: float(str(value)) for name, value in given.items()}
    except ValueError:
        raise wrong_argument("zero_at", str(zero_at), cure) from None
    if not all(abs(value) < 1e5 for value in pose.values()):  # NaN is none either
        raise wrong_argument("zero_at", str(zero_at), cure)
    for name, value in pose.items():
        axis = machine.axis(name)
        if not axis.low <= value <= axis.high:
            remedy = phrase("give_angle_within", name=name, low=axis.low, high=axis.high)
            raise wrong_argument("zero_at", str(zero_at), remedy)
    return pose
