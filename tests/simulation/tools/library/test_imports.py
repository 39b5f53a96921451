"""Tool libraries that people have: Autodesk's, FreeCAD's tool bits, LinuxCNC's tool table."""

import io
import json
import math
import zipfile
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.tools import pieces_volume
from trunnion.errors import InputError
from trunnion.simulation.tools.library import ToolLibrary, read_tools
from trunnion.simulation.tools.library.json_text import parse_json
from trunnion.simulation.tools.library.reading import _from_json, _unpack
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.shapes import BodyPiece, ToolKind, ToolShape, ToolSizes, ball, flat, tool_shape

K = ToolKind


def entry(kind: str = "ball end mill", unit: str = "millimeters", **geometry: object) -> dict[str, Any]:
    """A tool as Autodesk's CAM writes it."""
    lengths = {"DC": 10.0, "LCF": 20.0, "LB": 50.0, "OAL": 80.0, "SFDM": 10.0, "shoulder-length": 30.0}
    return {
        "type": kind, "unit": unit, "description": "T  one", "post-process": {"number": 3},
        "geometry": {**lengths, **{key.replace("_", "-"): value for key, value in geometry.items()}},
    }  # fmt: skip


def ends(shape: ToolShape) -> dict[str, float]:
    """Radius and height of each point of the outline of a tool, by its section."""
    return {
        f"{section.name} {number} {axis}": value
        for section in shape.sections
        for number, element in enumerate(section.outline)
        for axis, value in zip("rz", element.end, strict=True)
    }


def autodesk(*tools: object) -> ToolLibrary:
    return _from_json("lib.json", json.dumps({"data": tools, "version": 2}).encode())


def test_a_tool_of_autodesk_with_its_holder(tmp_path: Path) -> None:
    tool = entry(RE=5.0, shoulder_diameter=9.0)
    tool["holder"] = {
        "unit": "inches", "gaugeLength": 3.0,
        "segments": [
            {"height": 1.0, "lower-diameter": 1.0, "upper-diameter": 2.0},
            {"height": 0.0, "lower-diameter": 2.0, "upper-diameter": 3.0},
            {"height": 4.0, "lower-diameter": 3.0, "upper-diameter": 3.0},
        ],
    }  # fmt: skip
    file = tmp_path / "shop.tools"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("tools.json", json.dumps({"data": [tool, {"type": "holder"}], "version": 36}))
    found = read_tools(file)
    # What is above the gauge point is in the spindle.
    holder = (BodyPiece(25.4, 50.8, 25.4), BodyPiece(76.2, 76.2, 50.8))
    meant = ball(
        10.0, flute_length=20.0, length=50.0, shank_diameter=10.0, neck_diameter=9.0, neck_length=30.0, holder=holder
    )
    assert found.unusable == ()
    assert ends(found.tool(3)) == pytest.approx(ends(meant))
    assert found.tool(3).length == pytest.approx(126.2)
    assert (found.tool(3).name, found.tool(3).description, found.tool(3).remarks) == ("T one", "ball end mill", ())


#: Type and sizes of a tool, and what its cutter is.
FORMS: list[tuple[dict[str, Any], dict[str, Any]]] = [
    (entry("flat end mill"), {"kind": K.FLAT, "diameter": 10.0}),
    (entry("bull nose end mill", RE=1.0), {"kind": K.BULL, "diameter": 10.0, "corner_radius": 1.0}),
    (entry("face mill", RE=1.0, DC=50.0), {"kind": K.BULL, "diameter": 50.0, "corner_radius": 1.0}),
    (entry("tapered mill", TA=3.0, shoulder_length=20.0), {"kind": K.TAPER, "diameter": 10.0, "side_angle": 3.0}),
    (entry("bull nose end mill", RE=0.0), {"kind": K.FLAT, "diameter": 10.0}),
    (
        entry("chamfer mill", TA=45.0, tip_diameter=2.0),
        {"kind": K.CHAMFER, "diameter": 10.0, "side_angle": 45.0, "tip_diameter": 2.0},
    ),
    (entry("counter sink", SIG=90.0), {"kind": K.CHAMFER, "diameter": 10.0, "side_angle": 45.0}),
    (entry("drill", SIG=118.0), {"kind": K.DRILL, "diameter": 10.0, "tip_angle": 118.0}),
    (entry("reamer", SIG=0), {"kind": K.FLAT, "diameter": 10.0}),
    (
        entry("lollipop mill", LCF=9.5, shoulder_diameter=6.0),
        {"kind": K.LOLLIPOP, "diameter": 10.0, "neck_diameter": 6.0, "neck_length": 30.0, "flute_length": 9.0},
    ),
    (
        entry("slot mill", LCF=2.0, RE=1.5, shoulder_diameter=6.0),
        {
            "kind": K.T_SLOT,
            "diameter": 10.0,
            "neck_diameter": 6.0,
            "neck_length": 30.0,
            "flute_length": 3.0,
            "corner_radius": 1.5,
            "upper_radius": 1.5,
        },
    ),
]


