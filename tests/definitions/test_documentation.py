"""The reference of definitions and the loader say the same."""

import re
from pathlib import Path

from tests.support.locations import DOCS
from trunnion.definitions import load_table
from trunnion.machines import Machine, load_machine
from trunnion.machines.loading import machine_library, read_machine

DOCUMENT = (DOCS / "definitions.md").read_text(encoding="utf-8")

#: Keys that merging takes out before the loader sees them.
MERGED = {"extends", "axis.remove"}


def test_every_key_that_the_loader_knows_is_in_the_reference_and_no_other() -> None:
    table = load_table("yl569", machine_library())
    read_machine(table, "yl569")
    described = set(re.findall(r"^\| `([a-z0-9_.]+)` \|", DOCUMENT, re.MULTILINE))
    assert described == table.all_read_keys() | MERGED


def examples(folder: Path) -> list[Machine]:
    """Load every TOML block of the document."""
    machines = []
    for n, block in enumerate(re.findall(r"^ *```toml\n(.*?)^ *```", DOCUMENT, re.MULTILINE | re.DOTALL)):
        path = folder / f"example{n}.toml"
        path.write_text(block, encoding="utf-8")
        machines.append(load_machine(path))
    return machines


def test_every_example_of_the_reference_is_a_machine(tmp_path: Path) -> None:
    changed, words, declares, worded, whole = examples(tmp_path)
    assert words.cl_words["SHOPCL/1"] == "COOLNT/AIR"
    assert "G234" in worded.control.table("reading").table("words")
    assert "M202" in declares.control.table("known")
    assert (changed.axis("B").low, changed.workpiece_zero) == (-5.0, (0.0, 0.0, 62.5))
    assert whole.names == ("C", "A", "X", "Y", "Z")
