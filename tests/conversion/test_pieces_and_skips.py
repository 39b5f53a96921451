"""Pieces of arcs, turns of endless axes, blocks behind skipped ones, and programs without an end, converted."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.recall_proof.parts import cl_text
from tests.support.recall_proof.sound_edits import sound
from trunnion.jobs.convert.result import ConvertResult

FAMILIES = {
    "yl569": "Sinumerik", "dmu65": "Heidenhain", "matsuura_mx330": "Fanuc", "haas_umc750": "Haas",
    "xyzac_trt": "LinuxCNC", "hs664rt": "Fidia",
}  # fmt: skip


def _posted(machine: str, part: str, folder: Path) -> str:
    cl, program = folder / f"{part}.cls", folder / f"{part}.nc"
    cl.write_text(cl_text(part), encoding="utf-8")
    trunnion.post(cl, machine=machine, output=program)
    return program.read_text(encoding="utf-8")


def _converted(machine: str, text: str, folder: Path) -> ConvertResult:
    program = folder / ("other.h" if machine == "dmu65" else "other.nc")
    program.write_text(text, encoding="utf-8")
    return trunnion.convert(program, machine=machine, to_cl=True)


@pytest.mark.third
@pytest.mark.parametrize("machine", FAMILIES)
def test_the_same_arcs_and_turns_in_other_words_become_the_same(machine: str, tmp_path: Path) -> None:
    kinds = ("an arc in two", "a full circle as two halves", "a turn back", "a turn further")
    for part in ("pocket", "rings", "helix"):
        text = _posted(machine, part, tmp_path)
        known = _converted(machine, text, tmp_path)
        wanted = [operation.moves.tip.round(4).tolist() for operation in known.toolpath.operations]
        for edit in sound(text, FAMILIES[machine]):
            if edit.kind in kinds:
                found = _converted(machine, edit.text, tmp_path)
                assert [operation.moves.tip.round(4).tolist() for operation in found.toolpath.operations] == wanted
                assert [each.code for each in found.problems] == [each.code for each in known.problems], edit


@pytest.mark.third
@pytest.mark.parametrize("machine", FAMILIES)
def test_a_block_that_hangs_on_a_skipped_one_is_warned_of(machine: str, tmp_path: Path) -> None:
    lines = _posted(machine, "pocket", tmp_path).splitlines()
    at = next(k for k, line in enumerate(lines) if re.search(r"X\+?20\.? F500", line))
    found = _converted(machine, "\n".join([*lines[:at], f"/{lines[at]}", *lines[at + 1 :], ""]), tmp_path)
    assert [each.line for each in found.problems if each.code == "CNV155"] == [at + 2]


@pytest.mark.parametrize("machine", [machine for machine in FAMILIES if machine != "dmu65"])
def test_a_program_without_an_end_is_warned_of(machine: str, tmp_path: Path) -> None:
    lines = _posted(machine, "pocket", tmp_path).splitlines()
    kept = [line for line in lines if not re.search(r"\bM(30|0?2)\b", line)]
    assert len(kept) < len(lines)
    found = _converted(machine, "\n".join([*kept, ""]), tmp_path)
    assert "without M30 or M2" in " ".join(map(str, found.problems))


@pytest.mark.parametrize("machine", [machine for machine in FAMILIES if machine != "dmu65"])
def test_a_skipped_stop_between_operations_skips_nothing_else(machine: str, tmp_path: Path) -> None:
    lines = _posted(machine, "two_tools", tmp_path).splitlines()
    change = max(k for k, line in enumerate(lines) if re.search(r"\bM6\b|M306", line))
    begin = max(k for k in range(change) if re.search(r"\bM5\b", lines[k]))
    for stop in ("M1", "G4 P1000" if machine in ("matsuura_mx330", "haas_umc750") else "M0"):
        text = _converted(machine, "\n".join([*lines[: begin + 1], f"/{stop}", *lines[begin + 1 :], ""]), tmp_path).text
        signs = re.findall(r"OPSKIP/\w+|OPSTOP|STOP|DELAY", text or "")
        assert signs in (["OPSKIP/ON", found, "OPSKIP/OFF"] for found in ("OPSTOP", "STOP", "DELAY")), signs
