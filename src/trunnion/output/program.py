"""The input of a program: machine, control, planned motions and the settings of the run."""

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import NamedTuple, TypeAlias

from trunnion.controls.definition import Control
from trunnion.controls.vocabulary import DISTANCES_SETTING, INCREMENTAL
from trunnion.controls.words import IncrementWords, Word
from trunnion.encoding import TextForm
from trunnion.machines import Machine
from trunnion.model.machining_method import machining_method
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Operation
from trunnion.records import dataclass
from trunnion.transliteration import spelled


class RotaryWord(NamedTuple):
    """The word of a rotary axis.

    key     of the word: ``primary`` or ``secondary``
    axis    index of the axis in ``Machine.axes``
    column  of the axis in ``Motion.rotary``
    """

    key: str
    axis: int
    column: int


#: File, line and name of an operation, which its parts and copies share.
OperationKey: TypeAlias = tuple[str, int, str]


def operation_key(operation: Operation) -> OperationKey:
    """Return what an operation and its parts have in common."""
    return operation.file, operation.line, operation.name


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """All that a program is made from.

    settings         those of the run; they take precedence over the control's
    own_settings     those of single operations, by their names; they take precedence over all others
    file             the first CL file, for messages
    notices          comments at the start of the program
    setups           the machine with the tool and the work offset of single operations; others have ``machine``
    time_token       letters that begin the tokens for machining times, until these are known; empty: there are none
    """

    machine: Machine
    control: Control
    motions: Sequence[Motion]
    settings: Mapping[str, str]
    file: str = ""
    notices: Sequence[str] = ()
    own_settings: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    time_token: str = ""
    setups: Mapping[OperationKey, Machine] = field(default_factory=dict)

    def machine_of(self, motion: Motion) -> Machine:
        """Return the machine with the tool and the work offset of a motion."""
        return self.setups.get(operation_key(motion.operation), self.machine)

    def called_machine_of(self, motion: Motion) -> Machine:
        """Return the machine of a motion with the tool as long as its call makes it for the control (DL)."""
        machine, delta = self.machine_of(motion), self.effective_setting("delta_length", motion.operation)
        if not delta or machine.tool_length is None:
            return machine
        return replace(machine, tool_length=machine.tool_length + float(delta))

    def settings_of(self, operation: Operation) -> dict[str, str]:
        """Return the settings of the run, with those of an operation over them."""
        return {**self.settings, **self.own_settings.get(operation.name, {})}

    def effective_settings(self, operation: Operation | None = None) -> dict[str, str]:
        """Return the settings of the run, for an operation if one is given, over those of the definition."""
        given = self.settings if operation is None else self.settings_of(operation)
        return {**self.control.settings, **{key: value for key, value in given.items() if value}}

    def effective_setting(self, name: str, operation: Operation | None = None) -> str:
        """Return a setting of the run, for an operation if one is given, or else of the definition; empty for none."""
        return self.effective_settings(operation).get(name, "")

    @property
    def increments(self) -> IncrementWords | None:
        """How X, Y and Z are said as increments; None where they stay absolute."""
        return self.control.family.INCREMENTS if self.effective_setting(DISTANCES_SETTING) == INCREMENTAL else None

    @property
    def planes_are_of_pose(self) -> bool:
        """Whether tilted planes are taken from the rotary positions that are printed, and not from angles."""
        by_command = self.effective_setting("plane") in self.control.family.PLANES_OF_POSE
        return self.control.plane_from_pose or by_command

    @property
    def text_form(self) -> TextForm:
        """How its characters become bytes."""
        line_end = b"\r\n" if self.effective_setting("line_ends") == "crlf" else b"\n"
        return TextForm(self.effective_setting("encoding") or "utf-8", line_end)

    def spelled(self, text: str) -> str:
        """Return a text from outside in the characters that the program can have."""
        return spelled(text, self.text_form.encoding)

    def file_of(self, operation: Operation) -> str:
        """Return the CL file of an operation, for messages."""
        return operation.file or self.file

    def method_of(self, operation: Operation) -> str:
        """Return the machining method of an operation: that of its settings, or else what the CL file tells."""
        given, default = self.settings_of(operation).get("method"), self.control.settings.get("method")
        if given and given != default:
            return given
        return machining_method(operation.name, operation.intol, operation.outtol)

    def template_suffix(self, motion: Motion) -> str:
        """Return the suffix of the templates for a motion; empty if the control cannot work in its mode."""
        return self.control.template_suffix(motion.mode, self.settings)

    def rotary_words(self) -> tuple[RotaryWord, ...]:
        """Return the words of the primary and of the secondary rotary axis, as far as the machine has them."""
        columns, keys = self.machine.rotary_words, ("primary", "secondary")
        rotary = self.machine.rotary
        return tuple(RotaryWord(key, k, rotary.index(k)) for key, k in zip(keys, columns, strict=False))

    def block_words(self, motion: Motion) -> tuple[Word, ...]:
        """Return the words of a motion's blocks in their order."""
        machine = self.machine
        primary, secondary = machine.names[machine.primary], machine.names[machine.secondary]
        return tuple(self.control.block_words(primary, secondary, motion.three_axis))
