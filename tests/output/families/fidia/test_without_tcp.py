"""Fidia without TCP while rotary axes turn: only for machines whose definition states what F counts."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.support.matrix.expected import WITHOUT_TCP
from tests.support.matrix.pairs import FEW, Pair, check_proven, check_refused, pair_of, posted
from tests.support.matrix.paths import CYCLES, off_the_pole, operation, reachable, square, words
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.jobs.inputs.stated_setup import apply_setup
from trunnion.machines import Machine, load_machine
from trunnion.model.feed_path import FeedPath
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, failures, verify

MACHINES = ("generic_head_table_bc", "hs664rt", "linuxcnc_5axis")
RULES = {"slides": FeedPath.SLIDES, "all_axes": FeedPath.AXES}


def stated(name: str, folder: Path, written: str, read: str) -> Pair:
    """A machine with a Fidia that knows what F counts: one word for the writer, one for the reader."""
    pair = pair_of("fidia_nc15", name, folder)
    file = folder / f"{name}_{written}_{read}.toml"
    control = f'[control]\nfeed_without_tcp = "{written}"\n[control.reading]\nfeed_without_tcp = "{read}"\n'
    file.write_text(f'extends = "{pair.file.name}"\n{control}', encoding="utf-8")
    machine = load_machine(file)
    return Pair(pair.name, file, machine, load_control(machine.control))


def known(machine: Machine) -> Machine:
    return apply_setup(machine, dict(setting.split("=") for setting in WITHOUT_TCP))


def cut(machine: Machine) -> str:
    """Both rotary axes turn on the way."""
    axes = reachable(machine, [(0.1 + 0.02 * k, 0.7 + 0.015 * k) for k in range(6)])
    tips = np.arange(6)[:, None] * np.array([2.0, 1.5, -1.0])
    text = "".join(f"GOTO/{words(tip, axis)}\n" for tip, axis in zip(tips, axes, strict=True))
    return operation("CUT", f"RAPID\nGOTO/{words(tips[0] + 50.0 * axes[0], axes[0])}\nFEDRAT/MMPM,800\n{text}")


@pytest.mark.third
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name", MACHINES)
def test_where_the_definition_says_what_f_counts_programs_are_proven(name: str, rule: str, tmp_path: Path) -> None:
    pair = stated(name, tmp_path, rule, rule)

    @FEW
    @given(st.composite(off_the_pole)(pair.machine))
    def every(text: str) -> None:
        done = posted(text, pair, tmp_path, WITHOUT_TCP)
        # How far M242 retracts is not known: on a head the way from there may lead through the part, and is refused.
        assume("the way from home leads through the part" not in done.err)
        check_proven(done, pair, WITHOUT_TCP)
        run = run_program(done.program, known(pair.machine))
        assert (run.state.feed_path.at(np.arange(len(run))) == RULES[rule]).all()

    every()


def test_another_rule_in_the_proof_finds_the_feeds_wrong(tmp_path: Path) -> None:
    pair = stated("hs664rt", tmp_path, "slides", "slides")
    done = posted(cut(pair.machine), pair, tmp_path, WITHOUT_TCP)
    other = known(stated("hs664rt", tmp_path, "slides", "all_axes").machine)
    asked = ExpectedValues(rapid_feed=3000.0, span_tip=0.005, span=0.05)
    for machine, failed in ((known(pair.machine), []), (other, ["feed"])):
        found = verify(run_program(done.program, machine), [read_cl(done.cl)], settings=asked, columns=False)
        assert [check.key for check in failures(found) if check.key == "feed"] == failed


def test_where_nobody_says_it_the_refusal_names_the_cure(tmp_path: Path) -> None:
    pair = pair_of("fidia_nc15", "hs664rt", tmp_path)
    done = posted(cut(pair.machine), pair, tmp_path, WITHOUT_TCP)
    check_refused(done, "the control does not support the mode without TCP; write feed_without_tcp =")


def test_no_cut_is_printed_at_the_feed_of_rapids(tmp_path: Path) -> None:
    """It would be read as a rapid: the F next to it is as good."""
    pair = stated("hs664rt", tmp_path, "slides", "slides")
    for rapid in range(520, 860, 20):
        done = posted(cut(pair.machine), pair, tmp_path, (*WITHOUT_TCP, f"rapid_feed={rapid}"))
        check_proven(done, pair, WITHOUT_TCP)


def test_holes_along_several_axes_are_motion_there(tmp_path: Path) -> None:
    """In one operation with a cut on which the tool axis changes, so that there are no planes."""
    pair = stated("hs664rt", tmp_path, "slides", "slides")
    text = cut(pair.machine).removesuffix("END-OF-PATH\n")
    for share in ((0.2, 0.7), (0.3, 0.75)):
        axis = reachable(pair.machine, [share])[0]
        place, (x, _) = np.array([5.0, -8.0, 3.0]), square(axis)
        text += f"RAPID\nGOTO/{words(place + 60.0 * axis, axis)}\nCYCLE/{CYCLES['DRILL,DEEP']}\nGOTO/{words(place)}\n"
        text += f"GOTO/{words(place + 9.0 * x)}\nCYCLE/OFF\n"
    done = posted(f"{text}END-OF-PATH\n", pair, tmp_path, WITHOUT_TCP)
    check_proven(done, pair, WITHOUT_TCP)
    assert "4 holes, 4 of them by motion" in done.err
