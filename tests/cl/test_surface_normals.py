"""Contact points behind GOTOs, and the surface's normals that they come to."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from tests.support.locations import SHARED
from trunnion.arrays import Floats
from trunnion.cl import read_cl, surface_normals
from trunnion.cl.surface_normals import contact_points, with_normals
from trunnion.errors import InputError, Severity
from trunnion.model.toolpath import Toolpath

HEAD = "TOOL PATH/OP,TOOL,T1\nTLDATA/MILL,{d},{r},75.0,{taper},0.0\n$$ centerline and contact point\n"
FOOT = "END-OF-PATH\n"

UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array).filter(lambda v: float(np.linalg.norm(v)) > 0.1)


def read(text: str, folder: Path) -> Toolpath:
    file = folder / "contact.cls"
    file.write_text(text, encoding="utf-8")
    return with_normals(read_cl(file))


def unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


@given(
    radius=st.floats(0.5, 10.0),
    core=st.sampled_from([0.0, 0.0, 1.5, 12.0]),
    axis=UNIT,
    normal=UNIT,
    stock=st.floats(-0.2, 2.0),
    tip=st.tuples(*[st.floats(-90.0, 90.0)] * 3),
    inside=st.floats(0.0, 0.99),
)
def test_a_tool_laid_against_a_plane_touches_it_along_its_normal(
    tmp_path_factory: pytest.TempPathFactory,
    radius: float,
    core: float,
    axis: Floats,
    normal: Floats,
    stock: float,
    tip: tuple[float, float, float],
    inside: float,
) -> None:
    """The tool is put against a plane by its outline: the corner's circle, or the flat bottom on a plane square to it.

    ``core`` is the radius of the circle on which the corner's centres lie, and ``stock`` is left on the plane.
    """
    axis, normal = unit(axis), unit(normal)
    aside = normal - (normal @ axis) * axis
    size = float(np.linalg.norm(aside))
    bottom = size < 0.02 or inside < 0.1
    if bottom:  # the plane is square to the tool, which touches it anywhere on its flat bottom
        normal, across = axis, unit(np.cross(axis, [0.3, 0.5, -0.7] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0]))
        centre = np.array(tip) + radius * axis + core * inside * across
    else:
        if normal @ axis < 0.0:  # a tool never touches with its back
            normal = normal - 2.0 * (normal @ axis) * axis
            aside = normal - (normal @ axis) * axis
        centre = np.array(tip) + radius * axis - core * unit(aside)
    touched = centre - (radius + stock) * normal
    event(f"bottom {bottom}, ball {core == 0.0}")
    rows = ",".join(f"{v:.9f}" for v in (*tip, *axis)) + " $$ " + ",".join(f"{v:.9f}" for v in touched)
    text = HEAD.format(d=f"{2 * (radius + core):.6f}", r=f"{radius:.6f}", taper=0.0) + f"GOTO/{rows}\n" + FOOT
    found = read(text, tmp_path_factory.getbasetemp()).operations[0].moves.normal
    assert found is not None
    assert np.abs(found[0] - normal).max() < 1e-5 / min(radius + stock, 1.0)


LINES = st.lists(
    st.sampled_from(
        [
            "GOTO/1.5,2,-3 $$ 1.25,-2.5,+.5",
            "GOTO/1,2,3$$-7,8.125 , 9",
            "GOTO/1,2,3",
            "GOTO/1,2,3 $$ a word",
            "GOTO/1,2,3 $$ 1,2",
            "GOTO/1,2,3 $$ 1,2,3,4",
            "GOTO/1,2,3 $$ 1,2,3 mm",
            "GOTO/1,2,$\n3",
            "$$ centerline data",
            "$$ centerline and Contact Point",
            "PAINT/COLOR,31",
            "FEDRAT/MMPM,100.0 $$ 1,2,3",
            "PPRINT/$$ centerline and contact point",
        ]
    ),
    max_size=12,
)


def naive(text: str) -> list[tuple[float, ...] | None]:
    """What stands behind each GOTO, by a plain look at the lines."""
    found: list[tuple[float, ...] | None] = []
    announced = False
    number = r"\s*([-+]?(?:\d+\.?\d*|\.\d+))\s*"
    for line in text.splitlines():
        _, there, comment = line.partition("$$")
        if line.startswith("GOTO"):
            match = re.fullmatch(f"{number},{number},{number}", comment)
            found.append(tuple(map(float, match.groups())) if announced and match else None)
        elif line.startswith("TOOL PATH"):
            announced = False
        elif there and "contact point" in comment.lower():
            announced = True
    return found


@given(first=LINES, second=LINES, chunk=st.sampled_from([1, 7, 50, 1 << 20]), end=st.sampled_from(["\n", "\r\n"]))
def test_contact_points_are_those_that_a_plain_look_finds(
    tmp_path_factory: pytest.TempPathFactory, first: list[str], second: list[str], chunk: int, end: str
) -> None:
    parts = [
        [f"TOOL PATH/OP{k},TOOL,T1", *lines, "GOTO/9,9,9", "END-OF-PATH"] for k, lines in enumerate((first, second))
    ]
    text = "\n".join([*parts[0], *parts[1]]) + "\n"
    file = tmp_path_factory.getbasetemp() / "lines.cls"
    file.write_bytes(text.replace("\n", end).encode())
    line = np.array([k for k, each in enumerate(text.splitlines(), 1) if each.startswith("GOTO")])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(surface_normals, "_CHUNK", chunk)
        with file.open("rb") as source:
            found = contact_points(source, line.astype(np.int32))
    assert [None if np.isnan(row).any() else tuple(row.tolist()) for row in found] == naive(text)


GOTO = "GOTO/0,0,0 $$ 1,2,-0.5\n"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (HEAD.format(d=10, r=0, taper=0) + GOTO, "without a round corner"),
        (HEAD.format(d=10, r=1, taper=5) + GOTO, "whose form does not give"),
        (HEAD.format(d=10, r=1, taper=0) + "GOTO/0,0,0\n", "has no contact points"),
        (HEAD.format(d=10, r=1, taper=0).replace(" and contact point", "") + GOTO, "has no contact points"),
        (HEAD.format(d=10, r=1, taper=0).replace("MILL", "DRILL") + GOTO, "whose form does not give"),
    ],
)
def test_an_operation_without_normals_says_why(text: str, why: str, tmp_path: Path) -> None:
    found = read(text + FOOT, tmp_path)
    assert np.isnan(found.operations[0].moves.normal).all()  # type: ignore[arg-type]
    (remark,) = [each for each in found.remarks if why in each.what]
    assert (remark.line, remark.severity) == (1, Severity.WARNING)


def test_a_contact_point_on_the_core_names_no_direction(tmp_path: Path) -> None:
    text = HEAD.format(d=10, r=5, taper=0) + "GOTO/0,0,0 $$ 0,0,5.0002\nGOTO/1,0,0 $$ 1,0,0\n" + FOOT
    normal = read(text, tmp_path).operations[0].moves.normal
    assert normal is not None
    assert np.isnan(normal[0]).all()
    assert normal[1].tolist() == [0.0, 0.0, 1.0]


def test_contact_points_are_in_the_unit_of_the_file(tmp_path: Path) -> None:
    text = HEAD.format(d=0.5, r=0.25, taper=0) + "GOTO/1,2,3 $$ 0.8,2,3.25\n" + FOOT
    found = read("UNITS/INCHES\n" + text, tmp_path).operations[0].moves.normal
    assert found is not None
    assert np.abs(found[0] - [1.0, 0.0, 0.0]).max() < 1e-12


def test_a_file_that_is_gone_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.cls").write_text(HEAD.format(d=10, r=5, taper=0) + GOTO + FOOT, encoding="utf-8")
    found = read_cl(tmp_path / "a.cls")
    (tmp_path / "a.cls").unlink()
    with pytest.raises(InputError, match="cannot be read"):
        with_normals(found)


@pytest.mark.skipif(not SHARED.is_dir(), reason="the files of others are not here")
def test_the_normals_of_a_real_file_stand_on_its_surface() -> None:
    """A finish of a shallow floor, with a ball: normals look up, and where they change the path does."""
    operation = with_normals(read_cl(SHARED / "data" / "nx" / "toolpath-contact.cls")).operations[0]
    normal = operation.moves.normal
    assert normal is not None
    there = np.isfinite(normal[:, 0])
    assert int(there.sum()) == 831
    assert normal[there, 2].min() > 0.9
    rows = np.flatnonzero(there[1:] & there[:-1])
    way = operation.moves.tip[rows + 1] - operation.moves.tip[rows]
    length = np.linalg.norm(way, axis=1)
    along = np.abs(np.einsum("ij,ij->i", way, normal[rows] + normal[rows + 1])) / (2.0 * length)
    assert np.quantile(along[length > 0.5], 0.9) < 0.02  # the tool goes along the surface
