"""Tables of points: what is read, and what is wrong with them."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError, Severity
from trunnion.geometry.fitting import Wanted, fit
from trunnion.geometry.point_faults import point_faults
from trunnion.geometry.point_tables import PointTable, parse_point_table, read_point_table

ROWS = [[1.5, 2.0, 3.0], [4.0, -5.25, 6.0], [7.0, 8.0, 9.0]]


@pytest.mark.parametrize(
    "text",
    [
        "x,y,z\n1.5,2,3\n4,-5.25,6\n7,8,9\n",
        "x_mm;y_mm;z_mm\n1,5;2;3\n4;-5,25;6\n7;8;9\n",
        "# measured\n\n 1.5 2 3\n4 -5.25 6\n7 8 9",
        "1 1.5 2 3\r\n2 4 -5.25 6\r\n3 7 8 9\r\n",
        "Z\tY\tX\n3\t2\t1,5\n6\t-5,25\t4\n9\t8\t7\n",
        '"X (mm)","Y (mm)","Z (mm)","note"\n1.5,2,3,first\n4,-5.25,6,\n7,8,9,\n',
    ],
)
def test_a_table_may_be_parted_and_named_in_many_ways(text: str) -> None:
    (table,) = parse_point_table("points.csv", text)
    np.testing.assert_array_equal(table.points, ROWS)


def test_several_curves_in_mm_and_inches_each_with_its_length() -> None:
    text = "no,tip_x,tip_y,tip_z,hub_x_in,hub_y_in,hub_z_in\n1,1,2,3,1,1,1\n2,4,5,6,2,2,2\n3,7,8,10,,,\n"
    tip, hub = parse_point_table("points.csv", text)
    assert (tip.name, tip.points.shape, list(tip.lines)) == ("tip", (3, 3), [2, 3, 4])
    assert hub.name == "hub"
    np.testing.assert_allclose(hub.points, [[25.4] * 3, [50.8] * 3])


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "points.csv: error: holds no points; name the columns x, y and z"),
        ("x,y,z\n", "points.csv:1: error: has no points of the curve"),
        ("a,b,c\n1,2,3\n", "points.csv:1: error: names no columns of points"),
        ("1,2\n3,4\n", "points.csv:1: error: has 2 columns without names"),
        ("tip_x,tip_y\n1,2\n", "points.csv:1: error: the curve tip has no column for z"),
        ("x,x,z\n1,2,3\n", "points.csv:1: error: has two columns for x"),
        ("x_mm,y_in,z_mm\n1,2,3\n", "points.csv:1: error: the curve  ?is in mm and in inches"),
        ("x,y,z\n1,2,3\n1,2\n", "points.csv:3: error: has 2 columns where the first line has 3"),
        ("x,y,z\n1,2,3\n1,two,3\n", "points.csv:3: error: 'two' is not a number"),
        ("x,y,z\n1,2,3\n1,nan,3\n", "points.csv:3: error: 'nan' is not a number"),
        ("x,y,z\n1,2,3\n1,1_0,3\n", "points.csv:3: error: '1_0' is not a number"),
        ("x;y;z\n1.234,5;2;3\n", "points.csv:2: error: '1.234,5' is not a number"),
        ("x,y,z\n1,2,3\n1,,3\n", "points.csv:3: error: '' is not a number"),
        ("x,y,z\n1,2,3\n1,2,1e9\n", "points.csv:3: error: is 1e[+]09 mm away"),
        (
            "tip_x,tip_y,tip_z,hub_x_cm,hub_y_cm,hub_z_cm\n1,2,3,4,5,6\n",
            "points.csv:1: error: the column hub_x_cm is in cm",
        ),
        ("x [um],y [um],z [um]\n1,2,3\n", "points.csv:1: error: the column x .um. is in um; write mm or inches"),
        ("1,5 2,5 3\n4 5 6\n", "points.csv:1: error: '5 2' is not a number; write points for decimals, or part"),
        ("x,y,z\n1,2,3\n,,\n4,5,6\n", "points.csv:4: error: the curve  ?goes on after it ended in line 3"),
    ],
)
def test_what_is_wrong_with_a_table_is_named_with_its_line(text: str, what: str) -> None:
    with pytest.raises(InputError, match=what):
        parse_point_table("points.csv", text)


def test_every_mistake_is_told_at_once_in_the_order_of_the_lines() -> None:
    with pytest.raises(InputError) as raised:
        parse_point_table("points.csv", "a_x,a_y,a_z,b_x,b_y,b_z\n1,2,3,4,5,q\n1,2\n1,p,3,4,5,6\n")
    assert [problem.line for problem in raised.value.problems] == [2, 3, 4]


@pytest.mark.parametrize(
    ("rows", "what"),
    [
        ("1,0,0\n2,0,0\n", ":2: error: the curve has 2 points; give at least 3"),
        ("1,0,0\n2,0,0\n2,0,0\n3,1,0\n", ":4: error: the curve has the same point here as in line 3"),
    ],
)
def test_points_that_make_no_curve_are_errors(rows: str, what: str) -> None:
    (table,) = parse_point_table("points.csv", "x,y,z\n" + rows)
    with pytest.raises(InputError, match=what):
        fit(table, Wanted())


@pytest.mark.parametrize(
    ("rows", "line", "what"),
    [
        ("0,0,0\n1,0,0\n3,0,0\n2,0,0.1\n4,0,0\n", 4, "the curve turns back here by"),
        ("0,0,0\n1,0,0\n2,0,0\n3,0,0\n90,0,0\n91,0,0\n", 6, "the curve has a gap of 87.000 mm before this point"),
    ],
)
def test_points_out_of_order_and_gaps_are_warnings(rows: str, line: int, what: str) -> None:
    (table,) = parse_point_table("points.csv", "x,y,z\n" + rows)
    first = next(point_faults(table))
    assert (first.severity, first.line) == (Severity.WARNING, line)
    assert what in first.what


def test_files_are_read_in_their_encoding_and_others_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_bytes("叶片前缘曲线_x,叶片前缘曲线_y,叶片前缘曲线_z\n1,2,3\n4,5,6\n7,8,10\n".encode("gb18030"))
    assert read_point_table(file)[0].name == "叶片前缘曲线"
    file.write_bytes(b"\xef\xbb\xbfx,y,z\n1,2,3\n")
    assert read_point_table(file)[0].points.shape == (1, 3)
    file.write_text("x,y,z\n1,2,3\n", "utf-16")
    with pytest.raises(InputError, match="it holds zero bytes, as UTF-16 does; save it as UTF-8"):
        read_point_table(file)
    with pytest.raises(InputError, match="is a folder, not a table of points"):
        read_point_table(tmp_path)
    with pytest.raises(InputError, match="file not found"):
        read_point_table(tmp_path / "none.csv")


def test_points_are_not_so_many_that_a_curve_takes_minutes() -> None:
    with pytest.raises(InputError, match=r"points\.csv:20002: error: has 20001 points, and 20000 make a curve at most"):
        parse_point_table("points.csv", "x,y,z\n" + "1,2,3\n" * 20_001)
    table = PointTable("points", "", np.random.default_rng(1).normal(size=(20_001, 3)), range(1, 20_002))
    with pytest.raises(InputError, match="has 20001 points, and 20000 make a curve at most"):
        fit(table, Wanted())
