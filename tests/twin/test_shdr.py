"""Texts of programs in lines of SHDR, taken apart as MTConnect's agent in C++ does it."""

import asyncio
import socket
import sys
import xml.etree.ElementTree as ET
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.locations import TESTS
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.mtconnect.adapter import MTConnectAdapter
from trunnion.twin.mtconnect.device import device_xml
from trunnion.twin.mtconnect.observations import UNAVAILABLE, shown_number
from trunnion.twin.mtconnect.shdr import shdr_line, shown_text

#: What ``isspace`` of C takes for one.
BLANKS = " \t\n\v\f\r"

#: Characters that mean something somewhere, and others.
TEXTS = st.lists(
    st.sampled_from([*'|"\\- \n\r\t\0*@:;a1äé\x85\u2028\ud800', "--multiline--", "X_actual"]), max_size=30
).map("".join)


def agent_fields(line: str) -> list[str]:
    """Fields of a line, by the rules of ``ShdrTokenizer`` of MTConnect's agent 2."""
    text, fields, at, copied = f"{line}\0", list[str](), 0, False
    while text[at] != "\0":
        while text[at] in BLANKS:
            at += 1
        start = first = at
        end = None
        if text[at] == '"':
            start = at = at + 1
            while text[at] != "\0":
                if text[at] == "\\":
                    text, copied = text[:at] + text[at + 1 :], True
                elif text[at] == "|":
                    break
                elif text[at] == '"':
                    behind = text[at + 1 :].lstrip(BLANKS)
                    if behind[0] not in "|\0":
                        break
                    end = at
                if text[at] != "\0":
                    at += 1
            if end is None and copied:
                at = start = first
                while text[at] not in "|\0":
                    at += 1
        else:
            while text[at] not in "|\0":
                at += 1
        fields.append(text[start : at if end is None else end].rstrip(BLANKS))
        if text[at] == "|" and text[at + 1] == "\0":
            fields.append("")
        if text[at] != "\0":
            at += 1
    return fields


@settings(max_examples=examples(400))
@given(st.lists(TEXTS, min_size=1, max_size=5))
@example(["note|X_actual|999|estop|TRIGGERED", "10"])
@example(['slash\\|X_actual|888 "quoted|X"', "10"])
@example(['"', "10"])
@example(["\\", "10"])
@example(['"a" b|', 'c"|'])
@example(["--multiline--1", "10"])
def test_an_agent_reads_each_text_and_nothing_else(texts: list[str]) -> None:
    pairs = [part for number, text in enumerate(texts) for part in (f"key{number}", text)]
    line = shdr_line("2026-01-01T00:00:00.000000Z", *pairs)
    assert line.endswith("\n")
    assert "\n" not in line[:-1]
    assert "\r" not in line
    assert "--multiline--" not in line
    line.encode()
    assert agent_fields(line[:-1]) == ["2026-01-01T00:00:00.000000Z", *map(shown_text, pairs)]


@pytest.mark.parametrize("text", ["N10 G1 X3 ; note", 'MSG("a")', r"a\b", "äé 部品"])
def test_texts_of_programs_stay_as_they_are(text: str) -> None:
    assert shown_text(text) == text


@pytest.mark.skipif(sys.platform == "win32", reason="files have no such names there")
def test_no_name_and_no_text_of_a_program_tells_values_of_its_own(tmp_path: Path) -> None:
    file = tmp_path / "a|X_actual|999|estop|TRIGGERED\nb.mpf"
    file.write_bytes((TESTS / "data" / "twin" / "pipe.mpf").read_bytes())
    program = twin_program(file, machine="yl569")
    listening = socket.create_server(("127.0.0.1", 0))
    adapter = MTConnectAdapter(program, listening)
    sent: list[str] = []
    adapter._send = sent.append  # type: ignore[method-assign, assignment]
    keys = {item.get("name") for item in ET.fromstring(device_xml(program)).iter() if item.get("name")}
    timed = program.timed
    seconds = np.linspace(0.0, timed.duration, 200)
    snapshots = program.at(seconds, np.full(len(seconds), -1))
    stamps = [datetime(2026, 1, 1, tzinfo=UTC)] * len(seconds)
    asyncio.run(adapter.show(snapshots, stamps, []))
    for event in timed.events:
        asyncio.run(adapter.message(str(event.event.value or ""), stamps[0]))
    listening.close()
    lines = [*adapter._everything().splitlines(), *"".join(sent).splitlines()]
    told = [agent_fields(line)[1:] for line in lines if not line.startswith("*")]
    ordinary = [fields for fields in told if not fields[0].endswith(("message", "system", "_travel"))]
    values = {pair for fields in ordinary for pair in zip(fields[::2], fields[1::2], strict=True)}
    assert {key for key, _ in values} <= keys
    assert ("X_actual", "999") not in values
    assert ("X_actual", "888") not in values
    assert ("estop", "TRIGGERED") not in values
    assert ("main_program", "a|X_actual|999|estop|TRIGGERED b.mpf") in values
    assert ("block", "N80 G1 X20 F500 ; note|X_actual|999|estop|TRIGGERED") in values


def test_numbers_have_no_more_digits_than_are_known() -> None:
    assert shown_number(500.00000000000006) == "500.0"
    assert shown_number(-0.0) == "0.0"
    assert shown_number(123.456789) == "123.456789"
    assert shown_number(float("nan")) == UNAVAILABLE
