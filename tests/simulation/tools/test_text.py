"""Tools as one word, as a command line says them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.errors import InputError
from trunnion.simulation.tools.shapes import BodyPiece, ToolKind, ToolShape, ToolSizes, ball, tool_shape
from trunnion.simulation.tools.text import parse_tool

K = ToolKind


def test_a_tool_with_all_that_stands_above_it() -> None:
    found = parse_tool("3=ball:10,length=60,flutes=20,shank=10,holder=40x50/60x30")
    holder = (BodyPiece(40.0, 40.0, 50.0), BodyPiece(60.0, 60.0, 30.0))
    meant = ball(10.0, length=60.0, flute_length=20.0, shank_diameter=10.0, holder=holder)
    assert found.sections == meant.sections
    assert (found.number, found.name, found.length, found.remarks) == (3, "", 140.0, ())


@pytest.mark.parametrize(
    ("text", "sizes"),
    [
        ("flat:10", ToolSizes(K.FLAT, 10.0)),
        ("flat:diameter=10", ToolSizes(K.FLAT, 10.0)),
        (" flat : 10 , length = 50.5 ", ToolSizes(K.FLAT, 10.0, length=50.5)),
        ("bull:10,.5", ToolSizes(K.BULL, 10.0, 0.5)),
        ("bull:10,corner=2", ToolSizes(K.BULL, 10.0, 2.0)),
        ("taper:6,5,1", ToolSizes(K.TAPER, 6.0, 1.0, side_angle=5.0)),
        ("taper_ball:6,5", ToolSizes(K.TAPER_BALL, 6.0, side_angle=5.0)),
        ("drill:8.5,140", ToolSizes(K.DRILL, 8.5, tip_angle=140.0)),
        ("chamfer:10,45,2", ToolSizes(K.CHAMFER, 10.0, side_angle=45.0, tip_diameter=2.0)),
        ("lollipop:10,6", ToolSizes(K.LOLLIPOP, 10.0, neck_diameter=6.0)),
        ("t_slot:20,5,8,corner=1", ToolSizes(K.T_SLOT, 20.0, 1.0, flute_length=5.0, neck_diameter=8.0)),
        ("thread_mill:10,1.5,flutes=15", ToolSizes(K.THREAD_MILL, 10.0, pitch=1.5, flute_length=15.0)),
        (
            "barrel:10,85,12,flutes=24",
            ToolSizes(K.BARREL, 10.0, profile_radius=85.0, widest_height=12.0, flute_length=24.0),
        ),
        (
            "flat:10,flutes=20,length=60,neck=9,neck_length=30,shank=9-12x10/12x5,gauge=100",
            ToolSizes(
                K.FLAT, 10.0, flute_length=20.0, length=60.0, neck_diameter=9.0, neck_length=30.0, gauge_length=100.0,
                shank=(BodyPiece(9.0, 12.0, 10.0), BodyPiece(12.0, 12.0, 5.0)),
            ),
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)  # fmt: skip
def test_each_kind_has_its_sizes_in_order_or_by_name(text: str, sizes: ToolSizes) -> None:
    assert parse_tool(f"12={text}") == tool_shape(sizes, 12)


def test_a_tool_may_be_called_by_a_name() -> None:
    found = parse_tool("BALL_10=ball:10")
    assert (found.number, found.name) == (None, "BALL_10")


def test_a_tool_table_gives_the_diameter_and_the_text_the_kind() -> None:
    assert parse_tool("3=ball", {3: 12.0}) == parse_tool("3=ball:12")
    assert parse_tool("3=drill:tip_angle=118,length=50", {3: 12.0}) == parse_tool("3=drill:12,118,length=50")
    assert parse_tool("3=ball:8", {3: 12.0}) == parse_tool("3=ball:8")
    with pytest.raises(InputError, match="diameter is not stated"):
        parse_tool("4=ball", {3: 12.0})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no =; write NUMBER=KIND:SIZES"),
        ("ball:10", "has no ="),
        ("=ball:10", "says no number of a tool"),
        ("3=", '"" is no kind of tool; write one of flat, ball'),
        ("3=bal:10", '"bal" is no kind of tool; did you mean "ball"?'),
        ("3=10", '"10" is no kind of tool'),
        ("3=ball", "diameter is not stated; a tool of the kind ball needs it"),
        ("3=ball:10mm", 'diameter is "10mm"; write a number above 0, in mm'),
        ("3=ball:10,5", '"5" has no name; a ball begins with diameter'),
        ("3=ball:length=60,10", '"10" has no name'),
        ("3=bull:corner=1,10", '"10" has no name'),
        ("3=ball:10,flute=5", 'a ball has no size "flute"; did you mean "flutes"?'),
        ("3=ball:10,pitch=5", 'a ball has no size "pitch"; known here: diameter, flutes'),
        ("3=ball:10,diameter=5", "diameter is there twice"),
        ("3=ball:0", 'diameter is "0"'),
        ("3=ball:-1", 'diameter is "-1"'),
        ("3=ball:nan", 'diameter is "nan"'),
        ("3=ball:1e3", 'diameter is "1e3"'),
        ("3=ball:10,length=1,5", '"5" has no name'),
        ("3=ball:١٠", "diameter is"),
        ("3=drill:10", "tip_angle is not stated"),
        ("3=drill:10,tip_angle=x", 'tip_angle is "x"; write a number above 0, in degrees'),
        ("3=ball:10,length=60,holder=40", 'holder has the piece "40"; write DIAMETERxHEIGHT'),
        ("3=ball:10,length=60,holder=40x", 'holder has the piece "40x"'),
        ("3=ball:10,length=60,holder=4.0.1x5", 'holder is "4.0.1"'),
        ("3=ball:10,length=60,holder=40x50/", 'holder has the piece ""'),
        ("3=ball:10,holder=40x50", "length is not stated; write it: holder has no place without it"),
        ("3=ball:10,flutes=30,length=20", "flutes is 30, more than the length 20"),
        ("3=ball:20000", "diameter is 20000; write a number above 0, at most 10000"),
        ("3=bull:10,9", "corner is 9, more than what fits between bottom and side; write at most 5"),
        ("3=ball:" + "1" * 2000, "is 2007 letters long"),
    ],
    ids=lambda value: value[:30],
)
def test_what_is_no_tool_is_refused_with_a_cure(text: str, said: str) -> None:
    with pytest.raises(InputError) as raised:
        parse_tool(text)
    assert said in str(raised.value)
    assert "--" not in str(raised.value)
    assert all(problem.cure for problem in raised.value.problems)


@settings(max_examples=examples(60))
@given(st.text("0123456789=:,./x-ball flutehodrngt_sk", max_size=40))
def test_any_text_is_a_tool_or_is_refused(text: str) -> None:
    try:
        found = parse_tool("3=" + text)
    except InputError:
        return
    assert isinstance(found, ToolShape)
