"""What the templates of a program are printed with besides their values: formats, unit, records for expressions."""

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from trunnion.controls.template import Budget, Printing, Value
from trunnion.model.motion import Motion
from trunnion.output.program import Program
from trunnion.output.template_values import TemplateValues

if TYPE_CHECKING:  # imported where a template has expressions
    from trunnion.output.template_records import TemplateRecords


class TemplatePrinting:
    """Knows the records of a program; they are made for the first template with expressions."""

    def __init__(self, program: Program, values: TemplateValues) -> None:
        self._program, self._values = program, values
        self._control = program.control
        self._lengths = self._control.length_fields
        self._budget = Budget()
        self._has_texts = any(template.is_text for template in self._control.templates.values())

    def of(
        self,
        motion: Motion,
        values: Mapping[str, Value],
        lists: Mapping[str, object] | None = None,
        own: Mapping[str, object] | None = None,
    ) -> Printing:
        """Return what a template prints with at a motion.

        ``values`` are those of ``TemplateValues``, ``lists`` others for expressions alone, ``own`` those of the place.
        """
        formats = self._control.number_formats(motion.three_axis)
        if not self._has_texts:
            return Printing(formats, self._lengths, self._control.unit)
        found = {**self._records_at(values), **(lists or {})}
        return Printing(formats, self._lengths, self._control.unit, self._numbers, found, self._budget, own or {})

    def _records_at(self, values: Mapping[str, Value]) -> dict[str, object]:
        number, records = values.get("operation_number"), self._records
        found: dict[str, object] = {"tools": records.tools, "operations": records.operations}
        if isinstance(number, int):
            operation = records.operations[number - 1]
            found |= {"operation": operation, "tool": operation.values["tool"]}
            found["next_tool"] = records.tool(self._values.tools.next_call(number))
        return found

    @cached_property
    def _numbers(self) -> frozenset[str]:
        """The settings that are numbers."""
        return frozenset(name for name in self._control.settings if self._control.setting_rule(name).is_number)

    @cached_property
    def _records(self) -> "TemplateRecords":
        from trunnion.output.template_records import TemplateRecords

        return TemplateRecords(self._program, self._values)
