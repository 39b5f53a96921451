"""Tables of points as Chinese books print them: repeated columns with ``X/(mm)``, and names of curves above them."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError
from trunnion.geometry.point_tables import parse_point_table, read_point_table

PRINTED = "序号\tX/(mm)\tY/(mm)\tZ/(mm)\tX/(mm)\tY/(mm)\tZ/(mm)\n1\t1\t2\t3\t4\t5\t6\n2\t2\t2\t3\t5\t5\t6\n"


@pytest.mark.parametrize(
    ("above", "names"),
    [
        ("", ["curve_1", "curve_2"]),
        ("\t叶顶曲线\t\t\t叶根曲线\t\t\n", ["叶顶曲线", "叶根曲线"]),
        ("序号\t叶顶曲线\t\t\t叶根曲线\n", ["叶顶曲线", "叶根曲线"]),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "gbk", "utf-8-sig"])
def test_curves_side_by_side(above: str, names: list[str], encoding: str, tmp_path: Path) -> None:
    file = tmp_path / "表.txt"
    file.write_bytes((above + PRINTED).encode(encoding))
    tables = read_point_table(file)
    assert [table.name for table in tables] == names
    assert np.array_equal(tables[0].points, [[1, 2, 3], [2, 2, 3]])
    assert np.array_equal(tables[1].points, [[4, 5, 6], [5, 5, 6]])


def test_the_number_of_the_point_may_have_no_name() -> None:
    without = PRINTED.replace("序号", "", 1)
    (first, second) = parse_point_table("t", "序号\t叶顶曲线\t\t\t叶根曲线\n" + without)
    assert (first.name, second.name, len(first.points)) == ("叶顶曲线", "叶根曲线", 2)


@pytest.mark.parametrize("name", ["X/(mm)", "X/mm", "X（mm）", "X(毫米)", "x_mm"])
def test_units_as_they_are_written(name: str) -> None:
    head = ",".join(name.replace("X", axis).replace("x", axis.lower()) for axis in "XYZ")
    (table,) = parse_point_table("t", f"{head}\n1,2,3\n")
    assert np.array_equal(table.points, [[1, 2, 3]])


def test_a_curve_with_a_column_too_many_is_refused() -> None:
    with pytest.raises(InputError, match="two columns for X"):
        parse_point_table("t", "X,Y,Z,X\n1,2,3,4\n")


def test_another_unit_behind_a_slash_is_refused() -> None:
    with pytest.raises(InputError, match="is in cm"):
        parse_point_table("t", "X/(cm),Y/(cm),Z/(cm)\n1,2,3\n")
