"""Faults that others than the authors made by hand in posted programs: each fails the check that the table names."""

import csv
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS

_FOLDER = TESTS / "data" / "hand_made"


def _rows() -> list[dict[str, str]]:
    text = (_FOLDER / "faults.tsv").read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE))


@cache
def _posted(part: str, machine: str) -> str:
    result = trunnion.post(_FOLDER / f"{part}.cls", machine=machine)
    assert result.text is not None
    return result.text


def _missed(rows: list[dict[str, str]], program: Path) -> Iterator[str]:
    """Yield the faults that the check of the table does not find."""
    for row in rows:
        old, new = (row[key].replace("\\n", "\n").replace("\\t", "\t") for key in ("written", "becomes"))
        text = _posted(row["part"], row["machine"])
        assert old in text, row
        program.write_text(text.replace(old, new, 1), encoding="utf-8")
        cl = _FOLDER / f"{row['part']}.cls"
        found = trunnion.verify(program, machine=row["machine"], cl=cl, tolerance=0.005)
        if row["check"] not in [check.key for check in found.checks if not check.passed]:
            yield f"{row['machine']}, {row['part']}: {row['what']}"


@pytest.mark.third
@pytest.mark.parametrize("machine", sorted({row["machine"] for row in _rows()}))
def test_each_fault_fails_its_check(machine: str, tmp_path: Path) -> None:
    rows = [row for row in _rows() if row["machine"] == machine]
    assert not [*_missed(rows, tmp_path / "part.nc")]
