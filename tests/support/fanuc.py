"""Fanuc programs that are written, read back and proven."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck

from tests.support.jobs import post_job
from tests.support.machines import at_zero
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Toolpath
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import Verification, failures, verify

FANUC = load_machine("matsuura_mx330").control
CONTROL = load_control(FANUC)
MACHINES = [
    "matsuura_mx330",
    "hs664rt",
    "yl569",
    "generic_head_head_ca",
    "generic_head_table_bc",
    "generic_nutated_b45_c",
]
SLOW = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much]

#: A word without a decimal point, which a Fanuc may take to be a thousand times smaller.
POINTLESS = re.compile(r"(?<![A-Z])[XYZABCIJKRF]-?\d+(?![\d.])")


def machine(name: str) -> Machine:
    """A machine with a Fanuc and wide limits of its linear axes."""
    model = at_zero(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in model.axes)
    return replace(model, axes=axes, control=FANUC)


def posted(toolpath: Toolpath, folder: Path, model: Machine, **asked: str) -> tuple[Verification, str]:
    """The proof of the program of a toolpath, and its text."""
    options = parse_plan_options(asked, CONTROL)
    printed = {key: value for key, value in asked.items() if key in CONTROL.settings}
    program = plan_program([toolpath], post_job(model, CONTROL, options, printed))[0]
    target = folder / "part.nc"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program, options)
    found = verify(run_program(target, model), [toolpath], tolerances=expected.tolerances, settings=expected.settings)
    return found, target.read_text(encoding="ascii")


def proven(toolpath: Toolpath, folder: Path, model: Machine, **asked: str) -> str:
    """The text of a program that is proven and well-formed for a Fanuc."""
    found, text = posted(toolpath, folder, model, **asked)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    lines = text.splitlines()
    assert (lines[0], lines[1][:5], lines[-1]) == ("%", "O0001", "%")
    blocks = [line for line in lines[2:-1] if not line.startswith("(")]
    assert all(re.match(r"N[1-9]\d{1,4} ", line) for line in blocks)
    assert not [line for line in blocks if POINTLESS.search(line)]
    assert not [line for line in blocks if len(re.findall(r"M\d", line)) > 1], "one M word a block"
    # The tool length goes on and off with a motion of its own, before any plane is cancelled: also the length that a
    # run left active that was aborted.
    assert all(" Z" in line for line in blocks if re.search(r"G43|G49", line))
    state = "on"
    for line in blocks:
        state = {"G43": "on", "G49": "off"}.get(re.search(r"G4[39]|$", line)[0], state)  # type: ignore[index]
        assert not (state == "on" and re.search(r"G69|G68|M6|G53(?!\.)|M30", line)), line
    return text


def read(text: str, folder: Path) -> Toolpath:
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    return read_cl(file)


def body(text: str) -> list[str]:
    """Blocks without numbers and comments, from the first tool to the end of the last operation."""
    lines = [line.partition(" ")[2] for line in text.splitlines() if line.startswith("N")]
    return lines[lines.index("T1 M6") + 1 : -2]
