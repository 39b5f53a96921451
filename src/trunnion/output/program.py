"""The input of a program: machine, control, planned motions and the settings of the run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from trunnion.controls.definition import Control
from trunnion.controls.words import Word
from trunnion.machines import Machine
from trunnion.model.motion import Motion


class RotaryWord(NamedTuple):
    """The word of a rotary axis.

    key     of the word: ``primary`` or ``secondary``
    axis    index of the axis in ``Machine.axes``
    column  of the axis in ``Motion.rotary``
    """

    key: str
    axis: int
    column: int


@dataclass(frozen=True, slots=True)
class Program:
    """All that a program is made from.

    settings  those of the run; they take precedence over the control's
    file      the CL file, for messages
    notices   comments at the start of the program
    """

    machine: Machine
    control: Control
    motions: Sequence[Motion]
    settings: Mapping[str, str]
    file: str = ""
    notices: Sequence[str] = ()

    def effective_settings(self) -> dict[str, str]:
        """Return the settings of the run over those of the definition."""
        return {**self.control.settings, **{key: value for key, value in self.settings.items() if value}}

    def effective_setting(self, name: str) -> str:
        """Return a setting of the run, or else of the definition; empty if neither has it."""
        return self.settings.get(name) or self.control.settings.get(name, "")

    def template_suffix(self, motion: Motion) -> str:
        """Return the suffix of the templates for a motion; empty if the control cannot work in its mode."""
        return self.control.template_suffix(motion.mode, self.settings)

    def rotary_words(self) -> tuple[RotaryWord, RotaryWord]:
        """Return the words of the primary and of the secondary rotary axis."""
        machine = self.machine
        primary, secondary = machine.primary, machine.secondary
        return (
            RotaryWord("primary", primary, machine.rotary.index(primary)),
            RotaryWord("secondary", secondary, machine.rotary.index(secondary)),
        )

    def block_words(self, motion: Motion) -> tuple[Word, ...]:
        """Return the words of a motion's blocks in their order."""
        axes = self.machine.axes
        primary, secondary = (axes[word.axis].name for word in self.rotary_words())
        return tuple(self.control.block_words(primary, secondary, motion.three_axis))
