"""Fidia programs: the one that ran, planes of the rotary position, circles, TCP, cycles; written, read back, proven."""

import re

import pytest

from tests.paths import FIDIA, FIDIA_HEAD
from tests.verify.proven import unproven
from trunnion.cli import main

#: The program that ran writes the blank behind a block number or leaves it out at whim.
NUMBER = re.compile(rb"^(N\d+) ", re.MULTILINE)


def test_the_published_program_comes_out_and_is_proven(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    head = [f"--set={key}={value}" for key, value in FIDIA_HEAD.items()]
    code = main(["post", str(FIDIA / "radial_holes.cls"), "--machine", "hs664rt", "--output", "-", *head])
    out, err = capfdbinary.readouterr()
    assert (code, unproven(err.decode())) == (0, "")
    expected = (FIDIA / "radial_holes.expected.txt").read_bytes().replace(b"\r\n", b"\n")
    assert NUMBER.sub(rb"\1", out).strip() == NUMBER.sub(rb"\1", expected).strip()


def test_the_published_program_is_proven_as_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    program, cl = FIDIA / "radial_holes.expected.txt", FIDIA / "radial_holes.cls"
    assert main(["verify", str(program), "--cl", str(cl), "--machine", "hs664rt"]) == 0, capsys.readouterr().out
