"""The cure of a message, carried out, ends in what it promises; cures that nobody has carried out yet are listed."""

from pathlib import Path

import pytest

from tests.support.cures import ledger
from tests.support.cures.cure import Cure, messages
from tests.support.cures.tables import TABLES

ROWS = [
    (f"{name}-{k}-{cure.code}-{cure.variant}", cure) for name, cures in TABLES.items() for k, cure in enumerate(cures)
]


@pytest.mark.parametrize("cure", [cure for _, cure in ROWS], ids=[name for name, _ in ROWS])
def test_a_cure_ends_in_what_it_promises(cure: Cure, tmp_path: Path) -> None:
    faults = list(cure.faults(tmp_path))
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
