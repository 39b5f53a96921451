"""Writes templates with their values, and knows the spindle speed that a template printed last."""

from collections.abc import Mapping, Sequence

from trunnion.controls.template import Value
from trunnion.model.motion import Motion
from trunnion.output.blocks.motion_blocks import MotionBlockWriter


class TemplateWriter:
    """Writes the templates of a program."""

    def __init__(self, blocks: MotionBlockWriter) -> None:
        self._blocks = blocks
        self._control = blocks.control
        self._lengths = self._control.length_fields
        self._speed: Value = None

    def write(self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()) -> None:
        """Write a template, with the number formats of a motion.

        ``notices`` are comment lines that come as near to the first line as the control allows.
        """
        formats = self._control.number_formats(motion.three_axis)
        template = self._control.templates[name]
        speed = values["spindle_speed"]
        values = {**values, "new_speed": None if speed == self._speed else speed}
        lines = template.expand(values, formats, self._lengths, self._control.unit)
        first = self._control.first_lines if notices else 0
        self._blocks.write_lines([*lines[:first], *notices, *lines[first:]])
        if any(field in ("spindle_speed", "new_speed") for field, _ in template.fields()):
            self._speed = speed

    def write_unskipped(
        self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()
    ) -> None:
        """Write a template whose blocks must be executed also while blocks are skipped."""
        writer = self._blocks.writer
        skips = writer.skips_blocks
        writer.set_block_skip(False)
        self.write(name, values, motion, notices)
        writer.set_block_skip(skips)

    def speed_changes(self, speed: float) -> bool:
        """Whether a speed is another one than was printed last."""
        return speed != self._speed

    def forget_speed(self) -> None:
        """Print the spindle speed again, even if it is unchanged."""
        self._speed = None
