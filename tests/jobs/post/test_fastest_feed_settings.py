"""Feeds per block that the machine can follow: limits, settings and arguments, and what is told of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.fastest_feeds import FASTEST, GOLDEN, able, posted, waves
from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.errors import InputError
from trunnion.jobs.post.fastest_feeds import raised_feeds
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import prepare
from trunnion.machines import load_machine


@pytest.mark.parametrize(
    "wrong",
    [{"feed_limit": 3000}, {"feed": "fast"}, {"feed": "fastest", "feed_limit": [1]}, {"feed": "fastest", "cl": ()}],
)
def test_arguments_of_verify_that_make_no_sense_are_refused(wrong: dict[str, object]) -> None:
    given = {"machine": "yl569", "cl": GOLDEN / "yl569/2_hub_rough.cls", **wrong}
    with pytest.raises(InputError, match="feed"):
        trunnion.verify(GOLDEN / "yl569/2_hub_rough.expected.mpf", **given)  # type: ignore[arg-type]


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
