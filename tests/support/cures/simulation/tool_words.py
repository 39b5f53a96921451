"""Cures of messages about tools stated as one word: KIND:SIZES."""

from typing import Final

from tests.support.cures.reading import text_of, whole
from trunnion.simulation.tools.text import parse_tool

_WORD: Final = text_of(parse_tool)
_of_sizes: Final = whole("SIM152", _WORD)
_of_word: Final = whole("SIM153", _WORD)

_HUNDRED_AND_ONE: Final = "3=ball:10,length=60,flutes=20,holder=" + "/".join(["40x1"] * 101)

CURES: Final = (
    _of_sizes("size_needed", "3=bull:10", "3=bull:10,1"),
    _of_sizes("angle_out_of_range", "3=taper:10,95", "3=taper:10,45"),
    _of_sizes("size_out_of_range", "3=ball:20000", "3=ball:10000"),
    _of_sizes("too_many_pieces", _HUNDRED_AND_ONE, _HUNDRED_AND_ONE.removesuffix("/40x1")),
    _of_sizes("piece_out_of_range", "3=ball:10,length=60,holder=40x20000", "3=ball:10,length=60,holder=40x200"),
    _of_sizes("side_never_meets_tip", "3=drill:10,118,side_angle=59", "3=drill:10,118,side_angle=58"),
    _of_sizes("does_not_fit_between_bottom_and_side", "3=bull:10,6", "3=bull:10,5"),
    _of_sizes("more_than_ball_up_to_neck", "3=lollipop:10,6,flutes=9.5", "3=lollipop:10,6,flutes=9"),
    _of_sizes("more_than_half_the_diameter", "3=t_slot:10,20,6,corner=6", "3=t_slot:10,20,6,corner=5"),
    _of_sizes("not_less", "3=chamfer:10,45,10", "3=chamfer:10,45,2"),
    _of_sizes(
        "less_than_both_corners", "3=t_slot:10,3,6,corner=2,upper_corner=2", "3=t_slot:10,4,6,corner=2,upper_corner=2"
    ),
    _of_sizes("not_less_than_pitch", "3=thread_mill:10,2,flutes=10,crest=2", "3=thread_mill:10,2,flutes=10,crest=0.2"),
    _of_sizes("grooves_too_deep", "3=thread_mill:10,12,flutes=24", "3=thread_mill:10,1.5,flutes=24"),
    _of_sizes("number_of_teeth", "3=thread_mill:10,2,flutes=1", "3=thread_mill:10,2,flutes=2"),
    _of_sizes("side_reaches_tool_axis", "3=barrel:10,12,10,flutes=30", "3=barrel:10,80,10,flutes=30"),
    _of_sizes("does_not_fit_below_side", "3=barrel:10,80,2,flutes=20,corner=3", "3=barrel:10,80,2,flutes=20,corner=1"),
    _of_sizes("more_than_length", "3=ball:10,length=20,flutes=30", "3=ball:10,length=60,flutes=30"),
    _of_sizes("no_place_without_length", "3=ball:10,holder=40x50", "3=ball:10,holder=40x50,length=60"),
    _of_sizes("flutes_end_nowhere", "3=ball:10,length=60,shank=12", "3=ball:10,length=60,shank=12,flutes=20"),
    _of_sizes(
        "neck_without_diameter",
        "3=ball:10,length=60,flutes=20,neck_length=30",
        "3=ball:10,length=60,flutes=20,neck_length=30,neck=8",
    ),
    _of_sizes("neck_without_diameter", "3=ball:10,length=60,flutes=20,neck_length=30", "3=ball:10,length=60,flutes=20"),
    _of_sizes(
        "neck_without_length",
        "3=ball:10,length=60,flutes=20,shank=10,neck=8",
        "3=ball:10,length=60,flutes=20,shank=10,neck=8,neck_length=30",
    ),
    _of_sizes(
        "neck_not_between",
        "3=ball:10,length=60,flutes=20,neck=8,neck_length=10",
        "3=ball:10,length=60,flutes=20,neck=8,neck_length=30",
    ),
    _of_sizes(
        "less_than_tool_with_holder",
        "3=ball:10,length=60,flutes=20,holder=40x50,gauge=50",
        "3=ball:10,length=60,flutes=20,holder=40x50,gauge=110",
    ),
    _of_sizes("less_than_tip", "3=drill:20,90,length=5", "3=drill:20,90,length=60"),
    _of_word("too_long", "3=ball:10" + " " * 1000, "3=ball:10"),
    _of_word("no_equals", "ball", "3=ball:10"),
    _of_word("no_number_of_tool", "=ball:10", "3=ball:10"),
    _of_word("no_kind", "3=scissors:10", "3=flat:10"),
    _of_word("no_kind_but_near", "3=bal:10", "3=ball:10"),
    _of_word("size_without_name", "3=ball:10,60", "3=ball:10,length=60"),
    _of_word("size_twice", "3=ball:10,length=60,length=60", "3=ball:10,length=60"),
    _of_word("no_size", "3=ball:10,colour=60", "3=ball:10,length=60"),
    _of_word("no_size_but_near", "3=ball:10,lenght=60", "3=ball:10,length=60"),
    _of_word("no_angle", "3=taper:10,side_angle=5deg", "3=taper:10,side_angle=12.5"),
    _of_word("no_length", "3=ball:10,length=60mm", "3=ball:10,length=12.5"),
    _of_word("no_piece", "3=ball:10,length=60,holder=40", "3=ball:10,length=60,holder=30-40x20/60x30"),
)
