"""Words that change how the machine runs, or make it wait, are named where neither CL file nor template has them."""

from pathlib import Path

import pytest

import trunnion
from trunnion.verification.results import Check

MACHINES = {
    "Sinumerik": "yl569", "Heidenhain": "dmu65", "Fanuc": "matsuura_mx330", "Haas": "haas_umc750",
    "LinuxCNC": "xyzac_trt", "Fidia": "hs664rt",
}  # fmt: skip


def cl_file(folder: Path, insert: str = "") -> Path:
    path = folder / "face.cls"
    path.write_text(
        "PARTNO/FACE\nUNITS/MM\nTOOL PATH/FACE,TOOL,T8\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\n"
        "MSYS/0,0,0,1,0,0,0,1,0\nPAINT/PATH\nLOAD/TOOL,8,ADJUST,8\nSPINDL/RPM,600,CLW\nRAPID\nGOTO/16,2,40,0,0,1\n"
        f"{insert}FEDRAT/MMPM,300\nGOTO/16,2,0\nGOTO/-7.25,13.5,0\nRAPID\nGOTO/-7.25,13.5,40\nSPINDL/OFF\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    return path


def words_of(family: str, cl: Path, word: str, *, machine: Path | None = None) -> Check:
    """The check of a program with a word of its own before its longest cut."""
    path = cl.with_suffix(".h" if family == "Heidenhain" else ".nc")
    used = machine or MACHINES[family]
    trunnion.post(cl, machine=used, output=path, settings={"numbers": "off"} if family != "Heidenhain" else {})
    lines = path.read_text(encoding="utf-8").splitlines()
    at = next(k for k, line in enumerate(lines) if "X-7.25" in line and "X" in line)
    if word:
        lines.insert(at, word)
    if family == "Heidenhain":
        lines = [
            f"{k} {line.partition(' ')[2]}" if k != at or not word else f"{k} {word}" for k, line in enumerate(lines)
        ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    found = trunnion.verify(path, machine=used, cl=cl)
    return next(check for check in found.checks if check.key == "words")


WORDS = [
    ("Sinumerik", "ACC[X]=50", "ACC[X]=50"),
    ("Sinumerik", "OVRA[C]=20", "OVRA[C]=20"),
    ("Sinumerik", "JERKLIM[X]=75", "JERKLIM[X]=75"),
    ("Sinumerik", "SETAL(65000)", "SETAL(65000)"),
    ("Sinumerik", "WAITM(1,1,2)", "WAITM"),
    ("LinuxCNC", "M49", "M49"),
    ("LinuxCNC", "M50 P0", "M50 P0"),
    ("LinuxCNC", "M51 P0", "M51 P0"),
    ("LinuxCNC", "M53 P0", "M53 P0"),
    ("LinuxCNC", "M52", "M52"),
    ("LinuxCNC", "M64 P1", "M64 P1"),
    ("LinuxCNC", "M68 E1 Q5", "M68 E1 Q5"),
    ("LinuxCNC", "M66 P1 L3 Q2", "M66"),
    ("LinuxCNC", "M60", "M60"),
    ("Haas", "M13", "M13"),
    ("Haas", "M12", "M12"),
    ("Haas", "M10", "M10"),
    ("Haas", "M95 (00:01)", "M95"),
    ("Fanuc", "G63", "G63"),
    ("Fanuc", "#3006=1", "#3006"),
    ("Heidenhain", "L M101", "M101"),
    ("Heidenhain", "L M118 X1", "M118 X1"),
    ("Heidenhain", "FN 14: ERROR=1000", "FN 14"),
    ("Heidenhain", "FN 19: PLC=+1 / +2", "FN 19"),
    ("Heidenhain", "FN 29: PLC=+1", "FN 29"),
]


@pytest.mark.parametrize(("family", "word", "told"), WORDS)
def test_words_that_nobody_asked_for_are_named(family: str, word: str, told: str, tmp_path: Path) -> None:
    check = words_of(family, cl_file(tmp_path), word)
    assert check.passed
    assert [each.what for each in check.missing if "nobody asked for" in each.what and f"for {told} (" in each.what]


@pytest.mark.parametrize("family", MACHINES)
def test_what_is_posted_is_asked_for(family: str, tmp_path: Path) -> None:
    assert not words_of(family, cl_file(tmp_path), "").missing


@pytest.mark.parametrize(
    ("family", "word"),
    [
        ("Sinumerik", "ACC[X]=100"),
        ("LinuxCNC", "M50 P1"),
        ("LinuxCNC", "M48"),
        ("LinuxCNC", "M52 P0"),
        ("Heidenhain", "L M102"),
    ],
)
def test_words_that_change_nothing_are_not_named(family: str, word: str, tmp_path: Path) -> None:
    assert not words_of(family, cl_file(tmp_path), word).missing


def test_a_template_asks_for_its_words(tmp_path: Path) -> None:
    machine = tmp_path / "own.toml"
    machine.write_text(
        'extends = "haas_umc750"\n[control.templates]\nafter_approach = "M13"\n',
        encoding="utf-8",
    )
    assert not words_of("Haas", cl_file(tmp_path), "M13", machine=machine).missing


@pytest.mark.parametrize(("family", "word"), [("LinuxCNC", "M64 P1"), ("Haas", "M13")])
def test_an_insert_asks_for_its_words(family: str, word: str, tmp_path: Path) -> None:
    assert not words_of(family, cl_file(tmp_path, f"INSERT/{word}\n"), "").missing
