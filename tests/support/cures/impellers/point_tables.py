"""Cures of messages about tables of measured points, and curves through them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome
from tests.support.cures.reading import ended, file_of, limited, whole
from trunnion.errors import Problem
from trunnion.geometry import point_tables
from trunnion.geometry.point_tables import read_point_table

_TABLE: Final = "x,y,z\n0,0,0\n10,1,0\n20,4,0\n30,9,0\n40,16,0\n50,25,0\n"
_TWO: Final = "hub_x,hub_y,hub_z,tip_x,tip_y,tip_z\n0,0,0,0,0,9\n10,1,0,10,1,9\n20,4,0,20,4,9\n"


def _fitted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Fit a curve to the points of a table; settings are arguments."""
    file, heard = folder / "points.csv", list[Problem]()
    file.write_text(text, encoding="utf-8")
    given: dict[str, Any] = dict(settings)
    given |= {name: float(given[name]) for name in ("tolerance", "fair") if name in given}
    given |= {name: [float(each) for each in given[name].split(",")] for name in ("weights",) if name in given}

    def fit() -> None:
        for table in trunnion.read_points(file):
            heard.extend(trunnion.fit_curve(table, **given).remarks)

    return ended(fit, heard)


_READ: Final = file_of("points.csv", read_point_table)
_file: Final = whole("IMP110", _READ)
_columns: Final = whole("IMP111", _READ)
_cells: Final = whole("IMP112", _READ)
_units: Final = whole("IMP113", _READ)


def _path(code: str, variant: str, point: str, *instead: str) -> Cure:
    """A point between the others, and what stands in its place."""
    return Cure(code, variant, _fitted, _TABLE.replace("30,9,0\n", point), ((point, "".join(instead)),))


CURES: Final = (
    Cure("IMP110", "larger_mb", limited(_READ, point_tables, "_MOST_BYTES", 80), _TABLE * 2, ((_TABLE * 2, _TABLE),)),
    _file("no_text_utf", "\0".join(_TABLE), _TABLE),
    _columns("no_points", _TWO.replace("0,0,9", ",,").replace("10,1,9", ",,").replace("20,4,9", ",,"), _TWO),
    _columns("holds_no_points", "", _TABLE),
    _columns("column_without_names", "0,0,0,0,0,0\n1,0,0,1,0,0\n", _TWO),
    _columns("names_no_columns", _TABLE.replace("x,y,z", "a,b,c"), _TABLE),
    _columns("two_columns", _TABLE.replace("x,y,z", "x,y,z,x").replace(",0\n", ",0,0\n"), _TABLE),
    _columns(
        "curve_no_column", _TABLE.replace("x,y,z", "tip_x,tip_y,height"), _TABLE.replace("x,y,z", "tip_x,tip_y,tip_z")
    ),
    _cells("curve_goes_after", _TWO.replace("0,0,0,0,0,9", "0,0,0,,,").replace("10,1,0,10,1,9", "10,1,0,,,"), _TWO),
    _cells("curve_goes_after", _TWO.replace("10,1,9", ",,"), _TWO.replace("10,1,9", ",,").replace("20,4,9", ",,")),
    _cells("column_where_first", _TABLE.replace("10,1,0", "10,1"), _TABLE),
    _cells("no_number", _TABLE.replace("10,1,0", "10,one,0"), _TABLE),
    _cells("no_number_but_commas", "x y z\n0,5 1 2\n3 4 5\n", "x y z\n0.5 1 2\n3 4 5\n"),
    _units("column", _TABLE.replace("x,y,z", "x_cm,y_cm,z_cm"), _TABLE.replace("x,y,z", "x_mm,y_mm,z_mm")),
    _units("curve_mm_inches", _TABLE.replace("x,y,z", "x_mm,y_mm,z_in"), _TABLE.replace("x,y,z", "x_mm,y_mm,z_mm")),
    _units("mm_away", _TABLE.replace("50,25", "50000000,25000000"), _TABLE),
    Cure("IMP120", "points", _fitted, _TABLE[:18], ((_TABLE[:18], _TABLE),)),
    Cure("IMP120", "too_many", limited(_READ, point_tables, "MOST_POINTS", 5), _TABLE, (("20,4,0\n", ""),)),
    _path("IMP121", "same_point_here", "20,4,0\n30,9,0\n", "30,9,0\n"),
    Cure(
        "IMP122",
        "turns_back_here",
        _fitted,
        _TABLE.replace("10,1,0\n20,4,0\n", "20,4,0\n10,1,0\n"),
        (("20,4,0\n10,1,0\n", "10,1,0\n20,4,0\n"),),
    ),
    Cure("IMP122", "gap_mm_before", _fitted, _TABLE.replace("50,25,0", "900,800,0"), (("900,800,0", "50,25,0"),)),
    Cure("IMP123", "runs_back_before", _fitted, _TABLE, ({"start": None},), {"start": "tangent:-1,0,0"}),
    Cure("IMP123", "runs_back_before", _fitted, _TABLE, ({"start": "tangent:1,0,0"},), {"start": "tangent:-1,0,0"}),
    Cure(
        "IMP130",
        "curve_through_points",
        _fitted,
        _TABLE,
        ({"start": None},),
        {"start": "tangent:1,0,0", "tolerance": "0.1"},
    ),
    Cure(
        "IMP130",
        "curve_through",
        _fitted,
        _TABLE,
        ({"tolerance": None},),
        {"weights": "1,1,1,1,1,1", "tolerance": "0.1"},
    ),
    Cure("IMP131", "is", _fitted, _TABLE, ({"start": "tangent:1,0,0"},), {"start": "along X"}),
    Cure("IMP132", "needs_points", _fitted, _TABLE[:26], ({"fair": None},), {"fair": "0.1"}),
    Cure("IMP132", "not_number_above", _fitted, _TABLE, ({"weights": "1,1,1,1,1,1"},), {"weights": "1,1"}),
    Cure("IMP132", "vary_so_much", _fitted, _TABLE, ({"weights": "1,2,1,1,2,1"},), {"weights": "1,100,1,1,100,1"}),
)