@pytest.mark.parametrize(
    ("tool", "form"), FORMS, ids=[f"{tool['type']} {number}" for number, (tool, _) in enumerate(FORMS)]
)
def test_each_type_of_autodesk_is_a_kind(tool: dict[str, Any], form: dict[str, Any]) -> None:
    body = {"flute_length": 20.0, "length": 50.0, "shank_diameter": 10.0, "neck_length": 30.0}
    neck = {} if form["kind"] is K.TAPER else {"neck_diameter": form["diameter"]}
    body = body if neck else {**body, "neck_length": 0.0}
    assert autodesk(tool).tool(3).sections == tool_shape(ToolSizes(**{**body, **neck, **form})).sections


@pytest.mark.parametrize("kind", ["slot mill", "lollipop mill"])
def test_a_head_without_a_stated_shoulder_stands_on_its_shank(kind: str) -> None:
    sizes = {key: value for key, value in entry(kind)["geometry"].items() if key != "shoulder-diameter"}
    thin = {**entry(kind), "geometry": {**sizes, "LCF": 2.0, "SFDM": 6.0}}
    meant = {**entry(kind), "geometry": {**sizes, "LCF": 2.0, "SFDM": 6.0, "shoulder-diameter": 6.0}}
    assert autodesk(thin).tool(3).sections == autodesk(meant).tool(3).sections
    with pytest.raises(InputError, match="neck"):
        autodesk({**entry(kind), "geometry": {**sizes, "LCF": 2.0, "SFDM": 10.0}}).tool(3)


def test_inches_are_converted_and_custom_shafts_followed() -> None:
    tool = entry("flat end mill", "inches", DC=0.5, LCF=1.0, LB=2.0, SFDM=0.5, shoulder_length=1.0)
    tool["shaft"] = {"segments": [{"height": 0.5, "lower-diameter": 0.5, "upper-diameter": 0.75}]}
    shape = autodesk(tool).tool(3)
    cone = BodyPiece(12.7, 19.05, 12.7)
    meant = flat(12.7, flute_length=25.4, length=50.8, neck_diameter=12.7, neck_length=25.4, shank=(cone,))
    assert ends(shape) == pytest.approx(ends(meant))


def contour(shape: ToolShape) -> list[tuple[float, float]]:
    """The points of the outline of a tool, each once."""
    points = [element.end for section in shape.sections for element in section.outline]
    return [here for here, after in pairwise([*points, (0.0, 0.0)]) if math.dist(here, after) > 1e-6]


