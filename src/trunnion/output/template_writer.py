"""Writes templates with their values, and knows the spindle speed that a template printed last."""

from collections.abc import Mapping, Sequence

from trunnion.controls.template import Answer, Value
from trunnion.model.motion import Motion
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.said_words import said_words
from trunnion.output.template_printing import TemplatePrinting


class TemplateWriter:
    """Writes the templates of a program."""

    def __init__(self, blocks: MotionBlockWriter, printing: TemplatePrinting) -> None:
        self._blocks = blocks
        self._control = blocks.control
        self._printing = printing
        self._speed: Value = None

    def write(self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()) -> None:
        """Write a template, with the number formats of a motion.

        ``notices`` are comment lines that come as near to the first line as the control allows.
        """
        answer = self.answer(name, values, motion)
        self.write_answer(answer, notices, self._control.first_lines if notices else 0)
        if answer.base is not None and not set(answer.base) <= set(answer.lines):
            self.forget_speed()  # a function may have left it out
        elif any(field in ("spindle_speed", "new_speed") for field, _ in self._control.templates[name].fields()):
            self._speed = values["spindle_speed"]

    def write_answer(self, answer: Answer, notices: Sequence[str] = (), first: int = 0) -> None:
        """Write the lines of a place, with ``notices`` behind the ``first`` of them.

        What those of a function leave in force is not known afterwards, unless they are understood.
        """
        self._blocks.write_lines(answer.lines[:first], source=answer.source)
        self._blocks.write_lines(notices)
        self._blocks.write_lines(answer.lines[first:], source=answer.source)
        if answer.base is not None:
            self.forget_words([line for line in answer.lines if line not in answer.base])

    def answer(
        self, name: str, values: Mapping[str, Value], motion: Motion, own: Mapping[str, object] | None = None
    ) -> Answer:
        """Return what stands at the place of a template; ``own`` is what only that place has."""
        speed = values["spindle_speed"]
        values = {**values, "new_speed": None if speed == self._speed else speed}
        return self._control.templates[name].answer(values, self._printing.of(motion, values, own=own))

    def lines(
        self, name: str, values: Mapping[str, Value], motion: Motion, own: Mapping[str, object] | None = None
    ) -> list[str]:
        """Return the lines that a template prints."""
        return list(self.answer(name, values, motion, own).lines)

    def switching_lines(self, name: str, values: Mapping[str, Value], motion: Motion) -> Sequence[str]:
        """Return the lines of a template that switch something: as they are written, or will be where that depends."""
        template = self._control.templates[name]
        return self.lines(name, values, motion) if template.is_text else template.lines

    def write_place(
        self, name: str, values: Mapping[str, Value], motion: Motion, own: Mapping[str, object] | None = None
    ) -> bool:
        """Write the text of a shop at a place, if the definition has one; returns whether it has.

        What its words leave in force is not known afterwards, unless they are understood.
        """
        if name not in self._control.templates:
            return False
        answer = self.answer(name, values, motion, own)
        self._blocks.write_lines(answer.lines, source=answer.source)
        self.forget_words(answer.lines)
        return True

    def forget_words(self, lines: Sequence[str]) -> None:
        """Write again what a text has said, as far as it is understood, and else everything."""
        words = said_words(lines, self._control, self._blocks.writer.words)
        if words is None:
            self._blocks.writer.forget()
            self.forget_speed()
        elif words:
            self._blocks.writer.forget(*words)
            if "speed" in words:
                self.forget_speed()

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
