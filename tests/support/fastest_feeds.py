"""Programs with feeds that the machine can follow, and what proves them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import trunnion
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cl import read_cl
from trunnion.jobs.post.expected_values import Expectation, expectation
from trunnion.jobs.post.fastest_feeds import with_reached_feeds
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import prepare
from trunnion.machines import Machine, load_machine
from trunnion.model.deviations import Deviations
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import Check, Verification, verify

GOLDEN = Path("tests/golden")


FASTEST: dict[str, str] = {"feed": "fastest"}


def check_of(found: trunnion.PostResult | Verification, key: str) -> Check:
    return next(check for check in found.checks if check.key == key)


def able(name: str, slides: float = 300.0, turns: float = 300.0) -> Machine:
    """A shipped machine with accelerations, mm/s² and degrees/s², and room for any part."""
    machine = load_machine(name)
    axes = (
        replace(axis, acceleration=turns) if axis.is_rotary else replace(axis, acceleration=slides, low=-1e4, high=1e4)
        for axis in machine.axes
    )
    return replace(machine, axes=tuple(axes))


def waves(feed: float = 6000.0, rows: int = 41) -> str:
    """A cut whose tool axis swings, with lines of 2 mm."""
    along = np.arange(rows)
    tilt = np.radians(15.0 + 10.0 * np.sin(0.5 * along))
    points = [
        f"GOTO/{2.0 * k:.4f},{math.sin(0.3 * k):.4f},5.0000,{math.sin(a):.9f},0.000000000,{math.cos(a):.9f}\n"
        for k, a in zip(along.tolist(), tilt.tolist(), strict=True)
    ]
    head = CL_HEAD.replace("500.0", f"{feed:.1f}").replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", "")
    head = head.replace("RAPID\n", "RAPID\n" + points[0].replace(",5.0000,", ",50.0000,"))
    return head + "".join(points) + CL_FOOT


@dataclass(frozen=True)
class Posted:
    """A program of ``waves`` on a machine; ``text`` has its lines."""

    machine: Machine
    path: Toolpath
    program: Program
    expected: Expectation
    text: list[str]
    folder: Path

    @property
    def deviations(self) -> Deviations:
        assert self.expected.tolerances[0].deviations is not None
        return self.expected.tolerances[0].deviations

    def failed(self, text: list[str] | None = None, deviations: Deviations | None = None) -> list[str]:
        """The checks that fail for the program, or another one, under the declared feeds or others."""
        return [c.key for c in self.verified(text, deviations).checks if not c.passed]

    def verified(self, text: list[str] | None = None, deviations: Deviations | None = None) -> Verification:
        file = self.folder / f"again{self.program.control.extension}"
        file.write_text("\n".join(self.text if text is None else text) + "\n", encoding="utf-8")
        allowed = [replace(self.expected.tolerances[0], deviations=deviations or self.deviations)]
        return verify(run_program(file, self.machine), [self.path], tolerances=allowed, settings=self.expected.settings)


def posted(folder: Path, machine: Machine, settings: Mapping[str, str], cl: str | None = None) -> Posted:
    source = folder / "waves.cls"
    source.write_text(cl or waves(), encoding="utf-8")
    path = read_cl(source)
    job = prepare(machine, {**FASTEST, **settings})
    program = plan_program([path], job)[0]
    target = folder / f"waves{program.control.extension}"
    with target.open("wb") as sink:
        write_program(program, sink)
    program = with_reached_feeds(program, run_program(target, job.machine), [path], job.options)
    with target.open("wb") as sink:
        write_program(program, sink)
    text = target.read_text(encoding="utf-8").splitlines()
    return Posted(job.machine, path, program, expectation(program, job.options), text, folder)


def feed_word(line: str) -> str:
    return next((word for word in line.split() if word[0] == "F" and word[1:2].isdigit()), "")
