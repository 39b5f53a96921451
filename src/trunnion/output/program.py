"""All that one program is made from, and what its definition and the settings of the run say of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.definition import Control
from trunnion.controls.words import Word, round_to_counts
from trunnion.machines import Machine
from trunnion.model.motion import Motion


@dataclass(frozen=True, slots=True)
class Program:
    """All that one program is made from. ``notices`` are printed at its head, as comments."""

    machine: Machine
    control: Control
    motions: Sequence[Motion]
    settings: Mapping[str, str]
    file: str = ""
    notices: Sequence[str] = ()


def template_suffix(program: Program, motion: Motion) -> str:
    """What the templates of this kind of operation are called."""
    return program.control.template_suffix(motion.mode, program.settings)


def effective_settings(program: Program) -> dict[str, str]:
    """The settings of the run over those of the definition."""
    return {**program.control.settings, **{key: value for key, value in program.settings.items() if value}}


def effective_setting(program: Program, name: str) -> str:
    """A setting of the run, or else that of the definition; empty where nobody has one."""
    return program.settings.get(name) or program.control.settings.get(name, "")


def motion_block_words(program: Program, motion: Motion) -> tuple[Word, ...]:
    """The words of motion blocks in an operation, in their order."""
    machine = program.machine
    primary, secondary = machine.axes[machine.primary].name, machine.axes[machine.secondary].name
    return tuple(program.control.block_words(primary, secondary, motion.three_axis))


def rotary_counts(machine: Machine, column: int, angle: Floats, decimals: int) -> Ints:
    """Counts of a rotary word; an axis that displays 0 to 360 degrees prints 360 as 0.

    Parameters
    ----------
    machine, column
        Which axis it is, as a column of joints.
    angle : (n,) float64
        Degrees.
    decimals
        That are printed.
    """
    axis = machine.axes[column]
    count = round_to_counts(np.ascontiguousarray(angle), decimals)
    if not np.isnan(axis.display_low):
        turn = 360 * 10**decimals
        top = round(axis.display_low * 10**decimals) + turn
        count[count >= top] -= turn
    return count
