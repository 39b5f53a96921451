"""The cure of a message, carried out, ends in what it promises, and each message has one."""

from pathlib import Path

import pytest

from tests.support.cures.cure import Cure, messages
from tests.support.cures.messages import all_cures, all_messages
from tests.support.cures.tables import TABLES

ROWS = [
    (f"{name}-{k}-{cure.code}-{cure.variant}", cure) for name, cures in TABLES.items() for k, cure in enumerate(cures)
]


@pytest.mark.parametrize("cure", [cure for _, cure in ROWS], ids=[name for name, _ in ROWS])
def test_a_cure_ends_in_what_it_promises(cure: Cure, tmp_path: Path) -> None:
    faults = list(cure.faults(tmp_path))
    assert not faults, "\n".join(faults)


def test_each_cure_is_carried_out() -> None:
    """A new message comes with its cure in a table."""
    tried = {message for cures in TABLES.values() for message in messages(cures)}
    assert not tried - all_messages(), "no such messages"
    assert not all_cures() - tried, "messages without a cure in tests/support/cures"
