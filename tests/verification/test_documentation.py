"""The page about the checks agrees with the checks."""

import re

from tests.support import mutations
from tests.support.locations import DOCS
from tests.support.verifying import CL_FOOT, CL_HEAD, FOOT, HEAD, Verifier
from trunnion.verification.checks.table import CHECKS, Compared

PAGE = (DOCS / "checks.md").read_text(encoding="utf-8")


def test_every_check_has_a_section_and_every_name_in_the_table_is_a_check(verified: Verifier) -> None:
    program = HEAD + "G0 X0 Y0 Z50\n" + FOOT
    keys = [check.key for check in verified(program, CL_HEAD + CL_FOOT).checks]
    assert {check.key for check in verified(program).checks} <= set(keys)
    sections = re.findall(r"^## (.*)$", PAGE, re.MULTILINE)
    assert [key for key in (*keys, "reach", "basis") if key not in sections] == []
    table = "".join(line for line in PAGE.splitlines() if line.startswith("| ["))
    linked = re.findall(r"\[([a-z]+)\]\(#\1\)", table)
    assert sorted(linked) == sorted([*keys, "reach", "basis"]), "reach judges feeds that were asked to be the fastest"


def test_the_table_has_the_checks_in_the_order_of_their_keys(verified: Verifier) -> None:
    program = HEAD + "G0 X0 Y0 Z50\n" + FOOT
    keys = [entry.key for entry in CHECKS if entry.key not in ("normal", "reach", "basis")]
    compared = verified(program, CL_HEAD + CL_FOOT).checks
    assert [check.key for check in compared] == keys
    alone = verified(program).checks
    assert [check.key for check in alone] == keys
    unmade = {entry.key for entry in CHECKS if issubclass(entry.needs, Compared)} - {"normal", "reach"}
    assert {check.key for check in alone if "no CL file given" in check.told} == unmade
    assert [check.title for check in alone] == [check.title for check in compared]


def test_every_reason_why_a_fault_is_not_caught_is_in_the_page() -> None:
    plain = PAGE.replace("`", "")
    for what, why in mutations.REASONS.items():
        assert f"| {what} |" in plain
        assert why in PAGE
