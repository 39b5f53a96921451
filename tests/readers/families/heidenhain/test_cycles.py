"""Drilling cycles, as the motions at one hole that the manuals describe."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext_cycles import BEFORE, DRILL, define
from tests.support.reading import Runner, close
from trunnion.errors import Severity
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers.control.hole_motion import CycleExecutionError, peck_depths
from trunnion.readers.families.heidenhain.words import CYCLE_LINES, CYCLE_PARAMETERS


def motions(run: Run) -> list[tuple[str, float, float]]:
    """Rows after the first: R or F, height, and feed where it is one."""
    rapid = (run.kind == Kind.RAPID).tolist()
    rows = zip(rapid[1:], run.tip[1:, 2].tolist(), run.feed[1:].tolist(), strict=True)
    return [("R" if r else "F", round(z, 6), 0.0 if r else f) for r, z, f in rows]


DEEP: dict[str, float] = {"Q212": 0, "Q205": 0, "Q258": 0, "Q259": 0, "Q257": 0, "Q256": 0}


@pytest.mark.parametrize(
    ("number", "values", "expected"),
    [
        (200, {}, "R12 F4 R12 R6 F-2 R12 R0 F-5 R12 R60"),
        (200, {"Q202": 15}, "R12 F-5 R12 R60"),
        (200, {"Q202": 20, "Q204": 0}, "R12 F-5 R12"),
        (201, {"Q208": 0}, "R12 F-5 F12 R60"),
        (202, {"Q208": 300, "Q214": 0}, "R12 F-5 F12 R60"),
        (202, {"Q208": 300, "Q214": 1, "Q336": 0}, "R12 F-5 F-5 F12 R12 R60"),
        (203, {"Q212": 0, "Q213": 0, "Q205": 0, "Q208": 500, "Q256": 1}, "R12 F4 F12 R6 F-2 F12 R0 F-5 F12 R60"),
        (203, {"Q212": 1, "Q213": 1, "Q205": 2, "Q208": 500, "Q256": 1}, "R12 F4 F5 F-1 F12 R1 F-5 F12 R60"),
        (204, {"Q249": 5, "Q250": 20, "Q251": 15, "Q252": 3.5, "Q253": 750, "Q254": 200, "Q255": 0, "Q214": 1},
         "R12 R12 F-27 F-27 F-20 F-27 F-27 F12 R12 R60"),
        (205, {**DEEP, "Q258": 1, "Q259": 1}, "R12 F4 R12 R5 F-2 R12 R-1 F-5 R12 R60"),
        (205, {**DEEP, "Q202": 15, "Q257": 5, "Q256": 1}, "R12 F5 F6 F0 F1 F-5 R12 R60"),
        (205, {**DEEP, "Q202": 15, "Q379": 8, "Q253": 700}, "R12 F2 F-5 R12 R60"),
        (206, {}, "R12 F-5 F12 R60"),
        (207, {"Q239": 1.5}, "R12 F-5 F12 R60"),
        (209, {"Q239": 1, "Q257": 10, "Q256": 2}, "R12 F0 F2 F-5 F12 R60"),
        (209, {"Q239": -1, "Q257": 10, "Q256": 0}, "R12 F0 F12 F-5 F12 R60"),
        (240, {"Q343": 0}, "R12 F-5 R12 R60"),
        (241, {"Q379": 0, "Q253": 700, "Q208": 900}, "R12 F-5 F12 R60"),
        (241, {"Q379": 6, "Q253": 700, "Q208": 900}, "R12 F6 F-5 F12 R60"),
    ],
)  # fmt: skip
def test_cycles_of_the_200_series(number: int, values: dict[str, float], expected: str, run: Runner) -> None:
    found = run(BEFORE + define(number, **{**DRILL, **values}) + "CYCL CALL")
    assert found.diagnostics == ()
    assert " ".join(f"{kind}{height:g}" for kind, height, _ in motions(found)) == expected
    close(found.tip[-1, :2], [3, 4])


#: What the reader needs of each cycle, with values that it can make.
SOUND: dict[int, dict[str, float]] = {
    **dict.fromkeys((200, 201, 206), DRILL | {"Q208": 0}),
    202: DRILL | {"Q208": 300, "Q214": 1},
    203: DRILL | {"Q212": 0, "Q213": 0, "Q205": 0, "Q208": 500, "Q256": 1},
    204: DRILL | {"Q249": 5, "Q250": 20, "Q251": 15, "Q252": 3.5, "Q253": 750, "Q254": 200, "Q255": 0, "Q214": 1},
    205: DRILL | DEEP,
    207: DRILL | {"Q239": 1.5},
    208: DRILL | {"Q334": 2, "Q335": 20},
    209: DRILL | {"Q239": 1, "Q257": 10, "Q256": 2},
    240: DRILL | {"Q343": 0},
    241: DRILL | {"Q379": 0, "Q253": 700, "Q208": 900},
}


def test_a_definition_without_a_line_that_the_motions_depend_on_is_an_error(run: Runner) -> None:
    assert SOUND.keys() | {27, 28, 220, 221, 247} == CYCLE_PARAMETERS.keys()
    for number, values in SOUND.items():
        needed = {f"Q{parameter}" for parameter in CYCLE_PARAMETERS[number]}
        whole = {name: value for name, value in values.items() if name in needed}
        assert run(BEFORE + define(number, **whole) + "CYCL CALL").errors == (), number
        for missing in needed:
            less = {name: value for name, value in whole.items() if name != missing}
            faults = run(BEFORE + define(number, **less) + "CYCL CALL").errors
            assert any(f"has no {missing}:" in fault.text for fault in faults), (number, missing)
    preset = run("CYCL DEF 247 DATUM SETTING\nL X+1 R0 FMAX")
    assert any("has no Q339" in fault.text for fault in preset.errors)


@pytest.mark.parametrize("number", [number for number in SOUND if number != 204])
def test_a_depth_above_the_surface_is_an_error(number: int, run: Runner) -> None:
    found = run(BEFORE + define(number, **SOUND[number] | {"Q201": 5}) + "CYCL CALL")
    assert any("has Q201=+5" in fault.text for fault in found.errors)


@pytest.mark.parametrize("number", SOUND)
def test_a_set_up_clearance_below_the_surface_is_an_error(number: int, run: Runner) -> None:
    found = run(BEFORE + define(number, **SOUND[number] | {"Q200": -2}) + "CYCL CALL")
    assert any("has Q200=-2" in fault.text for fault in found.errors)


@pytest.mark.parametrize("number", SOUND)
def test_a_value_of_another_cycle_is_named(number: int, run: Runner) -> None:
    text = define(number, **SOUND[number]).rstrip("\n")
    found = [each.text for each in run(f"{BEFORE}{text} ~\nQ399=+1\nCYCL CALL").diagnostics]
    assert found[0].startswith(f"cycle {number} has no Q399: the value counts for nothing")
    assert run(f"{BEFORE}{text}\nCYCL CALL").errors == ()


def test_a_value_that_a_definition_has_twice_is_an_error(run: Runner) -> None:
    text = define(200, **SOUND[200]).rstrip("\n")
    for again in ("Q201=-20", "Q201=-15", "Q211=+0"):
        found = run(BEFORE + f"{text} ~\n{again}\nCYCL CALL")
        assert any("stands twice in the definition of cycle 200" in fault.text for fault in found.errors)


def test_older_cycles_need_each_of_their_lines(run: Runner) -> None:
    for number, lines in CYCLE_LINES.items():
        text = [f"CYCL DEF {number}.0 NAME", *(f"CYCL DEF {number}.{k} {name}-5" for k, name in lines.items())]
        text = [line.replace("DWELL-5", "DWELL0").replace("F-5", "F100").replace("DIST-5", "DIST2") for line in text]
        assert run(BEFORE + "\n".join(text) + "\nCYCL CALL").errors == ()
        assert run(BEFORE + "\n".join(text[:-1]) + "\nCYCL CALL").errors


def test_back_boring_without_a_shift_does_not_go_into_the_hole(run: Runner) -> None:
    assert run(BEFORE + define(204, **SOUND[204] | {"Q214": 0}) + "CYCL CALL").errors


@pytest.mark.parametrize("word", ["MAX", "FMAX"])
@pytest.mark.parametrize(
    ("number", "values", "expected"),
    [
        (202, {"Q214": 0}, "R12 F-5 R12 R60"),
        (202, {"Q214": 1, "Q336": 0}, "R12 F-5 R-5 R12 R12 R60"),
        (203, {"Q212": 0, "Q213": 9, "Q205": 0, "Q256": 1}, "R12 F4 R5 F-2 R-1 F-5 R12 R60"),
    ],
)
def test_out_of_the_hole_at_rapid(number: int, values: dict[str, float], expected: str, word: str, run: Runner) -> None:
    text = define(number, **{**DRILL, **values}).rstrip("\n") + f" ~\nQ208={word}\n"
    found = run(BEFORE + text + "CYCL CALL")
    assert found.diagnostics == ()
    assert " ".join(f"{kind}{height:g}" for kind, height, _ in motions(found)) == expected
    assert run(BEFORE + text.replace("Q208", "Q206") + "CYCL CALL").diagnostics


def test_feeds_of_cycles(run: Runner) -> None:
    def feeds(number: int, **values: float) -> list[float]:
        found = run(BEFORE + "L Z+90 F888\n" + define(number, **{**DRILL, "Q202": 15, **values}) + "CYCL CALL\nL Z+1")
        assert found.diagnostics == ()
        # What was in force before is in force again.
        assert found.feed[-1] == 888
        return [feed for kind, _, feed in motions(found)[1:-1] if kind == "F"]

    assert feeds(200) == [150]
    assert feeds(201, Q208=0) == [150, 150]
    assert feeds(201, Q208=400) == [150, 400]
    assert feeds(206) == [150, 150]
    assert feeds(207, Q239=1.5) == [1500, 1500]


def test_dwells(run: Runner) -> None:
    found = run(BEFORE + define(200, **{**DRILL, "Q210": 0.25, "Q211": 0.5}) + "CYCL CALL")
    assert [(e.value, e.before_row) for e in found.events if e.kind == "dwell"] == [(0.25, 4), (0.25, 7), (0.5, 9)]


def test_a_bored_hole_is_left_beside_its_wall(run: Runner) -> None:
    found = run(BEFORE + define(202, **{**DRILL, "Q208": 300, "Q214": 2, "Q336": 0}) + "CYCL CALL")
    close(found.tip[2:6, 1], [4, 3.8, 3.8, 4])


@pytest.mark.parametrize("call", ["CYCL CALL", "CYCL CALL M8", "L FMAX M99", "M99"])
def test_ways_to_call(call: str, run: Runner) -> None:
    found = run(BEFORE + define(200, **DRILL) + call)
    assert found.diagnostics == ()
    assert len(found) == 11


def test_m99_calls_after_the_motion_and_m89_until_m99(run: Runner) -> None:
    short = define(200, **{**DRILL, "Q202": 15, "Q204": 0})
    text = BEFORE + short + "L X+1 FMAX M99\nL X+2 FMAX\nL X+3 FMAX M89\nL X+4 FMAX\nL X+5 FMAX M99\nL X+6 FMAX"
    found = run(text)
    assert found.diagnostics == ()
    deep = found.tip[found.tip[:, 2] == -5.0]
    assert deep[:, 0].tolist() == [1, 3, 4, 5]
    assert found.tip[-1, 0] == 6


def test_a_call_at_a_position(run: Runner) -> None:
    found = run(BEFORE + define(200, **{**DRILL, "Q202": 15}) + "CYCL CALL POS X+30 Y+40 Z+70 FMAX")
    assert found.diagnostics == ()
    close(found.tip[1], [30, 40, 70])
    close(found.tip[3], [30, 40, -5])


def test_parameters_of_cycles_are_parameters(run: Runner) -> None:
    text = (
        "Q1 = 4\n"
        + define(200, **{**DRILL, "Q202": 15})
        + "Q2 = Q201 + Q1\nCYCL DEF 200 Q201=Q2 Q203=-Q1 Q200=1 Q206=9 Q202=50 Q210=0 Q204=50 Q211=0\n"
    )
    found = run(BEFORE + text + "CYCL CALL")
    assert found.diagnostics == ()
    assert found.tip[:, 2].min() == -15.0


PECK = """CYCL DEF 1.0 PECKING
CYCL DEF 1.1 DIST{}
CYCL DEF 1.2 DEPTH{}
CYCL DEF 1.3 PLNGNG{}
CYCL DEF 1.4 DWELL0
CYCL DEF 1.5 F364
"""


@pytest.mark.parametrize(
    ("distance", "depth", "peck", "expected"),
    [
        ("27.500", "-5.400", "3.0", "F69.5 R100 R70.1 F67.1 R100"),
        ("+2", "-60", "+30", "F68 R100 R69.2 F38 R100"),
        ("2", "-3", "3", "F95 R100"),
    ],
)
def test_pecking_from_where_the_tool_stands(distance: str, depth: str, peck: str, expected: str, run: Runner) -> None:
    found = run(BEFORE + PECK.format(distance, depth, peck) + "L FMAX M99")
    assert found.diagnostics == ()
    assert " ".join(f"{kind}{height:g}" for kind, height, _ in motions(found)) == expected
    assert {feed for kind, _, feed in motions(found) if kind == "F"} == {364.0}


@pytest.mark.parametrize(
    "text",
    [
        PECK.format("+2", "+5", "+5"),
        "CYCL DEF 2.0 TAP\nCYCL DEF 2.1 DIST 2\nCYCL DEF 2.2 DEPTH 5\nCYCL DEF 2.3 DWELL 0\nCYCL DEF 2.4 F9\n",
        "CYCL DEF 17.0 RIGID\nCYCL DEF 17.1 DIST 2\nCYCL DEF 17.2 DEPTH +5\nCYCL DEF 17.3 PITCH +1\n",
    ],
)
def test_an_older_cycle_with_a_depth_above_the_surface_is_an_error(text: str, run: Runner) -> None:
    found = run(BEFORE + text + "CYCL CALL")
    assert any("has DEPTH +5, a depth above the surface" in fault.text for fault in found.errors)


def test_the_clearance_of_an_older_cycle_may_have_the_sign_of_the_depth(run: Runner) -> None:
    signed, plain = (run(BEFORE + PECK.format(*each) + "L FMAX M99") for each in (("-2", "-9", "-3"), ("2", "-9", "3")))
    assert motions(signed) == motions(plain)


def test_other_cycles_from_where_the_tool_stands(run: Runner) -> None:
    tap = "CYCL DEF 2.0 TAPPING\nCYCL DEF 2.1 SET UP+2\nCYCL DEF 2.2 DEPTH-20\nCYCL DEF 2.3 DWELL0\nCYCL DEF 2.4 F100\n"
    rigid = "CYCL DEF 17.0 RIGID\nCYCL DEF 17.1 SET UP2\nCYCL DEF 17.2 DEPTH-10\nCYCL DEF 17.3 PITCH+1\n"
    assert motions(run(BEFORE + tap + "CYCL CALL")) == [("F", 78.0, 100.0), ("F", 100.0, 100.0)]
    assert motions(run(BEFORE + rigid + "CYCL CALL")) == [("F", 88.0, 1000.0), ("F", 100.0, 1000.0)]


@pytest.mark.parametrize(
    "text",
    [
        define(200, Q200=2, Q201=0, Q206=1, Q202=1, Q203=0), define(200, Q200=2, Q201=-5),
        define(207, **{**DRILL, "Q239": 0}), define(202, **{**DRILL, "Q214": 7}), define(251, **DRILL),
        define(209, **DRILL, Q239=1),
        define(240, **{**DRILL, "Q343": 1}), define(205, **{**DRILL, "Q379": 20, "Q253": 1}),
        "CYCL DEF 1.0 PECKING\n", PECK.format(2, 0, 1), define(256, **DRILL),
    ],
)  # fmt: skip
def test_cycles_that_make_no_sense_are_named_and_not_executed(text: str, run: Runner) -> None:
    found = run(BEFORE + text + "CYCL CALL")
    assert len(found) == 1
    assert {f.severity for f in found.diagnostics} == {"error"}


def test_a_cycle_beside_the_tool_axis_is_named(run: Runner) -> None:
    text = "PLANE SPATIAL SPA-45 SPB+0 SPC+0 STAY\n" + BEFORE + define(200, **DRILL) + "CYCL CALL"
    assert any("not the tool axis" in f.text for f in run(text).diagnostics)


def test_cycles_drill_along_a_tilted_tool(run: Runner) -> None:
    text = (
        "PLANE SPATIAL SPA-45 SPB+0 SPC+0 TURN FMAX SEQ-\n"
        + BEFORE
        + define(200, **{**DRILL, "Q202": 15})
        + "CYCL CALL"
    )
    found = run(text)
    assert found.diagnostics == ()
    drilled = found.tip[-3] - found.tip[-4]
    close(drilled, -17.0 * found.axis[-1], atol=1e-9)


@settings(max_examples=examples(50))
@given(
    total=st.integers(1, 500).map(float),
    first=st.integers(1, 100).map(float),
    less=st.integers(0, 20).map(float),
    least=st.integers(1, 50).map(float),
)
def test_infeeds_shrink_to_the_least_and_end_at_the_depth(
    total: float, first: float, less: float, least: float
) -> None:
    depths = peck_depths(total, first, less, least)
    assert depths[-1] == total
    pecks = [b - a for a, b in zip([0.0, *depths], depths, strict=False)]
    assert all(peck > 0.0 for peck in pecks)
    expected = first
    for peck in pecks[:-1]:
        assert peck == pytest.approx(expected)
        expected = max(expected - less, least)
    assert pecks[-1] <= (expected if len(pecks) > 1 else total) + 1e-9


def test_pecks_without_end_are_refused() -> None:
    with pytest.raises(CycleExecutionError, match="more than"):
        peck_depths(100.0, 0.01, 0.0, 0.01)


# Bore milling, whose tool goes round: what is simulated is the wall


@pytest.mark.parametrize(
    ("values", "turns", "sense"),
    [({}, 6, 1.0), ({"Q334": 17}, 1, 1.0), ({"Q334": 8.5, "Q351": 1}, 2, 1.0), ({"Q334": 4, "Q351": -1}, 5, -1.0)],
)
def test_a_bore_is_milled_in_helices_and_once_round_at_its_bottom(
    values: dict[str, float], turns: int, sense: float, run: Runner
) -> None:
    found = run(BEFORE + define(208, **{**DRILL, "Q334": 3, "Q335": 20, "Q342": 0, **values}) + "CYCL CALL")
    assert [finding.severity for finding in found.diagnostics] == [Severity.WARNING]
    place = [[3, 4, 12], [13, 4, 12], [13, 4, -5], [13, 4, -5], [3, 4, -5], [3, 4, 12], [3, 4, 60]]
    close(found.tip[1:], place)
    kinds = [Kind.RAPID, Kind.LINEAR, Kind.ARC, Kind.ARC, Kind.LINEAR, Kind.RAPID, Kind.RAPID]
    assert found.kind[1:].tolist() == kinds
    assert found.arcs.full_turns.tolist() == [turns - 1, 0]  # besides the turn that comes back to its start
    close(found.arcs.centre[:, :2], [[3, 4], [3, 4]])
    close(found.arcs.normal, [[0, 0, sense]] * 2)
    close(found.arcs.radius, [10, 10])
    assert set(found.feed[1:].tolist()) >= {150.0}


@pytest.mark.parametrize("values", [{"Q334": 0}, {"Q335": 0}, {"Q334": 1e-4}, {"Q335": -5}])
def test_a_bore_that_cannot_be_milled_is_named(values: dict[str, float], run: Runner) -> None:
    found = run(BEFORE + define(208, **{**DRILL, "Q334": 3, "Q335": 20, **values}) + "CYCL CALL")
    assert len(found) == 1
    assert Severity.ERROR in [finding.severity for finding in found.diagnostics]


@pytest.mark.parametrize(
    ("values", "what"),
    [
        ({"Q202": 0.0}, "has a Q202 that is not above 0"),
        ({"Q202": -2.0}, "has a Q202 that is not above 0"),
        ({"Q204": -5.0}, "has Q204=-5, which is below 0"),
        ({"Q210": -1.0}, "has Q210=-1, which is below 0"),
        ({"Q211": -1.0}, "has Q211=-1, which is below 0"),
    ],
)
def test_values_of_the_wrong_sign_are_refused(values: dict[str, float], what: str, run: Runner) -> None:
    found = run(BEFORE + define(200, **{**DRILL, **values}) + "L X+1 FMAX M99\n")
    assert [what in each.text for each in found.errors] == [True]
