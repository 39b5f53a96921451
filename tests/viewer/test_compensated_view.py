"""A page moves the tool's centre as the control does under radius compensation, or says that it does not."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.jobs.view.viewing import prepare_view
from trunnion.viewer.motion import COUNT

#: The contour of a pocket of 92 by 60 mm, and a cutter of 12 mm.
CONTOUR = Path(__file__).parents[1] / "golden/compensation/contour_pocket.cls"
TOOL = "1=flat:12,length=75,flutes=30"


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("view") / "pocket.mpf"
    trunnion.post(CONTOUR, machine="yl569", output=found, settings={"radius_register": "radius"})
    return found


def widths(content: object) -> tuple[float, float]:
    """How far the linear axes X and Y go while the tool cuts, mm."""
    found = []
    axes = content.scene["machine"]["axes"]  # type: ignore[attr-defined]
    columns = content.columns  # type: ignore[attr-defined]
    cuts = columns["kind"][columns["row"]] != 0
    for name in ("X", "Y"):
        k = next(k for k, axis in enumerate(axes) if axis["name"] == name)
        values = columns[f"axis-{k}"][1:][cuts] * COUNT
        found.append(float(np.ptp(values)))
    return found[0], found[1]


@pytest.mark.parametrize(
    ("given", "x", "y", "said"),
    [
        ({"radius_register": "radius", "tools": [TOOL]}, 80.0, 48.0, ""),
        ({"radius_register": "radius"}, 92.0, 60.0, "the radius of the tool is not known"),
        ({"tools": [TOOL]}, 92.0, 60.0, "nobody has stated what its register holds: the programmed path"),
        ({"cl": CONTOUR}, 80.0, 48.0, "its register holds: the tool is taken to go its radius beside them"),
        ({"radius_register": "difference"}, 92.0, 60.0, ""),
    ],
)
def test_the_page_moves_the_centre_or_says_so(
    given: dict[str, object], x: float, y: float, said: str, program: Path
) -> None:
    content = prepare_view(program, machine="yl569", zero=(0.0, 0.0, -200.0), tool_length=150.0, **given)  # type: ignore[arg-type]
    assert widths(content) == pytest.approx((x, y), abs=1e-3)
    remarks = " ".join(content.said()["remarks"])
    assert (said in remarks) if said else not remarks


def test_rows_that_are_inserted_have_the_lines_and_times_of_their_blocks(tmp_path: Path) -> None:
    boss, program = CONTOUR.with_name("contour_boss.cls"), tmp_path / "boss.mpf"
    trunnion.post(boss, machine="yl569", output=program)
    content = prepare_view(program, machine="yl569", radius_register="radius", cl=boss)
    plain = prepare_view(program, machine="yl569", radius_register="difference", cl=boss)
    rows = content.rows
    assert len(rows.run) > len(plain.rows.run)
    for name in ("line", "cl", "tool", "phase"):
        assert np.array_equal(content.columns[name], plain.columns[name][rows.own]), name
    assert len({len(content.columns[name]) for name in ("line", "file", "kind", "tool", "feed", "cl", "phase")}) == 1
    assert content.columns["seconds"].sum() == pytest.approx(plain.columns["seconds"].sum(), rel=1e-5)
    ends = [(each["first"], each["end"]) for each in content.scene["operations"]]
    assert ends == [(rows.row(each["first"]), rows.row(each["end"])) for each in plain.scene["operations"]]


def test_stock_and_path_have_the_same_rows(program: Path) -> None:
    content = prepare_view(
        program, machine="yl569", radius_register="radius", tools=[TOOL], stock="box:120,80,10,-60,-40,-9", cell=2.0
    )
    assert len(content.columns["removed"]) == len(content.columns["line"])


def test_cl_files_are_posted_and_shown_as_the_register_holds() -> None:
    content = prepare_view(CONTOUR, machine="yl569", radius_register="radius")
    assert widths(content) == pytest.approx((80.0, 48.0), abs=1e-3)
    assert content.scene["remarks"] == []
