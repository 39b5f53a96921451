"""Every control on every shipped machine: families of paths, written, read back and proven.

A path is proven, or refused for the reason in ``expected``. A control that is not named there may refuse any path, as
long as it gives a reason and leaves no program. ``make.py test`` has a covering array of the matrix.
"""

import io
from contextlib import redirect_stderr, redirect_stdout
from itertools import count, product
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.matrix.covering import ALL_CYCLES, MACHINES, PATHS, cases, covering
from tests.support.matrix.expected import FAMILIES, PAGE, REFUSED, SOMETIMES, page
from tests.support.matrix.pairs import CONTROLS, FEW, Pair, check_proven, check_refused, pair_of, posted, simplest
from tests.support.matrix.paths import CYCLES, cycles, off_the_pole
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.model.motion import MachiningMode


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("matrix")


@pytest.mark.parametrize(("name", "control", "path"), cases(tuple(FAMILIES)))
def test_every_control_moves_every_machine(name: str, control: str, path: str, folder: Path) -> None:
    pair = pair_of(control, name, folder)
    family, asked = FAMILIES[path]
    drawn = count()

    @FEW
    @given(st.composite(family)(pair.machine))
    def every(text: str) -> None:
        if next(drawn) == 0 and not meets_simplest(name, control, path):
            return
        done = posted(text, pair, folder, asked)
        reasons = REFUSED.get(pair.family)
        if reasons is not None and path in reasons and not (path.startswith("simultaneous") and stands(text, pair)):
            check_refused(done, reasons[path])
        elif done.code and (reasons is None or (path in SOMETIMES and pair.folds)):
            check_refused(done, SOMETIMES.get(path, "") if reasons is not None else "")
        else:
            check_proven(done, pair, asked)

    every()


def meets_simplest(name: str, control: str, path: str) -> bool:
    """Whether a pair also has the simplest path, which is drawn first: a third of each machine's and control's."""
    return (MACHINES.index(name) + CONTROLS.index(control) + PATHS.index(path)) % 3 == 0


def stands(text: str, pair: Pair) -> bool:
    """Whether the tool axis of a cut is the same throughout, so that it is made in a plane, where there are any."""
    axes = {tuple(line.split(",")[3:]) for line in text.splitlines() if line.startswith("GOTO") and line.count(",") > 2}
    return len(axes) == 1 and MachiningMode.TILTED in pair.control.modes({})


@pytest.mark.parametrize(("name", "control", "path"), cases([ALL_CYCLES]))
def test_all_cycles_that_a_control_has_are_proven(name: str, control: str, path: str, folder: Path) -> None:
    pair = pair_of(control, name, folder)
    refused = REFUSED.get(pair.family)
    if refused is None:
        refused = {mode: "" for mode in CYCLES if posted(simplest(mode), pair, folder, ()).code}

    drawn = count()

    @FEW
    @given(st.composite(cycles([mode for mode in CYCLES if mode not in refused]))(pair.machine))
    def every(text: str) -> None:
        if next(drawn) == 0 and not meets_simplest(name, control, path):
            return
        check_proven(posted(text, pair, folder, ()), pair, ())

    every()


@pytest.mark.third
@pytest.mark.parametrize("mode", CYCLES)
@pytest.mark.parametrize("control", CONTROLS)
def test_cycles_are_refused_for_the_reason_that_is_said(control: str, mode: str, folder: Path) -> None:
    pair = pair_of(control, "generic_head_table_bc", folder)
    done, reasons = posted(simplest(mode), pair, folder, ()), REFUSED.get(pair.family)
    if done.code or (reasons is not None and mode in reasons):
        assert reasons is None or mode in reasons, done.err
        check_refused(done, reasons[mode] if reasons is not None else "")


@pytest.mark.third
@pytest.mark.parametrize("control", ["heidenhain_tnc640", "linuxcnc", "sinumerik_840d"])
@pytest.mark.parametrize("name", [name for name in MACHINES if load_machine(name).has_rotary_head] + ["dmu65", "yl569"])
def test_where_a_head_turns_the_tool_a_program_without_tcp_is_for_one_length(
    name: str, control: str, folder: Path
) -> None:
    pair, zero = pair_of(control, name, folder), "10,-20,30"
    check = ["verify", str(folder / "part.nc"), "--cl", str(folder / "part.cls"), "--machine", str(pair.file)]

    def verified(length: float) -> bool:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            return main([*check, "--zero", zero, "--span", "0.06", "--tool-length", str(length)]) == 0

    @FEW
    @given(st.composite(off_the_pole)(pair.machine), st.floats(10.0, 300.0), st.floats(20.0, 90.0))
    def every(text: str, length: float, more: float) -> None:
        asked = "tcp=off", f"zero={zero}", f"tool_length={length:.3f}"
        check_proven(posted(text, pair, folder, asked), pair, asked)
        assert verified(round(length, 3))
        assert verified(round(length + more, 3)) != (pair.machine.has_rotary_head and not stands(text, pair))

    every()


def test_the_array_has_each_machine_and_each_control_with_each_family_of_paths() -> None:
    array = [(name, control, covering(name, control)) for name in MACHINES for control in CONTROLS]
    assert {(name, path) for name, _, path in array} == set(product(MACHINES, PATHS))
    assert {(control, path) for _, control, path in array} == set(product(CONTROLS, PATHS))


def test_the_page_says_what_is_refused() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()
