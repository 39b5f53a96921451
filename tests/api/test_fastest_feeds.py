"""Feeds per block that the machine can follow: what is written, what proves it, and that the proof finds any fault."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import trunnion
from tests.support.published_path import LIMITS, PATH
from tests.support.rewind_paths import round_part
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.api.expectation import Expectation, expectation
from trunnion.api.fastest_feeds import raised_feeds, rounded_down, with_reached_feeds
from trunnion.api.job import prepare
from trunnion.api.planning import plan_program
from trunnion.api.settings import Settings, SettingValue
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError
from trunnion.machines import Machine, load_machine
from trunnion.model.deviations import Deviations
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.timing import fastest_run, steady
from trunnion.verification import Check, Verification, verify
from trunnion.verification.deviations import reached_rows

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


@pytest.fixture(scope="module")
def lowered(tmp_path_factory: pytest.TempPathFactory) -> Posted:
    return posted(tmp_path_factory.mktemp("lowered"), load_machine("xyzac_trt"), {"numbers": "off"})


def feed_word(line: str) -> str:
    return next((word for word in line.split() if word[0] == "F" and word[1:2].isdigit()), "")


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


@pytest.mark.parametrize(
    "wrong",
    [{"feed_limit": 3000}, {"feed": "fast"}, {"feed": "fastest", "feed_limit": [1]}, {"feed": "fastest", "cl": ()}],
)
def test_arguments_of_verify_that_make_no_sense_are_refused(wrong: dict[str, object]) -> None:
    given = {"machine": "yl569", "cl": GOLDEN / "yl569/2_hub_rough.cls", **wrong}
    with pytest.raises(InputError, match="feed"):
        trunnion.verify(GOLDEN / "yl569/2_hub_rough.expected.mpf", **given)  # type: ignore[arg-type]


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


def test_feeds_are_those_that_the_axes_reach_by_closed_form(tmp_path: Path) -> None:
    """One line of 1 mm from rest to rest, at 300 mm/s²: v² = a d."""
    cl = CL_HEAD.replace("500.0", "6000.0") + "GOTO/0.0,0.0,50.0\nSTOP\nGOTO/1.0,0.0,50.0\nSTOP\n" + CL_FOOT
    found = posted(tmp_path, load_machine("xyzac_trt"), {}, cl)
    assert found.failed() == []
    exact = 60.0 * math.sqrt(300.0 * 1.0)
    assert found.deviations.reached_feed.tolist() == [math.floor(exact / 10.0) * 10.0]


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


#: Blocks of a cut without phases, each with the feed of the CL file, and whether it plunges.
SLOPES = {
    "GOTO/0,0,-5": True,
    "GOTO/10,0,-5": False,
    "GOTO/20,0,-14.9": False,
    "GOTO/30,0,-25": True,
    "GOTO/30,0,5": False,
    "GOTO/35.3,0,-0.3,0.707106781,0,0.707106781": False,
    "GOTO/30.3,0,-5.3,0.707106781,0,0.707106781": True,
}


def slopes() -> str:
    """At 400 mm/min and without phases."""
    head = CL_HEAD.replace("500.0", "400.0").replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0", "GOTO/0,0,50\nRAPID\nGOTO/0,0,3")
    return head + "\n".join(SLOPES) + "\n" + CL_FOOT


def test_a_feed_limit_leaves_plunges_alone_and_tells_what_it_raises(tmp_path: Path) -> None:
    found = posted(tmp_path, able("xyzac_trt"), {"feed_limit": "1000"}, slopes())
    assert found.failed() == []
    motion = found.program.motions[0]
    assert motion.cl_rows is not None
    ends = np.flatnonzero(np.diff(motion.cl_rows, append=-1))
    feeds = motion.operation.moves.feed[ends[-len(SLOPES) :]]
    assert [feed == 400.0 for feed in feeds.tolist()] == list(SLOPES.values())
    raised = raised_feeds(found.program, [found.path])
    assert [problem.what for problem in raised] == [
        "3 blocks cut faster than the CL file says, up to 2.5 times as fast: feed_limit"
    ]
    assert raised_feeds(posted(tmp_path, able("xyzac_trt"), {}, slopes()).program, [found.path]) == []


def test_the_proof_finds_a_plunge_that_is_raised(tmp_path: Path) -> None:
    found = posted(tmp_path, able("xyzac_trt"), {"feed_limit": "1000"}, slopes())
    plunge = 2
    assert plunge not in found.deviations.reached_rows
    rows = np.sort(np.append(found.deviations.reached_rows, plunge))
    feed = np.full(len(rows), 1000.0)
    raised = [line.replace("F400.0", "F1000.0").replace("F400", "F1000") for line in found.text]
    assert "reach" in found.failed(raised, replace(found.deviations, reached_rows=rows, reached_feed=feed))


@pytest.mark.parametrize("name", ["haas_umc750", "linuxcnc_5axis", "dmu65", "yl569"])
def test_an_arc_has_the_feed_that_the_slides_keep_up_all_the_way(name: str, tmp_path: Path) -> None:
    """v² = a r where one slide bends the path alone; in between both could go faster."""
    arc = (
        "GOTO/0,0,5\nGOTO/40,0,5\nCIRCLE/40.0,10.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/40,20,5\nGOTO/0,20,5\n"
    )
    source = tmp_path / "arc.cls"
    source.write_text(CL_HEAD.replace("500.0", "8000.0") + arc + CL_FOOT, encoding="utf-8")
    run = trunnion.post(source, machine=able(name, 500.0), settings=FASTEST).run
    assert run is not None
    feeds = run.feed[run.arcs.row]
    most = 60.0 * math.sqrt(500.0 * 10.0)
    assert len(feeds) == 1
    assert 0.97 * most < feeds[0] <= most


@pytest.mark.parametrize(
    ("speeds", "found"),
    [([1, 2, 3, 2], 3), ([1, 3, 2, 3, 1], 2), ([1, 4, 2, 3, 1, 5, 1], 1), ([2], 2), ([3, 3, 3], 3), ([5, 1, 4], 1)],
)
def test_steady_speeds(speeds: list[float], found: float) -> None:
    assert steady(np.array(speeds, np.float64)) == found


FAMILIES = ["yl569", "dmu65", "haas_umc750", "hs664rt", "matsuura_mx330", "mikron_600u", "linuxcnc_5axis", "xyzbc_trt"]

#: What these controls lack.
NOT_TOLD = {("linuxcnc_5axis", "on"), ("hs664rt", "off")}

PLACED: dict[str, SettingValue] = {"zero": (0.0, 0.0, 0.0), "tool_length": 100.0}


@pytest.mark.parametrize(
    ("name", "tcp"),
    [(name, tcp) for name in FAMILIES for tcp in ("on", "off") if (name, tcp) not in NOT_TOLD],
)
def test_every_family_of_controls(name: str, tcp: str, tmp_path: Path) -> None:
    source = tmp_path / "waves.cls"
    source.write_text(waves(), encoding="utf-8")
    machine = able(name)
    settings: Settings = {**PLACED, "tcp": tcp}
    before = trunnion.post(source, machine=machine, settings=settings)
    found = trunnion.post(source, machine=machine, settings={**settings, **FASTEST})
    summary = check_of(found, "reach").summary
    assert "at 0 of" not in summary
    assert found.verification is not None
    assert before.verification is not None
    slower = found.verification.seconds.sum() / before.verification.seconds.sum()
    assert 1.0 - 1e-6 <= slower < 1.02, summary


@pytest.mark.parametrize(
    ("cl", "settings"),
    [
        ("yl569/1_contour_rough.cls", {"feed_limit": 30000}),
        ("fanuc/flange.cls", {"feed_limit": 30000}),
        ("fanuc/flange.cls", {"feed_limit": 30000, "cycles": "off"}),
        ("yl569/3_blade_finish.cls", {"feed_limit": 30000, "units": "inch"}),
        ("yl569/3_blade_finish.cls", {"feed_limit": 30000, "tcp": "off", "axis_tolerance": 0.01, **PLACED}),
    ],
    ids=["arcs", "cycles", "holes as motion", "inches", "points between"],
)
def test_arcs_holes_inches_and_points_between(cl: str, settings: Settings) -> None:
    found = trunnion.post(GOLDEN / cl, machine=able("yl569"), settings={**FASTEST, **settings})
    assert found.passed
    assert "at 0 of" not in check_of(found, "reach").summary


def _feeds_before_cycles(text: str) -> list[str]:
    """The F in force at each call of a cycle."""
    feed, found = "", []
    for line in text.splitlines():
        feed = feed_word(line) or feed
        if "MCALL CYCLE" in line:
            found.append(feed)
    return found


def test_feeds_of_cycles_stay() -> None:
    every: tuple[Settings, ...] = ({}, {**FASTEST, "feed_limit": 20000})
    plain, fast = (trunnion.post(GOLDEN / "fanuc/flange.cls", machine=able("yl569"), settings=each) for each in every)
    assert check_of(plain, "holes").summary == check_of(fast, "holes").summary
    holes = [_feeds_before_cycles(found.text or "") for found in (plain, fast)]
    assert holes[0] == holes[1]
    assert holes[0]


SPLINE = """GOTO/0,0,5,0,0,1
NURBS/
KNOT/0.25,0.5,1.0000000
CNTRL/0,1,5
CNTRL/1,2,5
CNTRL/2,2,5
CNTRL/3,1,6
CNTRL/3,0,5
"""


def test_a_spline_has_one_feed(tmp_path: Path) -> None:
    """The highest that is reached in it; as lines each has its own."""
    source = tmp_path / "spline.cls"
    source.write_text(CL_HEAD.replace("500.0", "6000.0") + SPLINE + CL_FOOT, encoding="utf-8")
    feeds = []
    for splines in ("polynomial", "linearize"):
        settings = {**FASTEST, "splines": splines}
        run = trunnion.post(source, machine=able("yl569"), settings=settings).run
        assert run is not None
        feeds.append(run.feed[(run.kind != 0) & (run.tip[:, 2] < 6.0) & (run.tip[:, 0] > 0.0)])
    assert len(np.unique(feeds[0])) == 1
    assert 100.0 < feeds[0][0] < 6000.0
    assert len(np.unique(feeds[1])) > 5


def test_rewinds_keep_their_feeds(tmp_path: Path) -> None:
    """Rows of a rewind lead to no point of the CL file, and the feeds behind them belong to the right points."""
    moves = round_part(400)
    points = [",".join(f"{value:.9f}" for value in point) for point in np.hstack((moves.tip, moves.axis)).tolist()]
    head = CL_HEAD.replace("500.0", "20000.0").replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", f"GOTO/{points[0]}\n")
    source = tmp_path / "round.cls"
    source.write_text(head + "".join(f"GOTO/{point}\n" for point in points) + CL_FOOT, encoding="utf-8")
    found = trunnion.post(source, machine=able("generic_head_head_ca"), settings=FASTEST)
    assert any("rewind" in problem.what for problem in found.problems)
    assert found.passed
    rows = [motion.cl_rows for motion in found.motions if motion.cl_rows is not None]
    assert (np.concatenate(rows) == -1).any()


def test_a_program_in_several_files(tmp_path: Path) -> None:
    found = trunnion.post(
        [GOLDEN / "yl569/2_hub_rough.cls", GOLDEN / "yl569/3_blade_finish.cls"],
        machine=able("yl569"),
        output=tmp_path / "main.mpf",
        settings={**FASTEST, "feed_limit": 30000, "programs": "operations"},
    )
    assert found.passed
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(
        [file.name for file in found.subprograms] + ["main.mpf"]
    )


def test_no_feed_is_lowered_to_that_of_rapids(tmp_path: Path) -> None:
    """On a Fidia a line at the rapid feed is a rapid."""
    source = tmp_path / "waves.cls"
    source.write_text(waves(), encoding="utf-8")
    run = trunnion.post(source, machine=able("hs664rt"), settings=FASTEST).run
    assert run is not None
    feeds = run.feed[run.kind != 0]
    rapid = float(np.median(feeds[feeds < 2000.0]))
    found = trunnion.post(source, machine=able("hs664rt"), settings={**FASTEST, "rapid_feed": rapid})
    assert found.passed
    assert found.run is not None
    assert ((found.run.feed > 0.98 * rapid) & (found.run.feed < rapid) & (found.run.kind != 0)).any()


def test_feeds_per_revolution_stay(tmp_path: Path) -> None:
    source = tmp_path / "turn.cls"
    source.write_text(waves().replace("FEDRAT/MMPM,6000.0", "FEDRAT/MMPR,6.0"), encoding="utf-8")
    plain, fast = (trunnion.post(source, machine=able("yl569"), settings=each) for each in ({}, FASTEST))
    assert fast.text == plain.text
    assert check_of(fast, "reach").summary == "nothing is cut at a feed per minute"


def test_a_feed_limit_stands_for_feeds_that_the_cl_file_does_not_have(tmp_path: Path) -> None:
    source = tmp_path / "no_feed.cls"
    feed = "FEDRAT/MMPM,6000.0\n"
    source.write_text(waves().replace(feed, ""), encoding="utf-8")
    machine = load_machine("xyzac_trt")
    with pytest.raises(InputError, match="cutting motion without a feed"):
        trunnion.post(source, machine=machine, settings=FASTEST)
    with pytest.raises(InputError, match="feed_limit is for cuts that do not plunge"):
        trunnion.post(source, machine=machine, settings={**FASTEST, "feed_limit": 6000})
    source.write_text(waves().replace(feed, "RAPID\n"), encoding="utf-8")
    found = trunnion.post(source, machine=machine, settings={**FASTEST, "feed_limit": 6000})
    source.write_text(waves().replace(feed, feed + "RAPID\n"), encoding="utf-8")
    assert found.text == trunnion.post(source, machine=machine, settings=FASTEST).text


def test_without_limits_in_reach_the_program_stays_as_it_is(tmp_path: Path) -> None:
    source = tmp_path / "slow.cls"
    source.write_text(waves(60.0), encoding="utf-8")
    texts = [trunnion.post(source, machine="xyzac_trt", settings=each).text for each in ({}, FASTEST)]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("settings", [{}, {"pole": "lean", "pole_angle": "0.001"}])
def test_no_advice_names_a_setting_that_is_refused(settings: dict[str, str], tmp_path: Path) -> None:
    source = tmp_path / "waves.cls"
    source.write_text(waves(60000.0), encoding="utf-8")
    job = prepare(load_machine("xyzac_trt"), {**FASTEST, **settings}, explain=True)
    _, plan, _ = plan_program([read_cl(source)], job)
    told = [str(each) for each in (*plan.decisions, *plan.problems)]
    assert any("feed=fastest lowers the feed there" in text for text in told)
    assert not any("lower_feed" in text for text in told)


def test_accelerations_that_nobody_states_are_told() -> None:
    found = trunnion.post(GOLDEN / "yl569/2_hub_rough.cls", machine="yl569", settings=FASTEST)
    assert any("states no acceleration of C, B, X, Y, Z" in problem.what for problem in found.problems)


@pytest.mark.parametrize(
    ("settings", "what"),
    [
        ({"feed_limit": 3000}, "feed_limit is for feed=fastest only"),
        ({"feed": "fastest", "lower_feed": "yes"}, "lower_feed is yes"),
        ({"feed": "fast"}, "feed is 'fast'"),
        ({"feed": "fastest", "feed_limit": 0}, "feed_limit is '0'"),
        ({"feed": "fastest", "feed_limit": "much"}, "feed_limit is 'much'"),
    ],
)
def test_settings_that_make_no_sense_are_refused(settings: dict[str, str], what: str) -> None:
    with pytest.raises(InputError, match=what):
        prepare(load_machine("yl569"), settings)


@given(
    st.floats(0.05, 99999.0),
    st.integers(0, 3),
    st.sampled_from([1.0, 25.4]),
)
def test_feeds_are_rounded_down_to_three_digits(feed: float, decimals: int, unit: float) -> None:
    number_format = NumberFormat(decimals, least=0.001, unit=unit)
    down = float(rounded_down(np.array([feed]), number_format)[0])
    digits = str(number_format.count(down)).rstrip("0")
    assert len(digits) <= 3
    assert down == number_format.rounded(down) > 0.0
    assert down <= max(feed * (1.0 + 1e-9), number_format.digit)
    assert feed <= down * 1.0102 + number_format.digit


def published(folder: Path, rows: int) -> tuple[Path, Path]:
    """The published path as a CL file of some points, and its machine: A under C, all centres at the zero."""
    turn = 'kind = "rotary"\ncarries = "part"\npoint_mm = [0, 0, 0]\npositive = "reversed"\n'
    slide = 'kind = "linear"\nlimits_mm = [-500, 500]\nhome_mm = 0\n'
    text = 'schema = 1\nname = "published"\ndescription = "A under C"\n[control]\nextends = "linuxcnc"\n'
    axes = (
        ("C", 4, turn + 'direction = [0, 0, 1]\nendless = true\noutput = "none"\n'),
        ("A", 3, turn + "direction = [1, 0, 0]\nlimits_deg = [-100, 100]\n"),
        ("X", 0, slide + 'carries = "part"\ndirection = [1, 0, 0]\n'),
        ("Y", 1, slide + 'carries = "part"\ndirection = [0, 1, 0]\n'),
        ("Z", 2, slide + 'carries = "tool"\ndirection = [0, 0, 1]\n'),
    )
    for name, k, words in axes:
        unit, scale = ("mm", 1.0) if k < 3 else ("deg", math.degrees(1.0))
        limits = [scale * float(each[k]) for each in (60.0 * LIMITS.speed, LIMITS.acceleration, LIMITS.jerk)]
        text += f'[[axis]]\nname = "{name}"\n{words}rapid_{unit}_min = {limits[0]!r}\n'
        text += f"acceleration_{unit}_s2 = {limits[1]!r}\njerk_{unit}_s3 = {limits[2]!r}\n"
    machine = folder / "published.toml"
    machine.write_text(text, encoding="utf-8")
    x, y, z, a, c = PATH.derivatives(np.linspace(0.0, 1.0, rows), np.zeros(rows, np.bool_))[0].T
    # Back from the axes: first out of A, then out of C.
    y, z = np.cos(a) * y + np.sin(a) * z, -np.sin(a) * y + np.cos(a) * z
    x, y = np.cos(c) * x + np.sin(c) * y, -np.sin(c) * x + np.cos(c) * y
    i, j, k = np.sin(a) * np.sin(c), np.sin(a) * np.cos(c), np.cos(a)
    points = [",".join(f"{value:.9f}" for value in point) for point in np.stack((x, y, z, i, j, k), axis=1).tolist()]
    lines = [f"GOTO/{point}\n" for point in points]
    head = CL_HEAD.replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", lines[0])
    source = folder / "published.cls"
    source.write_text(head + "".join(lines[1:]) + CL_FOOT, encoding="utf-8")
    return source, machine


def test_the_published_path(tmp_path: Path) -> None:
    """A control that stops for no corner still needs more than the fastest run; feeds are none that the axes miss."""
    source, machine = published(tmp_path, 401)
    least = fastest_run(PATH, LIMITS, 100).duration
    seconds = []
    every: tuple[Settings, ...] = ({}, FASTEST, {**FASTEST, "feed_limit": 20000})
    for settings in every:
        found = trunnion.post(source, machine=machine, settings=settings)
        assert found.passed
        assert found.verification is not None
        assert found.run is not None
        seconds.append(float(found.verification.seconds[found.run.kind != 0].sum()))
        if settings:
            assert "at 0 of" not in check_of(found, "reach").summary
            assert len(np.unique(found.run.feed[found.run.kind != 0])) > 100
            assert all(share.worst is None or share.worst < 1.2 for share in [check_of(found, "acceleration")])
    plain, bounded, limited = seconds
    assert least < plain < bounded < 1.05 * plain
    assert least < limited < 1.15 * plain


def test_the_command_line_says_it_by_an_option_or_a_setting(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "waves.cls"
    source.write_text(waves(rows=5), encoding="utf-8")
    post = ["post", str(source), "--machine", "xyzac_trt", "--output"]
    for name, words in (("one", ["--feed", "fastest"]), ("two", ["--set", "feed=fastest"])):
        assert main([*post, str(tmp_path / f"{name}.ngc"), *words]) == 0
        assert "reach         ok    lower than in the CL file at" in capsys.readouterr().err
    one, two = ((tmp_path / f"{name}.ngc").read_bytes() for name in ("one", "two"))
    assert one == two
    with pytest.raises(SystemExit):
        main([*post, str(tmp_path / "three.ngc"), "--feed", "fastest", "--set", "feed=programmed"])
    assert "--feed and --set feed=… are the same" in capsys.readouterr().err
    assert not (tmp_path / "three.ngc").exists()
    verify_it = ["verify", str(tmp_path / "one.ngc"), "--machine", "xyzac_trt", "--cl", str(source)]
    assert main([*verify_it, "--feed", "fastest"]) == 0
    assert "reach         ok" in capsys.readouterr().out
    assert main(verify_it) == 1
