"""Fanuc main programs that call their operations as macros: proven as those that call them as subprograms."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.support.fidia import END
from tests.support.posting import FOOT, HEAD, LEANING
from trunnion.cli import main
from trunnion.output.families.fanuc.writer import validate_settings

#: A three-axis operation and one with TCP.
TWO = HEAD + FOOT + LEANING.replace("OP1", "OP2") + END


def posted(folder: Path, *settings: str) -> list[str]:
    """The blocks of the main program, proven; its operations stand beside it."""
    cl, target = folder / "two.cls", folder / "two.nc"
    cl.write_text(TWO, encoding="utf-8")
    said = [word for setting in ("programs=operations", *settings) for word in ("--set", setting)]
    assert main(["post", str(cl), "--machine", "matsuura_mx330", "--output", str(target), *said]) == 0
    return [line.partition(" ")[2] for line in target.read_text("ascii").splitlines() if line.startswith("N")]


def verified(folder: Path, names: Sequence[str]) -> int:
    others = [word for name in names for word in ("--subprograms", str(folder / name))]
    check = ["verify", str(folder / "two.nc"), "--cl", str(folder / "two.cls"), "--machine", "matsuura_mx330"]
    return main([*check, *others])


def test_operations_are_called_as_macros_with_arguments(tmp_path: Path) -> None:
    blocks = posted(tmp_path, "call=G65 A1. B-2.5 K.5")
    assert [block for block in blocks if block.startswith(("G65", "M98"))] == [
        "G65 P1001 A1. B-2.5 K.5",
        "G65 P1002 A1. B-2.5 K.5",
    ]
    assert verified(tmp_path, ["O1001.nc", "O1002.nc"]) == 0
    assert verified(tmp_path, ["O1001.nc"]) == 1  # one that is not named is not looked for
    assert (tmp_path / "O1002.nc").read_text("ascii").endswith("M99\n%\n")


def test_without_arguments_only_the_word_changes(tmp_path: Path) -> None:
    (tmp_path / "macros").mkdir()
    called, subprograms = posted(tmp_path / "macros", "call=G65"), posted(tmp_path)
    assert [block.replace("G65", "M98") for block in called] == subprograms
    for name in ("O1001.nc", "O1002.nc"):
        assert (tmp_path / "macros" / name).read_bytes() == (tmp_path / name).read_bytes()


def test_a_shop_uses_the_arguments_in_its_own_templates(tmp_path: Path) -> None:
    """The operations of a definition that offers them to be left out."""
    machine = tmp_path / "shop.toml"
    start = "%\\nO{subprogram}\\nIF[#1NE1.]GOTO1\\nM99\\nN1 G21 G17 G40 G80 G90 G94"
    machine.write_text(
        'extends = "matsuura_mx330"\n[control]\nextends = "fanuc_31i"\n[control.block_numbers]\nnumbered = false\n'
        f'[control.templates]\nsubprogram_start = "{start}"\n',
        encoding="utf-8",
    )
    cl, target = tmp_path / "two.cls", tmp_path / "two.nc"
    cl.write_text(TWO, encoding="utf-8")

    def code(call: str) -> int:
        said = ["--set", "programs=operations", "--set", f"call={call}"]
        return main(["post", str(cl), "--machine", str(machine), "--output", str(target), *said])

    assert code("G65 A2.") == 0
    assert code("G65") == 0
    assert code("G65 A1.") == 1  # nothing is made, and the proof says so


@pytest.mark.parametrize(
    ("call", "good"),
    [
        ("M98", True),
        ("G65", True),
        ("G65 A1. B-2.5 X.5", True),
        ("M98 A1.", False),
        ("G65 A1", False),
        ("G65 A1. A2.", False),
        ("G65 P5.", False),
        ("G65 L2.", False),
        ("G65 N1.", False),
        ("G65  A1.", False),
        ("G65 A1.\nM30", False),
        ("G66", False),
    ],
)
def test_calls_that_no_control_takes_are_named(call: str, good: bool) -> None:
    assert (validate_settings({"call": call}) == []) == good
