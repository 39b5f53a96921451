"""Which tools go along points of the contour, as the CL files of a program say, and not along those of their centre."""

from collections.abc import Iterable
from dataclasses import field

from trunnion.model.run import Run
from trunnion.model.toolpath import CutterComp, LoadTool, Toolpath
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ContourTools:
    """What the points under CUTCOM are, by the number or name of the tool and its register of the radius (0: its own).

    of_contour  True: those of the contour; False: those of the tool's centre
    """

    of_contour: dict[tuple[int | str, int], set[bool]] = field(default_factory=dict)

    @staticmethod
    def of(toolpaths: Iterable[Toolpath]) -> "ContourTools":
        """Return what CL files say, in the order in which they are cut."""
        found, number = ContourTools(), 0
        for operation in (each for toolpath in toolpaths for each in toolpath.operations):
            for event in operation.events:
                if isinstance(event, LoadTool):
                    number = event.number
                elif isinstance(event, CutterComp) and event.side != "OFF":
                    for tool in (number, operation.tool.name):
                        for register in {event.register, 0}:
                            found.of_contour.setdefault((tool, register), set()).add(event.contour)
        return found

    def has(self, run: Run, row: int) -> bool:
        """Whether the tool of a row goes along a contour, and along nothing else with that register."""
        word, register = run.tools[int(run.state.tool[row])], int(run.state.radius[row])
        tool = int(word) if word.isascii() and word.isdecimal() else word
        known = self.of_contour.get((tool, register)) or self.of_contour.get((tool, 0), set())
        return known == {True}
