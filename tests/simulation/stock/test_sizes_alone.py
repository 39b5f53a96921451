"""Sizes of a stock as drawings have them, without the word of a solid: the cure has the text to write."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.simulation.stock.solids import stock_shape


@pytest.mark.parametrize(
    ("text", "cure"),
    [
        ("120x80x30", "write box:120,80,30 for a block"),
        ("120 X 80.5 X 30", "write box:120,80.5,30 for a block"),
        ("100,80,30,-50,-40,-30", "write box:100,80,30,-50,-40,-30 for a block"),
        ("12.5,30", "write box:X,Y,Z[,x0,y0,z0] or cylinder:D,H[,z0]"),
    ],
)
def test_sizes_without_a_word_are_answered_with_what_to_write(text: str, cure: str) -> None:
    with pytest.raises(InputError) as raised:
        stock_shape(text)
    (problem,) = raised.value.problems
    assert (problem.code, problem.cure.startswith(cure)) == ("SIM122", True)


def test_a_file_that_is_called_so_is_looked_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("120x80x30").touch()
    with pytest.raises(InputError) as raised:
        stock_shape("120x80x30")
    assert raised.value.problems[0].code == "SIM211"