#: Tools whose contours Autodesk's CAM has drawn itself, and the ends of their lines and arcs.
DRAWN: dict[str, tuple[dict[str, Any], list[tuple[float, float]]]] = {
    "taper ball": (
        {
            **entry("tapered mill", DC=3.2391361327800285, RE=2, TA=12, LB=70, SFDM=16, shoulder_diameter=18.753394),
            "tapered-type": "tapered_ball",
        },
        [(1.9563, 1.58418), (5.8707, 20), (9.3767, 20), (9.3767, 30), (8, 30), (8, 70)],
    ),
    "taper": (
        {
            **entry("tapered mill", DC=8, RE=2, TA=12, LB=70, SFDM=16, shoulder_diameter=20.753394),
            "tapered-type": "tapered_bull_nose",
        },
        [(2.38043, 0), (4.33673, 1.58418), (8.25113, 20), (10.3767, 20), (10.3767, 30), (8, 30), (8, 70)],
    ),
    "taper without an angle": (
        {
            **entry("tapered mill", DC=6, RE=1, TA=0, LB=70, LCF=25, SFDM=16, shoulder_diameter=6, shoulder_length=40),
            "tapered-type": "tapered_bull_nose",
        },
        [(2, 0), (3, 1), (3, 25), (3, 40), (8, 40), (8, 70)],
    ),
    "taper with a shaft": (
        {
            **entry(
                "tapered mill", DC=6, RE=1, TA=6, LB=70, LCF=25, shoulder_diameter=14.408339, shoulder_length=40
            ),
            "tapered-type": "tapered_bull_nose",
            "shaft": {
                "segments": [
                    {"height": 5, "lower-diameter": 8, "upper-diameter": 8},
                    {"height": 5, "lower-diameter": 8, "upper-diameter": 16},
                ],
            },
        },
        [
            (2.0996, 0), (3.09412, 0.895472), (5.62761, 25), (7.20417, 25), (7.20417, 40), (4, 40), (4, 45), (8, 50),
            (8, 70),
        ],
    ),
    "thread mill with a shaft": (
        {
            **entry(
                "thread mill", DC=9.14, LB=77, LCF=3.5, NT=2, TP=1.75, shoulder_diameter=6.108911, shoulder_length=22,
                thread_profile_angle=60, thread_tip_type="point",
            ),
            "shaft": {
                "segments": [
                    {"height": 8, "lower-diameter": 6, "upper-diameter": 6},
                    {"height": 4, "lower-diameter": 6, "upper-diameter": 10},
                ],
            },
        },
        [
            (3.05446, 0), (4.57, 0.875), (3.05446, 1.75), (4.57, 2.625), (3.05446, 3.5), (3.05446, 22), (3, 22),
            (3, 30), (5, 34), (5, 77),
        ],
    ),
    "chamfer mill on a neck": (
        entry("chamfer mill", DC=12, TA=45, tip_diameter=2, LCF=0.5, LB=40, SFDM=8, shoulder_diameter=6),
        [(1, 0), (6, 5), (3, 8), (3, 30), (4, 30), (4, 40)],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", DRAWN)
def test_a_tool_has_the_contour_that_its_cam_draws(name: str) -> None:
    tool, meant = DRAWN[name]
    found = contour(autodesk(tool).tool(3))
    assert found == [pytest.approx(point, abs=1e-4) for point in meant]


def test_what_is_taken_for_granted_of_an_import_is_said() -> None:
    tool = {**entry("tap right hand", LB=0.0), "holder": {"description": "ER 32"}}
    assert tuple(map(str, autodesk(tool).tool(3).remarks)) == (
        "it is a tap right hand: simulated as a cylinder",
        "its length below the holder (LB) is missing: all of it (OAL) stands free",
        "its holder has no form (segments): none is simulated",
    )
    assert tuple(map(str, bit("tap.fcstd", TipAngle=90, CuttingEdgeLength=20).tool(None, "bit").remarks)) == (
        "a tool bit has no holder: all of its length, 50 mm, stands free",
        "it is a tap: simulated without its thread",
    )


@pytest.mark.parametrize(
    ("tool", "said"),
    [
        (entry("form mill"), "form mill is a type that is not read"),
        (entry("circle segment barrel"), "circle segment barrel is a type that is not read"),
        (entry("thread mill", TP=1.0, NT=3), "the crest of its teeth is not a point"),
        ({"post-process": {"number": 3}}, "it has no type"),
        (entry(unit="furlongs"), "its unit is furlongs"),
        (entry(unit=""), "it has no unit"),
        (entry(RE=4.0), "geometry.RE is 4.0: half the diameter is 5"),
        (entry("flat end mill", RE=1.0), "geometry.RE is 1.0: a flat end mill has no corner radius"),
        (entry("tapered mill", RE=5.0, TA=3.0), "its tapered-type is missing"),
        (
            {**entry("tapered mill", RE=5.0, TA=3.0), "tapered-type": "tapered_ball"},
            "geometry.DC is 10.0: a ball of this RE with this TA has 9.48965 where side and bottom would meet",
        ),
        (entry("face mill", TA=45.0), "geometry.TA is 45.0: a face mill with an angle is not read"),
        (entry("drill"), "its tip angle is not stated"),
        (entry(DC=-1.0), "geometry.DC is -1.0, not a number from 0 to 10000"),
        (entry(DC="ten"), "geometry.DC is ten, not a number"),
        (entry(DC=True), "geometry.DC is True, not a number"),
        (entry(DC=0.0), "its diameter is not stated"),
        ({**entry(), "geometry": 3}, "geometry is no object"),
        ({**entry(), "shaft": {"segments": [3]}}, "shaft.segments[0] is no object"),
        ({**entry(), "shaft": {"segments": [{}] * 101}}, "shaft.segments has 101 entries, more than 100"),
        ({**entry(), "holder": {"unit": "ells"}}, "its holder has the unit ells"),
        (
            {**entry(LB=0.0), "holder": {"segments": [{"height": 1, "lower-diameter": 1, "upper-diameter": 1}]}},
            "geometry.LB is missing",
        ),
    ],
    ids=lambda value: value[:24] if isinstance(value, str) else "",
)
def test_a_tool_that_cannot_be_read_is_refused_when_it_is_called(tool: dict[str, Any], said: str) -> None:
    library = autodesk(tool, {**entry(), "post-process": {"number": 4}})
    assert library.tool(4).number == 4
    with pytest.raises(InputError, match=r"lib\.json: error: tool 3") as raised:
        library.tool(3)
    assert said in str(raised.value)
    assert "state the tool itself" in str(raised.value)


def test_two_tools_of_one_number_are_not_chosen_from() -> None:
    with pytest.raises(InputError, match="2 tools have the number 3: T one"):
        autodesk(entry(), entry()).tool(3)


def test_a_long_flute_in_the_holder_cuts_only_below_it() -> None:
    assert autodesk(entry(LCF=70.0, LB=40.0, RE=5.0)).tool(3).flute_length == 40.0


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"{}", "is JSON, but neither a tool library nor a tool bit"),
        (b"[]", "is no tool library that is known here"),
        (b"MZ", "is no tool library that is known here"),
        (b'{"data": 3}', "data is no list"),
        (b'{"data": [3]}', "data[0] is no object"),
        (b'{"data": [', "is not JSON"),
        (b'{"data": [NaN]}', "NaN is no number"),
        (b'{"data": [], "data": []}', "an object has a key twice"),
        (b'{"data": ' + b"[" * 200_000, "nests too deeply"),
        (b'{"data": ' + b"9" * 10_000, "is not JSON"),
        (b'{"a": "\xff"}', "is not UTF-8 text"),
        (b'{"data": [' + b"3," * 30_000 + b"3]}", "data has 30001 entries, more than 20000"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_is_no_library_is_refused(data: bytes, said: str) -> None:
    with pytest.raises(InputError) as raised:
        _from_json("lib.json", data)
    assert said in str(raised.value)


def archive(files: dict[str, bytes], packing: int = zipfile.ZIP_DEFLATED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", packing) as found:
        for name, content in files.items():
            found.writestr(name, content)
    return packed.getvalue()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (archive({"tools.json": bytes(33 << 20)}), "grows to more than 32 MB"),
        (archive({"a.json": b"{}", "b.json": b"{}"}), "is an archive with 2 files, 2 of them JSON"),
        (archive({"a.txt": b"{}"}), "is an archive with 1 file, 0 of them JSON"),
        (archive({f"{n}.json": b"" for n in range(101)}), "more than 100 files"),
        (archive({"tools.json": b"{}" * 99})[:-30], "is a damaged archive"),
        (archive({"tools.json": b"{}"}, zipfile.ZIP_LZMA), "rare packing"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_bombs_and_odd_archives_are_refused(data: bytes, said: str) -> None:
    with pytest.raises(InputError) as raised:
        _unpack("shop.tools", data)
    assert said in str(raised.value)


def test_texts_that_are_too_long_are_refused_unread(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="more than 32 MB of tools"):
        parse_json("lib.json", bytes((32 << 20) + 1))
    table = tmp_path / "tool.tbl"
    table.write_bytes(b"\n" * 1_000_001)
    with pytest.raises(InputError, match="has more than 1000000 bytes"):
        read_tools(table, "mm")


# FreeCAD


def bit(shape: str, **parameters: object) -> ToolLibrary:
    sizes = {"Diameter": "6.0000 mm", "CuttingEdgeHeight": "20 mm", "Length": "50.0000 mm", "ShankDiameter": "3 mm"}
    root = {"version": 2, "name": "bit", "shape": shape, "parameter": {**sizes, **parameters}, "attribute": {}}
    return _from_json("bit.fctb", json.dumps(root).encode())


#: Tool bits of which FreeCAD has made bodies, and the volumes of these, mm³.
BODIES: dict[str, tuple[dict[str, object], float]] = {
    "endmill.fcstd": ({"Diameter": 5.0, "CuttingEdgeHeight": 30.0}, 730.3627),
    "ballend.fcstd": ({"Diameter": "5 mm", "CuttingEdgeHeight": "40.0 mm"}, 839.7791),
    "bullnose.fcstd": ({"CornerRadius": 1.5, "Diameter": 5.0, "CuttingEdgeHeight": 40.0}, 849.5734),
    "torus.fcstd": ({"FlatRadius": 1.0, "Diameter": "0.5 cm", "CuttingEdgeHeight": 40.0}, 849.5734),
    "reamer.fcstd": ({"Diameter": 5.0, "CuttingEdgeHeight": 30.0}, 730.3627),
    "drill.fcstd": (
        {"Diameter": 3.0, "TipAngle": "119.0 °", "CuttingEdgeHeight": None, "ShankDiameter": None}, 349.2655,
    ),
    "tap.fcstd": (
        {
            "Diameter": 8.0, "CuttingEdgeLength": 25.0, "CuttingEdgeHeight": None, "Length": 60.0, "ShankDiameter": 6.0,
            "TipAngle": "90.0 deg",
        },
        2200.1621,
    ),
    "chamfer.fcstd": (
        {
            "CuttingEdgeAngle": "60 °", "CuttingEdgeHeight": 6.35, "Diameter": 12.0, "Length": 30.0,
            "ShankDiameter": "0.25 in", "TipDiameter": 5.0,
        },
        1146.4439,
    ),
    "Shapes/v-bit.fcstd": (
        {
            "CuttingEdgeAngle": "90 °", "CuttingEdgeHeight": 1.0, "Diameter": 10.0, "Length": 20.0,
            "ShankDiameter": 5.0, "TipDiameter": 1.0,
        },
        493.7541,
    ),
    "taperedballnose.fcstd": (
        {
            "CuttingEdgeHeight": 19.05, "Diameter": 1.5875, "Length": 63.5, "ShankDiameter": 6.35,
            "TaperAngle": "11.0 deg", "TaperDiameter": 6.35,
        },
        1547.4947,
    ),
    "thread-mill.fcstd": (
        {
            "Crest": 0.1, "Diameter": 5.0, "NeckDiameter": 3.0, "NeckLength": 20.0, "ShankDiameter": 5.0,
            "cuttingAngle": "60.0 deg", "CuttingEdgeHeight": None,
        },
        738.2595,
    ),
}  # fmt: skip


@pytest.mark.parametrize("shape", BODIES)
def test_a_tool_bit_has_the_volume_of_its_body(shape: str) -> None:
    parameters, volume = BODIES[shape]
    found = bit(shape, **parameters).tool(3, "bit")
    assert found.number is None
    # FreeCAD puts a tiny cone where the shank begins.
    assert pieces_volume(revolved_pieces(found, 1e-4)[0]) == pytest.approx(volume, rel=7e-4)


@pytest.mark.parametrize(
    ("library", "said"),
    [
        (bit("slittingsaw.fcstd"), "slittingsaw is a shape that is not read"),
        (bit("endmill.fcstd", Diameter="6 stone"), "Diameter has the unit stone"),
        (bit("endmill.fcstd", Diameter=-6), "Diameter is -6"),
        (bit("endmill.fcstd", Diameter=None), "its diameter is not stated"),
        (bit("drill.fcstd", TipAngle="6 mm"), "TipAngle has the unit mm"),
        (bit("drill.fcstd"), "its tip angle is not stated"),
        (bit("thread-mill.fcstd"), "a tooth needs NeckDiameter and cuttingAngle"),
        (bit("taperedballnose.fcstd"), "its side angle is not stated"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_tool_bit_that_cannot_be_read_is_refused(library: ToolLibrary, said: str) -> None:
    with pytest.raises(InputError, match=r"bit\.fctb: error: tool bit bit") as raised:
        library.tool(None, "bit")
    assert said in str(raised.value)


@pytest.mark.parametrize(
    ("text", "diameter"),
    [
        ("0,25 in", 6.35),
        ("6,000 mm", 6.0),
        ('3/8"', 9.525),
        ("3/8 in", 9.525),
        ('1 1/2"', 38.1),
        ("1+1/2 in", 38.1),
        ("3/8″", 9.525),
        ("3/8''", 9.525),
        (".25 inch", 6.35),
        ("0.25\xa0in", 6.35),
        ("+6 mm", 6.0),
        ("6e0 mm", 6.0),
        ("6000 µm", 6.0),
        ("250 thou", 6.35),
        ("0.5 ft", 152.4),
    ],
)
def test_a_size_may_have_a_comma_or_be_a_fraction_of_an_inch(text: str, diameter: float) -> None:
    assert bit("endmill.fcstd", Diameter=text).tools[0].sizes.diameter == pytest.approx(diameter)


@pytest.mark.parametrize("text", ["1.234,5 mm", "1,234.5 mm", "3/0 in", "3/8", "3/8 mm", "1/2/3 in"])
def test_other_numbers_are_none(text: str) -> None:
    with pytest.raises(InputError, match="not a number with its unit"):
        bit("endmill.fcstd", Diameter=text).tool(None, "bit")


@pytest.mark.parametrize(
    ("shape", "parameters", "said"),
    [
        ("endmill.fcstd", {"CuttingEdgeHeight": "60 mm"}, "CuttingEdgeHeight is 60 mm, more than Length, 50 mm"),
        ("torus.fcstd", {"FlatRadius": 1.0, "TorusRadius": 1.0}, "the radius of its corner is 2 mm by one"),
        ("bullnose.fcstd", {"CornerRadius": 1.0, "TorusRadius": 2.0}, "the radius of its corner is 1 mm by one"),
        ("endmill.fcstd", {"CornerRadius": 1.0}, "CornerRadius is 1, and a bit of the shape endmill has 0"),
        ("ballend.fcstd", {"TorusRadius": 1.0}, "TorusRadius is 1, and a bit of the shape ballend has 3"),
        ("ballend.fcstd", {"FlatRadius": 1.0}, "FlatRadius is 1, and a bit of the shape ballend has 0"),
        ("endmill.fcstd", {"TipAngle": "118°"}, "TipAngle is 118, and a bit of the shape endmill has 180"),
    ],
)
def test_a_tool_bit_that_contradicts_itself_is_refused(shape: str, parameters: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        bit(shape, **parameters).tool(None, "bit")


@pytest.mark.parametrize(
    ("shape", "parameters"),
    [
        ("endmill.fcstd", {"CornerRadius": 0.0, "FlatRadius": 3.0, "TipAngle": 180.0}),
        ("ballend.fcstd", {"CornerRadius": 3.0, "FlatRadius": 0.0}),
    ],
)
def test_a_tool_bit_may_say_what_its_shape_has(shape: str, parameters: dict[str, object]) -> None:
    assert bit(shape, **parameters).tools[0].sizes.diameter == pytest.approx(6.0)


def test_a_tool_bit_with_two_shapes_is_refused() -> None:
    root = {"name": "bit", "shape": "ballend.fcstd", "shape-type": "Endmill", "parameter": {"Diameter": 6.0}}
    with pytest.raises(InputError, match=r"endmill by its shape-type, and its shape is ballend\.fcstd"):
        _from_json("bit.fctb", json.dumps(root).encode()).tool(None, "bit")


# LinuxCNC


def table(folder: Path, text: str, unit: str = "mm") -> ToolLibrary:
    file = folder / "tool.tbl"
    file.write_bytes(text.encode("latin-1"))
    return read_tools(file, unit)


def test_a_tool_table_gives_diameters_and_no_form(tmp_path: Path) -> None:
    text = "; head\r\nT1 P1 D0.5 Z+0.511 ;1/2 end mill, \xbd\r\nT2 P2 Z+0.1\n\n t99999 p3 d.25 ;\n"
    found = table(tmp_path, text, "inch")
    assert found.diameters == {1: 12.7, 99999: 6.35}
    assert found.tools == ()
    with pytest.raises(InputError, match="has no tool of the number 1"):
        found.tool(1)


def test_a_line_that_linuxcnc_skips_makes_its_own_tool_unusable(tmp_path: Path) -> None:
    text = "T1 P1 D10\nT1 P2 D5\nP3 D5\nT4 P4 D5 D6\nT5 P5 DIAM\nT-1 P1\nT1.5 P1\nT7 P7 D-3\nT8 K1\nT9 P9 D8\n"
    found = table(tmp_path, text)
    assert found.diameters == {9: 8.0}
    assert [(tool.number, tool.problems[0].line, tool.problems[0].what) for tool in found.unusable] == [
        (1, 2, "tool 1 is there twice"),
        (None, 3, "has no number of a tool, which is a whole number behind T"),
        (4, 4, "has D twice"),
        (5, 5, '"DIAM" is no word of a tool table'),
        (None, 6, "has no number of a tool, which is a whole number behind T"),
        (None, 7, "has no number of a tool, which is a whole number behind T"),
        (7, 8, "tool 7 has the diameter -3"),
        (8, 9, '"K1" is no word of a tool table'),
    ]
    with pytest.raises(InputError, match="has D twice"):
        found.tool(4)


def test_a_text_without_a_line_of_a_tool_table_is_refused_with_its_lines(tmp_path: Path) -> None:
    with pytest.raises(InputError) as raised:
        table(tmp_path, "G0 X1\nsome text\n")
    assert [problem.line for problem in raised.value.problems] == [1, 2]


@pytest.mark.parametrize(("unit", "said"), [("", "unit: error: is not stated"), ("cm", 'unit: error: is "cm"')])
def test_a_tool_table_needs_its_unit(unit: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        table(tmp_path, "T1 P1 D10\n", unit)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from([
        "data", "type", "unit", "geometry", "DC", "LCF", "LB", "holder", "shaft", "segments", "post-process", "number",
    ]), inner, max_size=5),
    max_leaves=20,
)  # fmt: skip


@settings(max_examples=examples(25))
@given(st.lists(st.builds(lambda base, more: {**base, **more}, st.just(entry()), st.dictionaries(
    st.sampled_from(["unit", "geometry", "holder", "shaft", "post-process", "description"]), JSON, max_size=3,
)), max_size=3))  # fmt: skip
def test_odd_values_make_a_tool_unusable_and_nothing_else(tools: list[dict[str, Any]]) -> None:
    library = autodesk(*tools)
    assert len(library.tools) + len(library.unusable) == len(tools)
    assert all(tool.shape().sections for tool in library.tools)
    assert all(tool.problems for tool in library.unusable)
