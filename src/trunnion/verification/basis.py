"""What checks stand on besides the program: what somebody has to state, and what of it is missing.

In:     a run, whose machine was set up for it.
Out:    for each basis what is missing of it, in words; none where it is stated.

A check whose basis is missing was not made, or only in part: its state is ``not checked``, never ``ok``. A definition
may demand a basis (``[proof] require``), and ``--strict`` demands them all: what is missing then fails the check
``basis``.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Final

import numpy as np

from trunnion.compensation.stretches import RegisterValue, offsets_of
from trunnion.machines import Axis, Machine, states_spindle_range
from trunnion.machines.unmeasured import ValueKind, unmeasured_values
from trunnion.messages import Wording, phrase
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import Run
from trunnion.model.run_samples import joint_samples
from trunnion.model.stated_words import StatedWord
from trunnion.model.unknown_setups import offsets_without_zero, tools_without_length
from trunnion.records import dataclass
from trunnion.verification.axes_from_home import axes_from_home
from trunnion.verification.block_names import block_name_of


@dataclass(frozen=True, slots=True)
class Basis:
    """Something that a check stands on; ``missing`` says what is not stated of it."""

    key: str
    missing: Callable[[Run], Wording | None]


def _without(machine: Machine, is_stated: Callable[[Axis], bool]) -> tuple[str, ...]:
    """Return the axes of which something is not stated."""
    return tuple(axis.name for axis in machine.own_axes if not is_stated(axis))


def _no_zero(run: Run) -> Wording | None:
    if names := offsets_without_zero(run):
        return phrase("no_zero_of", names=names)
    return phrase("no_zero") if run.machine.workpiece_zero is None else None


def _no_tool_length(run: Run) -> Wording | None:
    if names := tools_without_length(run):
        return phrase("no_length_of", names=names)
    return phrase("no_tool_length") if run.machine.tool_length is None else None


def _no_travel(run: Run) -> Wording | None:
    names = _without(run.machine, lambda axis: axis.endless or axis.has_limits)
    return phrase("no_travel_of", axes=names) if names else None


def _no_rapid(run: Run) -> Wording | None:
    names = _without(run.machine, lambda axis: axis.rapid is not None)
    if len(names) == len(run.machine.own_axes):
        return phrase("no_rapid")
    return phrase("no_rapid_of", axes=names) if names else None


def _no_acceleration(run: Run) -> Wording | None:
    names = _without(run.machine, lambda axis: axis.acceleration is not None)
    if len(names) == len(run.machine.own_axes):
        return phrase("no_acceleration")
    return phrase("no_acceleration_of", axes=names) if names else None


def _no_spindle_speeds(run: Run) -> Wording | None:
    return None if states_spindle_range(run.machine) else phrase("no_spindle_speeds")


def assumed_modes(run: Run) -> tuple[str, ...]:
    """Return the modes that the control is taken to start with, in each meaning of a program: nobody states them."""
    runs = (run, *(each.run for each in run.skipped))
    return tuple(dict.fromkeys(word for each in runs for word in each.assumed_modes))


def stated_words(run: Run) -> tuple[StatedWord, ...]:
    """Return the words and variables that a program relies on and only somebody's statement explains, in each meaning
    of it.
    """
    runs = (run, *(each.run for each in run.skipped))
    return tuple(dict.fromkeys(word for each in runs for word in each.stated))


def stated_texts(run: Run) -> tuple[str, ...]:
    """Return what was stated of them, as every verdict names it."""
    return tuple(str(each.wording) for each in stated_words(run))


def _no_start_modes(run: Run) -> Wording | None:
    words = assumed_modes(run)
    return phrase("assumed_modes", words=words) if words else None


def turns_before_offset(run: Run) -> Wording | None:
    """Return the first block that positions rotary axes before the program selects a work offset; None: none does.

    The rotary axes of a work offset count too: which one an earlier program has left in force is not known there.
    """
    runs = (run, *(each.run for each in run.skipped))
    return next((block for each in runs if (block := _turn_before_offset(each))), None)


def _turn_before_offset(run: Run) -> Wording | None:
    selected = np.flatnonzero(run.state.work_offset.part(0, len(run)) != 0)[:1]
    if not len(selected):
        return None  # it works in none, which the check "offset" tells
    rows = int(selected[0])
    turns = (run.programmed[:rows] & int(ROTARY_WORDS)) != 0
    before = run.start[None, list(run.machine.rotary)]
    turns |= (np.diff(run.rotary[:rows], axis=0, prepend=before) != 0.0).any(axis=1)  # by a plane or a vector
    turns &= ~run.state.machine_frame.part(0, rows)
    found = np.flatnonzero(turns)[:1].tolist()
    return block_name_of(run, found[0]) if found else None


def _no_start_offset(run: Run) -> Wording | None:
    block = turns_before_offset(run)
    return phrase("assumed_offset", block=block) if block else None


def _no_start_position(run: Run) -> Wording | None:
    axes = axes_from_home(run)
    return phrase("assumed_home", axes=axes) if axes else None


ZERO: Final = Basis("zero", _no_zero)
TOOL_LENGTH: Final = Basis("tool_length", _no_tool_length)
TRAVEL: Final = Basis("travel", _no_travel)
RAPID: Final = Basis("rapid", _no_rapid)
ACCELERATION: Final = Basis("acceleration", _no_acceleration)
SPINDLE: Final = Basis("spindle", _no_spindle_speeds)
START_MODES: Final = Basis("start_modes", _no_start_modes)
START_OFFSET: Final = Basis("start_offset", _no_start_offset)
START_POSITION: Final = Basis("start_position", _no_start_position)

#: What ``[proof] require`` and ``--strict`` may demand, with its bases; of the last three each program has its own.
DEMANDS: Final[Mapping[str, tuple[Basis, ...]]] = {
    "zero": (ZERO,),
    "tool_length": (TOOL_LENGTH,),
    "dynamics": (RAPID, ACCELERATION),
    "start_modes": (START_MODES, START_OFFSET, START_POSITION),
    "radius_register": (),
    "cl_units": (),
    "measured": (),
    "given_words": (),
}


def missing_of(bases: Iterable[Basis], run: Run) -> tuple[Wording, ...]:
    """Return what is missing of some bases."""
    return tuple(found for basis in bases if (found := basis.missing(run)) is not None)


def missing_demands(
    demands: Iterable[str], run: Run, holds: RegisterValue, assumes_unit: bool = False
) -> Iterator[Wording]:
    """Yield what is missing of what is demanded for a program, each once.

    holds         what its registers hold
    assumes_unit  a CL file is taken to be in mm, which nothing says
    """
    for name in DEMANDS:
        if name in demands:
            yield from missing_of(DEMANDS[name], run)
    if "radius_register" in demands and any(offset is None for _, offset in offsets_of(run, holds, lambda _: 0.0)):
        yield phrase("no_radius_register")
    if "cl_units" in demands and assumes_unit:
        yield phrase("assumed_unit", unit="mm")
    if "given_words" in demands and (given := [each for each in stated_words(run) if each.is_given]):
        yield phrase("given_words", words=tuple(each.wording for each in given))
    if "measured" in demands:
        kinds = set(ValueKind) - {ValueKind.BODIES, ValueKind.TABLE}
        if names := tuple(map(str, unmeasured_values(run.machine, kinds, joint_samples(run)))):
            yield phrase("not_measured", count=len(names), names=names)
