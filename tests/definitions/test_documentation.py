"""The reference of definitions and the loader say the same."""

import re
from importlib.resources.abc import Traversable
from pathlib import Path

import pytest

from tests.support.locations import DOCS, TESTS
from trunnion.cli import main
from trunnion.controls import load_control, loading
from trunnion.controls.vocabulary import COMMON_TEMPLATE_FIELDS
from trunnion.definitions import Table, load_table, resolve_extends
from trunnion.families import FAMILIES, load_writer
from trunnion.machines import Machine, load_machine
from trunnion.machines.loading import machine_library, read_machine

DOCUMENT = (DOCS / "definitions.md").read_text(encoding="utf-8")

#: Keys that merging takes out before the loader sees them.
MERGED = {"extends", "axis.remove", "body.remove", "control.extends"}

#: Tables of a control whose keys are names and not keys of the schema.
NAMES = {
    "codes", "coolant", "in_force", "statements", "settings", "setting_rules", "setting_meanings", "tool_types",
    "phases", "templates",
}  # fmt: skip


def control_keys(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Every key of a control that the loader reads for any shipped one."""
    read: list[Table] = []

    def resolve_and_keep(own: Table, library: Traversable) -> Table:
        read.append(resolve_extends(own, library))
        return read[-1]

    monkeypatch.setattr("trunnion.controls.loading.resolve_extends", resolve_and_keep)
    for name in loading.shipped_controls():
        load_control(load_table(name, loading.control_library()))
    keys: set[str] = set().union(*(table.all_read_keys() for table in read))
    return {key for key in keys if "." not in key or key.split(".")[0] not in NAMES}


def test_every_key_that_the_loader_knows_is_in_the_reference_and_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    table = load_table(TESTS / "data" / "definitions" / "machine.toml", machine_library())  # it has all there is
    read_machine(table, "complete")
    keys = {key for key in table.all_read_keys() if not key.startswith(("cl.words.", "spindle.gear."))}
    rows = re.findall(r"^\| (`[^|]*`) \|", DOCUMENT, re.MULTILINE)
    described = {key for row in rows for key in re.findall(r"`([a-z0-9_.]+)`", row)}
    effects = set(re.findall(r"^\| `([a-z ]+)`", DOCUMENT[DOCUMENT.index("| effect |") :], re.MULTILINE))
    assert described - effects == (keys | MERGED | {f"control.{key}" for key in control_keys(monkeypatch)})


def test_every_template_field_is_in_the_page_and_no_other() -> None:
    page = (DOCS / "adding-a-control.md").read_text(encoding="utf-8")
    section = page.partition("## Template fields")[2].partition("A line that names an absent value")[0]
    rows = re.findall(r"^\| (`.*?`) \|", section, re.MULTILINE)
    fields = COMMON_TEMPLATE_FIELDS.union(*(load_writer(family).TEMPLATE_FIELDS for family in FAMILIES))
    assert {name for row in rows for name in re.findall(r"`(\w+)`", row)} == fields


def test_the_control_of_the_page_is_one_that_a_machine_can_have(tmp_path: Path) -> None:
    page = (DOCS / "adding-a-control.md").read_text(encoding="utf-8")
    text = page.partition("## A control in a file of its own")[2].partition("```toml\n")[2].partition("```")[0]
    (tmp_path / "controls").mkdir()
    (tmp_path / "controls" / "ours.toml").write_text(text, encoding="utf-8")
    own = 'extends = "yl569"\nname = "Ours"\n[control]\nextends = "controls/ours"\n'
    (tmp_path / "machine.toml").write_text(own, encoding="utf-8")
    control = load_control(load_machine(tmp_path / "machine.toml").control)
    assert (control.name, control.settings["edge"]) == ("Our 840D sl, hall 2", "2")
    assert main(["check", str(tmp_path / "controls" / "ours.toml")]) == 0


def examples(folder: Path) -> list[Machine]:
    """Load every TOML block of the document."""
    machines = []
    for n, block in enumerate(re.findall(r"^ *```toml\n(.*?)^ *```", DOCUMENT, re.MULTILINE | re.DOTALL)):
        path = folder / f"example{n}.toml"
        path.write_text(block, encoding="utf-8")
        machines.append(load_machine(path))
    return machines


def test_every_example_of_the_reference_is_a_machine(tmp_path: Path) -> None:
    changed, bodies, words, declares, worded, kept, whole = examples(tmp_path)
    assert [body.name for body in bodies.bodies[-2:]] == ["head", "vise"]
    assert words.cl_words["SHOPCL/1"] == "COOLNT/AIR"
    assert "G234" in worded.control.table("reading").table("words")
    assert kept.control.table("reading").table("variables")
    assert "M202" in declares.control.table("known")
    assert (changed.axis("B").low, changed.workpiece_zero) == (-5.0, (0.0, 0.0, 62.5))
    assert whole.names == ("C", "A", "X", "Y", "Z")
