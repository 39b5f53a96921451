"""Feeds per block that the machine can follow: what proves them, and that the proof finds any fault."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.fastest_feeds import FASTEST, Posted, able, check_of, feed_word, posted, waves
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.controls import load_control
from trunnion.jobs.inputs.settings import Settings
from trunnion.machines import load_machine
from trunnion.model.deviations import Deviations
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification.deviations import reached_rows


@pytest.fixture(scope="module")
def lowered(tmp_path_factory: pytest.TempPathFactory) -> Posted:
    return posted(tmp_path_factory.mktemp("lowered"), load_machine("xyzac_trt"), {"numbers": "off"})


def test_feeds_are_lowered_and_proven(lowered: Posted) -> None:
    found = lowered.verified()
    assert found.passed
    summary = check_of(found, "reach").summary
    assert summary.startswith("lower than in the CL file at 4")
    assert " % at most; " in summary
    assert summary.endswith(" at the feeds of the CL file")
    assert len({feed_word(line) for line in lowered.text}) > 10


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("haas_umc750", {}),
        ("yl569", {"feed_limit": 9000}),
        ("dmu65", {}),
        ("xyzac_trt", {}),
    ],
)
def test_a_program_can_be_proven_again_without_its_post(name: str, settings: Settings, tmp_path: Path) -> None:
    source, target = tmp_path / "waves.cls", tmp_path / f"waves{load_control(able(name).control).extension}"
    source.write_text(waves(), encoding="utf-8")
    trunnion.post(source, machine=able(name), output=target, settings={**FASTEST, **settings})
    limit = settings.get("feed_limit")

    def failed(feed: str = "fastest") -> set[str]:
        limited = {"feed_limit": limit} if feed == "fastest" else {}
        found = trunnion.verify(target, machine=able(name), cl=source, feed=feed, **limited)  # type: ignore[arg-type]
        return {check.key for check in found.checks if not check.passed}

    assert not failed() & {"feed", "reach"}
    assert "feed" in failed("programmed")
    text = target.read_text(encoding="utf-8")
    word = next(word for line in text.splitlines()[20:] if len(word := feed_word(line)) > 3)
    target.write_text(text.replace(word, f"F{float(word[1:]) * 1.1:.0f}."[: None if name != "dmu65" else -1], 1))
    assert "reach" in failed()


def test_feeds_have_three_digits_and_stand_only_where_they_change(lowered: Posted) -> None:
    words = [word for line in lowered.text if (word := feed_word(line))]
    assert all(len(word[1:].replace(".", "").strip("0")) <= 3 for word in words)
    assert all(one != two for one, two in pairwise(words))


def test_a_feed_that_is_off_or_missing_is_found_in_every_block(lowered: Posted) -> None:
    tried = 0
    for k, line in enumerate(lowered.text):
        if not (word := feed_word(line)):
            continue
        value = float(word[1:])
        other = (f"F{value * 1.01:.2f}", f"F{value * 0.99:.2f}", "")[tried % 3]
        tried += 1
        changed = [*lowered.text[:k], line.replace(word, other).strip(), *lowered.text[k + 1 :]]
        assert "feed" in lowered.failed(changed), (line, other)
    assert tried > 20


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_a_program_as_declared_fails_where_the_axes_reach_another_feed(lowered: Posted, factor: float) -> None:
    declared = lowered.deviations
    row = int(np.argmin(declared.reached_feed))
    feed = declared.reached_feed.copy()
    feed[row] = round(feed[row] * factor, 1)
    wrong = replace(lowered.program.motions[0].deviations, reached_feed=feed)
    moves = lowered.program.motions[0].operation.moves
    feeds = moves.feed.copy()
    feeds[lowered.program.motions[0].cl_rows == declared.reached_rows[row]] = feed[row]
    operation = replace(lowered.program.motions[0].operation, moves=replace(moves, feed=feeds))
    motion = replace(lowered.program.motions[0], operation=operation)
    target = lowered.folder / "declared.ngc"
    with target.open("wb") as sink:
        write_program(replace(lowered.program, motions=[motion]), sink)
    assert lowered.failed(target.read_text(encoding="utf-8").splitlines(), wrong) == ["reach"]


def test_a_feed_that_nobody_lowered_fails(lowered: Posted) -> None:
    """The program has the feeds of the CL file throughout, and declares no others."""
    motion = lowered.program.motions[0]
    moves = motion.operation.moves
    plain = replace(motion.operation, moves=replace(moves, feed=np.where(moves.feed > 0.0, 6000.0, moves.feed)))
    target = lowered.folder / "plain.ngc"
    with target.open("wb") as sink:
        write_program(replace(lowered.program, motions=[replace(motion, operation=plain)]), sink)
    text = target.read_text(encoding="utf-8").splitlines()
    assert lowered.failed(text, Deviations.none()) == ["reach"]


def test_a_declared_feed_above_that_of_the_cl_file_fails(lowered: Posted) -> None:
    feed = lowered.deviations.reached_feed.copy()
    feed[3] = 6100.0
    assert set(lowered.failed(deviations=replace(lowered.deviations, reached_feed=feed))) == {"feed", "reach"}


def test_a_declared_feed_at_a_rapid_fails(lowered: Posted) -> None:
    rows = np.concatenate(([0], lowered.deviations.reached_rows))
    feed = np.concatenate(([100.0], lowered.deviations.reached_feed))
    assert "feed" in lowered.failed(deviations=replace(lowered.deviations, reached_rows=rows, reached_feed=feed))


#: A cut at 3000 mm/min whose first move leans the tool by 3 degrees while the tip goes 0.11 mm, and on.
LEANING = "".join(
    f"GOTO/{-20.0 + 0.5 * k:.4f},{0.1 * math.sin(0.4 * k):.4f},5.0,{math.sin(a) * 0.9:.9f},{0.43589 * math.sin(a):.9f},"
    f"{math.cos(a):.9f}\n"
    for k, a in ((k, math.radians(-3.0 + 0.03 * k)) for k in range(9))
)


def leaning() -> str:
    head = CL_HEAD.replace("500.0", "200.0").replace("GOTO/0.0,0.0,50.0", "GOTO/-20.0,-0.11,50.0")
    return head + "GOTO/-20.0,-0.11,5.0\nFEDRAT/MMPM,3000.0\n" + LEANING + CL_FOOT


@pytest.mark.parametrize("settings", [{}, {"feed_limit": "9000"}])
def test_turns_with_the_tip_still_keep_the_feed_of_the_cl_file(settings: dict[str, str], tmp_path: Path) -> None:
    """The table turns before the tool leans; a feed of the lean would let the tool stand in the cut for minutes."""
    found = posted(tmp_path, able("dmu65"), settings, leaning())
    assert found.failed() == []
    run = run_program(tmp_path / f"again{found.program.control.extension}", found.machine)
    positions = run.positions(np.arange(len(run)))
    travel = np.linalg.norm(np.diff(positions.tip, axis=0), axis=1)
    turned = np.abs(np.diff(positions.joints[:, list(found.machine.rotary)], axis=0)).max(axis=1)
    still = np.flatnonzero((travel < 1e-3) & (turned > 5.0) & (run.kind[1:] != 0)) + 1
    assert len(still) == 1
    assert run.feed[still].tolist() == [3000.0]
    assert run.feed[still[0] + 1] < 2000.0
    line = int(run.line[still[0]])
    slow = list(found.text)
    slow[line - 1] = slow[line - 1].replace("F3000.0", "F36.0").replace("F3000", "F36")
    assert slow != found.text
    assert "feed" in found.failed(slow)


def test_a_program_that_would_take_far_longer_keeps_feeds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    machine = load_machine("xyzac_trt")
    source = tmp_path / "waves.cls"
    source.write_text(waves(), encoding="utf-8")
    lower = trunnion.post(source, machine=machine, settings=FASTEST)
    monkeypatch.setattr(reached_rows, "_LONGER", 1e-6)
    monkeypatch.setattr(reached_rows, "_LONGER_SECONDS", 0.0)
    found = trunnion.post(source, machine=machine, settings=FASTEST)
    assert "that of the CL file is kept at " in check_of(found, "reach").summary
    assert found.run is not None
    assert lower.run is not None
    assert np.nansum(found.run.feed) > np.nansum(lower.run.feed)


def test_the_proof_fails_a_program_that_takes_far_longer(lowered: Posted, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reached_rows, "_LONGER", 1e-6)
    monkeypatch.setattr(reached_rows, "_LONGER_SECONDS", 0.0)
    assert lowered.failed() == ["reach"]
    assert check_of(lowered.verified(), "reach").summary.startswith("far longer than it may be: ")
