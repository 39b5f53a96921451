"""Verifications to report on: a golden program with handmade checks, and one of any length."""

from dataclasses import replace
from html.parser import HTMLParser
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.support.locations import YL569
from trunnion.arrays import Floats, Lines
from trunnion.machines import Machine, load_machine
from trunnion.messages import foreign
from trunnion.model.columns import RampColumn, StepColumn
from trunnion.model.run import Run
from trunnion.model.run_columns import ModalState
from trunnion.model.toolpath import Arcs
from trunnion.readers import run_program
from trunnion.verification.results import Check, Place, Verification

PLACES = tuple(
    Place(50 + k, 500 + 10 * k, 0.0004 - k * 1e-5, foreign(f"the tip is {k} off"), "3_blade_finish.cls", 45 + k)
    for k in range(20)
)
CHECKS = (
    Check("tip", True, foreign("largest 0.0004 mm at N500"), 0.0004, 0.0005, "mm", PLACES),
    Check("travel", False, foreign("B leaves its travel by 0.2°"), -0.2, 0.0, "°", PLACES[:1]),
    Check("words", True, foreign("none")),
)


def times(run: Run) -> tuple[Floats, Floats]:
    """Seconds and tip feed of each row, in a simple way: length at feed, rapids at the slowest axis."""
    tip = np.linalg.norm(np.diff(run.tip, axis=0, prepend=run.tip[:1]), axis=1)
    rapid = np.array([axis.rapid or 1000.0 for axis in run.machine.axes])
    slowest = (np.abs(np.diff(run.joints, axis=0, prepend=run.start[None])) / rapid).max(axis=1) * 60.0
    seconds = np.maximum(np.where(run.kind == 0, 0.0, tip / np.nan_to_num(run.feed, nan=1000.0) * 60.0), slowest)
    return seconds, np.divide(tip * 60.0, seconds, out=np.zeros(len(run)), where=seconds > 0.0)


def blade(name: str = "3_blade_finish.mpf", checks: tuple[Check, ...] = CHECKS) -> Verification:
    """Return a verification of a golden program."""
    run = run_program(YL569 / "3_blade_finish.expected.mpf", load_machine("yl569"))
    seconds, feed = times(run)
    cl_line = np.where(run.block_number > 0, run.line - 10, 0).astype(np.int32)
    return Verification(name, run.machine, run, checks, seconds, feed, cl_line)


def waves(n: int, tools: tuple[str, ...] = ("", "1"), machine: Machine | None = None) -> Verification:
    """Return a verification of n motions that swing in all axes, with the last of the ``tools``."""
    machine = machine or load_machine("yl569")
    along = np.linspace(0.0, 200.0, n)
    joints = np.stack([along, 40 + 40 * np.sin(along), 90 * np.cos(along), along / 2, -along / 3], axis=1)

    def same(value: float, kind: type[np.generic]) -> StepColumn:
        return StepColumn.constant(n, value, kind)

    lines: Lines = np.arange(1, n + 1, dtype=np.int32)
    run = Run(
        machine=machine,
        files=("waves.mpf",),
        lines=RampColumn(n, np.array([0]), np.array([1]), np.array([1])),
        block_numbers=RampColumn(n, np.array([0]), np.array([10]), np.array([10])),
        kind=np.ones(n, np.uint8),
        programmed=np.zeros(n, np.uint8),
        xyz=joints[:, [machine.column(name) for name in "XYZ"]],
        rotary=joints[:, list(machine.rotary)],
        state=ModalState(
            file=same(0, np.uint16),
            feed=same(1000.0, np.float64),
            feed_mode=same(94, np.uint8),
            rpm=same(5000.0, np.float64),
            spindle=same(1, np.int8),
            tool=same(len(tools) - 1, np.int32),
            edge=same(1, np.int32),
            compensation=same(0, np.int8),
            radius=same(0, np.int8),
            compensation_plane=same(0, np.int8),
            at_ends=same(False, np.bool_),
            compensation_style=same(0, np.uint8),
            stated_radius=same(np.nan, np.float64),
            work_offset=same(54, np.uint16),
            tcp=same(1, np.bool_),
            machine_frame=same(0, np.bool_),
            machine_steps=same(0, np.uint8),
            inches=same(0, np.bool_),
            orientation=same(0, np.uint8),
            xyz_is_tip=same(0, np.bool_),
            plane=same(-1, np.int32),
            length_axis=same(2, np.int8),
            working_plane=same(2, np.uint8),
            feed_path=same(0, np.uint8),
        ),
        start=np.zeros(5),
        arcs=Arcs.empty(),
        tools=tools,
    )
    seconds = np.full(n, 0.01)
    return Verification("waves.mpf", machine, run, CHECKS, seconds, np.full(n, 1000.0), lines)


def with_seconds(verification: Verification, seconds: Floats) -> Verification:
    """Return the verification with other times."""
    return replace(verification, seconds=seconds)


def with_columns(verification: Verification, **columns: NDArray[Any]) -> Verification:
    """Return the verification with other columns in its run."""
    run = replace(verification.run)
    vars(run).update(columns)
    return replace(verification, run=run)


class Page(HTMLParser):
    """A page as a browser reads it: its elements with attributes, its scripts, and the text outside them."""

    def __init__(self, source: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self.styles: list[str] = []
        self.text = ""
        self._inside = ""
        self.feed(source)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append((dict(attrs), ""))
        if tag in ("script", "style"):
            self._inside = tag

    def handle_endtag(self, tag: str) -> None:
        if tag == self._inside:
            self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside == "script":
            attributes, source = self.scripts[-1]
            self.scripts[-1] = (attributes, source + data)
        elif self._inside == "style":
            self.styles.append(data)
        else:
            self.text += data

    def script(self, name: str) -> str:
        """Return the script element with this id."""
        return next(source for attributes, source in self.scripts if attributes.get("id") == name)

    @property
    def running(self) -> list[str]:
        """The scripts that a browser would run."""
        return [source for attributes, source in self.scripts if "type" not in attributes]
