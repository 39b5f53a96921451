"""Klartext programs that are posted, read back and proven."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import strategies as st

from tests.support.jobs import post_job
from tests.support.locations import GOLDEN
from tests.support.machines import five_axis_machines
from tests.support.operations import operation_of
from tests.support.path_strategies import short_paths, smooth_paths
from tests.support.posting import FOOT, HEAD
from tests.support.proof import unproven
from trunnion.cli import main
from trunnion.controls import Control, load_control
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Arcs, LoadTool, Moves, SpindleOn, Toolpath
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import Verification, failures, verify

DMU65 = GOLDEN / "dmu65"
OWN = {name: load_machine(name) for name in ("dmu65", "mikron_600u", "ucp800")}
CONTROLS = {name: load_control(machine.control) for name, machine in OWN.items()}

#: Every shipped machine, with the control of one of these.
MACHINES = {
    name: replace(load_machine(name), control=OWN["mikron_600u"].control.unread_copy()) for name in five_axis_machines()
}


class Post:
    """Posts CL text on the DMU 65."""

    def __init__(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        self.folder, self._capfd = folder, capfd

    def __call__(self, text: str, *arguments: str, machine: str = "dmu65") -> list[str]:
        """The blocks of the program without their numbers, which must count from 0."""
        code, out, err = self.all(text, *arguments, machine=machine)
        assert (code, unproven(err)) == (0, "")
        blocks = re.split(r"\n(?! )", out.rstrip("\n"))
        assert [int(block.split(" ", 1)[0]) for block in blocks] == list(range(len(blocks)))
        return [block.split(" ", 1)[1] for block in blocks]

    def all(self, text: str, *arguments: str, machine: str = "dmu65") -> tuple[int, str, str]:
        file = self.folder / "part.cls"
        file.write_text(text, encoding="utf-8")
        code = main(["post", str(file), "--machine", machine, "--output", "-", *arguments])
        out, err = self._capfd.readouterr()
        return code, out, err


def between(blocks: list[str], first: str, last: str) -> list[str]:
    begin = blocks.index(first)
    return blocks[begin + 1 : blocks.index(last, begin)]


def motion(blocks: list[str]) -> list[str]:
    """The blocks between spindle start and stop, without phase comments."""
    return [block for block in between(blocks, "M3", "M5") if not block.startswith(";")]


SIMULTANEOUS = HEAD + "GOTO/20,0,5,0.5,0.0,0.8660254038\nGOTO/30,0,5,0.0,-0.5,0.8660254038\n" + FOOT
TCP = {"m128": ("M128", "M129"), "function": ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM")}


TILTED = HEAD.replace("0.0,0.0,50.0,0.0,0.0,1.0", "0.0,0.0,50.0,0.5,0.0,0.866025403784") + FOOT


def toolpath_of(moves: Moves, arcs: Arcs | None = None) -> Toolpath:
    """A CL file of one operation, with all that a program needs besides."""
    operation = replace(operation_of(moves), arcs=arcs or Arcs.empty())
    events = (LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0))
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


def proven(toolpath: Toolpath, machine: Machine, control: Control, folder: Path, **given: str) -> Verification:
    """The verification of a toolpath's program; fails if a check does.

    Raises
    ------
    RefusedError, InputError
        When there is no program, as over-travel and tool axes out of reach leave none.
    """
    options = parse_plan_options(given, control)
    program = plan_program([toolpath], post_job(machine, control, options, given))[0]
    target = folder / "part.h"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program, options)
    found = verify(run_program(target, machine), [toolpath], tolerances=expected.tolerances, settings=expected.settings)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    # A CUTCOM has a DR of its own. The proof judges what DL and DR add; the run only says that its path is without.
    added = ("DR adds", *(["DL adds"] if given.get("delta_length") else []))
    # Random circles may end beside their start, which is remarked upon.
    told = [finding.text for finding in found.run.diagnostics if finding.code != "NC323"]
    assert [text for text in told if not text.startswith(added)] == []
    return found


PATHS = smooth_paths(25.0) | smooth_paths(100.0) | smooth_paths(3.0) | short_paths(12)


#: Shares of the travel of the rotary axes. Right at a limit the last digit of a plane's angles may be beyond it.
SHARES = st.tuples(st.floats(0.001, 0.999), st.floats(0.001, 0.999))


MODES = [
    "DRILL", "REAM", "DRILL,DEEP,STEP,4.0", "DRILL,DEEP,STEP,6.0,1.0,2.0", "DRILL,BRKCHP,STEP,4.0",
    "DRILL,BRKCHP,STEP,6.0,1.0,2.0", "BORE,DRAG", "BORE,NODRAG,30", "TAP", "TAP,DEEP,STEP,6.0", "TAP,BRKCHP,STEP,6.0",
]  # fmt: skip
