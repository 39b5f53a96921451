"""The cure of a message, carried out, ends in what it promises; cures that nobody has carried out yet are listed."""

from pathlib import Path

import pytest

from tests.support.cures import ledger
from tests.support.cures.cure import messages
from tests.support.cures.tables import TABLES


@pytest.mark.parametrize("name", sorted(TABLES))
def test_cures_end_in_what_they_promise(name: str, tmp_path: Path) -> None:
    faults = []
    for k, cure in enumerate(TABLES[name]):
        folder = tmp_path / str(k)
        folder.mkdir()
        faults += list(cure.faults(folder))
    assert not faults, "\n".join(faults)


def test_each_cure_is_carried_out_or_listed() -> None:
    """A new message comes with its cure in a table; the list of the others only gets shorter."""
    tried = {message for cures in TABLES.values() for message in messages(cures)}
    known = ledger.all_cures()
    assert not tried - known, "no such messages"
    left = ledger.read()
    assert sorted(left) == left
    assert not known - tried - set(left), "new messages without a cure in tests/support/cures"
    assert not set(left) - (known - tried), "python -m tests.support.cures.ledger takes them out"
