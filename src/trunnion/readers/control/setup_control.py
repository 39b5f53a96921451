"""A control whose tools have lengths, and whose work offsets have zeros, of their own."""

from collections.abc import Sequence

from trunnion.machines import Machine
from trunnion.machines.inverse import kinematic_parameters
from trunnion.model.run import Comment, Diagnostic, Run
from trunnion.readers.control.coordinates import CoordinateControl
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.setup_recorder import SetupRecorder


class SetupControl(CoordinateControl):
    """Counts with the tool in the spindle and the work offset in force; ``machine`` is always set up for them."""

    def __init__(self, machine: Machine, note: Note) -> None:
        self._setups = SetupRecorder(machine)
        self.knows_zeros = bool(machine.zeros)
        super().__init__(machine.set_up_for("", 0), note)

    def set_offset(self, code: int, name: str) -> None:
        """Select a work offset; ``name`` is for messages."""
        super().set_offset(code, name)
        self._take_setup()

    def change_tool(self) -> None:
        """Change to the selected tool, which may be longer."""
        super().change_tool()
        self._take_setup()

    def take_length(self, length: float | None, word: str = "") -> None:
        """Take a length of the program in place of that of the tool, mm; None: that of the tool again."""
        self._setups.take_length(length, word)
        self._take_setup()

    def stated_length(self) -> float | None:
        """Return the length that is stated for the tool in the spindle, mm."""
        return self._setups.length_of(self.tool_in_spindle)

    def _take_setup(self) -> None:
        """Take the length of the tool in the spindle, and the zero of the work offset in force; the axes stay."""
        offset = int(self.modal.work_offset.current)
        machine = self._setups.machine_of(self.row, self.tool_in_spindle, None if offset == self.no_offset else offset)
        if machine is None or machine is self.machine:
            return
        with self.frame_change():
            self.machine, self._kinematics = machine, kinematic_parameters(machine)
            self._zero_slides, self._zero_tip = self._zero_positions()
            self.forget_machine()

    def forget_machine(self) -> None:
        """Forget what was worked out with the tool and the zero before."""

    def finish(self, files: Sequence[str], comments: list[Comment], diagnostics: Sequence[Diagnostic]) -> Run:
        """Return the run, with the set-ups of its rows."""
        return self._setups.of_run(super().finish(files, comments, diagnostics))
