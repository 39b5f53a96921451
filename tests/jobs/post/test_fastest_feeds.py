"""Feeds per block that the machine can follow: what is written, of every kind of motion and for every control."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import trunnion
from tests.support.fastest_feeds import FASTEST, GOLDEN, able, check_of, feed_word, posted, waves
from tests.support.published_path import LIMITS, PATH
from tests.support.rewind_paths import round_part
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.controls.words import NumberFormat
from trunnion.jobs.inputs.settings import Settings, SettingValue
from trunnion.jobs.post.fastest_feeds import rounded_down
from trunnion.machines import load_machine
from trunnion.timing import fastest_run, steady


def test_feeds_are_those_that_the_axes_reach_by_closed_form(tmp_path: Path) -> None:
    """One line of 1 mm from rest to rest, at 300 mm/s²: v² = a d."""
    cl = CL_HEAD.replace("500.0", "6000.0") + "GOTO/0.0,0.0,50.0\nSTOP\nGOTO/1.0,0.0,50.0\nSTOP\n" + CL_FOOT
    found = posted(tmp_path, load_machine("xyzac_trt"), {}, cl)
    assert found.failed() == []
    exact = 60.0 * math.sqrt(300.0 * 1.0)
    assert found.deviations.reached_feed.tolist() == [math.floor(exact / 10.0) * 10.0]


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


@pytest.mark.third
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


@pytest.mark.third
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
