"""Random programs against a naive twin, the kernel against the interpreter, anybody's programs, and real files."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz import oracle
from tests.reader.conftest import close
from trunnion.machine import load_machine
from trunnion.reader import Run, run_program
from trunnion.reader.linuxcnc.interpreter import LinuxCNCInterpreter
from trunnion.toolpath import Kind

DMU65 = load_machine("dmu65")
FOLDER = Path(__file__).parents[4] / "shared" / "data" / "linuxcnc"


def ran(text: str, factory: pytest.TempPathFactory) -> Run:
    """Run a text."""
    path = factory.getbasetemp() / "program.ngc"
    path.write_text(text)
    return run_program(path, DMU65, family="linuxcnc")


value = st.integers(-99_000, 99_000).map(lambda n: n / 1000.0)
blocks = st.lists(
    st.tuples(
        st.sampled_from(["", "G0", "G1", "G90", "G91", "G20", "G21", "G0 G91"]),
        st.dictionaries(st.sampled_from("XYZ"), value, max_size=3),
        st.one_of(st.none(), st.integers(1, 9000)),
    ),
    max_size=20,
)


@settings(max_examples=200, deadline=None)
@given(blocks=blocks, glue=st.booleans())
def test_blocks_lead_where_the_twin_says(
    blocks: list[tuple[str, dict[str, float], int | None]], glue: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    place, kind, absolute, unit, feed = {"X": 0.0, "Y": 0.0, "Z": 0.0}, "G1", True, 1.0, math.nan
    rows, lines = [], ["G1"]
    for codes, axes, new in blocks:
        for code in codes.split():
            kind = code if code in ("G0", "G1") else kind
            absolute = {"G90": True, "G91": False}.get(code, absolute)
            unit = {"G20": 25.4, "G21": 1.0}.get(code, unit)
        feed = feed if new is None else new * unit
        for name, number in axes.items():
            place[name] = number * unit + (0.0 if absolute else place[name])
        words = [codes, *(f"{name}{number:.3f}" for name, number in axes.items()), "" if new is None else f"F{new}"]
        lines.append(("" if glue else " ").join(words))
        if axes:
            rows.append([*place.values(), feed, kind == "G0"])
    run = ran("\n".join(lines), tmp_path_factory)
    assert run.findings == ()
    assert len(run) == len(rows)
    if rows:
        wanted = np.array(rows)
        close(run.tip, wanted[:, :3], atol=1e-9)
        np.testing.assert_allclose(run.feed, wanted[:, 3])
        np.testing.assert_array_equal(run.kind == Kind.RAPID, wanted[:, 4] > 0)


words = st.sampled_from(
    [
        "G0", "G1", "G01", "G2", "G20", "G91", "G80", "G81", "G93", "X1", "Y-2.5", "Z+.5", "X 3", "X", "X=5", "A-30",
        "C+45", "B2", "F100", "F 100", "N5", "N07", "N", "R2", "Q1", "I1", ";c", "(c)", "(", "/", "%", "X#1", "#1=2",
        "X[1]", "M3", "M428", "M429", "T1", "G1.", "G1.5", "- 5", "X- 5", "X1.2.3", "x4",
        "X1234567890123456", "X123456",
        "A3=1", "X1Y2",
    ]
)  # fmt: skip


@settings(max_examples=250, deadline=None)
@given(lines=st.lists(st.lists(words, max_size=6), max_size=8))
def test_the_kernel_and_the_interpreter_read_any_words_alike(
    lines: list[list[str]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = "\n".join(" ".join(said) for said in lines)
    fast = ran(text, tmp_path_factory)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(LinuxCNCInterpreter, "_may_be_plain", lambda *_: False)
        slow = ran(text, tmp_path_factory)
    assert sorted(map(str, fast.findings)) == sorted(map(str, slow.findings))
    assert fast.events == slow.events
    assert fast.comments == slow.comments
    for name in ("block", "number", "kind", "programmed", "place", "rotary", "tip", "axis", "joints", "feed", "tcp"):
        np.testing.assert_array_equal(getattr(fast, name), getattr(slow, name), err_msg=name)


@settings(max_examples=200, deadline=None)
@given(
    lines=st.lists(
        st.lists(st.one_of(words, st.text("GMXYZABCIJKRQ0123456789.-+[]#<>()/*; ", max_size=8))), max_size=12
    ),
    key=st.sampled_from(["dmu65", "generic_head_head_ca"]),
)
def test_any_program_is_run_or_refused(
    lines: list[list[str]], key: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = "\n".join(" ".join(said) for said in lines)
    oracle.judge_program(text.encode(), tmp_path_factory.getbasetemp(), key, family="linuxcnc")


@settings(max_examples=100, deadline=None)
@given(data=st.binary(max_size=300))
def test_any_bytes_are_run_or_refused(data: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    oracle.judge_program(data, tmp_path_factory.getbasetemp(), "dmu65", family="linuxcnc")


# Real files


@pytest.mark.skipif(not FOLDER.is_dir(), reason="shared/data/linuxcnc is not beside the repository")
@pytest.mark.parametrize(
    ("name", "key"), [("boat-xyzac", "dmu65"), ("boat-xyzbc", "yl569"), ("impeller-7bl-xyzac", "dmu65")]
)
def test_real_programs_lead_where_a_plain_scan_says(name: str, key: str) -> None:
    path = FOLDER / f"{name}.ngc"
    run = run_program(path, load_machine(key), family="linuxcnc")
    assert [f for f in run.findings if "machine positions while TCP" not in f.text] == []
    place: dict[str, float] = dict.fromkeys("XYZABC", 0.0)
    wanted = []
    for raw in path.read_text(encoding="latin-1").splitlines():
        line = re.sub(r"\(.*?\)|;.*", "", raw).replace(" ", "").upper()
        found = {axis: float(number) for axis, number in re.findall(r"([XYZABC])([-+]?[\d.]+)", line)}
        if found and "G53" not in line:
            place.update(found)
            wanted.append(list(place.values()))
        elif found:
            wanted.append([math.nan] * 6)
    table = np.array(wanted)
    assert len(run) == len(table)
    linear = ~np.isnan(table[:, 0])
    close(run.tip[linear], table[linear][:, :3], atol=1e-9)
    for column in run.machine.rotary:
        letter = "XYZABC".index(run.machine.axes[column].name)
        close(run.joints[linear, column], table[linear, letter], atol=1e-9)
