"""Files that nobody means to import: each ends with a result or a problem, and none in silence."""

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.locations import ROOT
from trunnion.cli import main

FILES = ROOT / "tests" / "data" / "foreign"
KINDS = {".tcl": "mill.tcl", ".def": "mill.def", ".pui": "mill.pui", ".arc": "nck.arc", ".pst": "mill.pst"}

SWIVEL = b"""$TC_CARR4[1]=0
$TC_CARR7[1]=0
$TC_CARR8[1]=-1
$TC_CARR21[1]=B
$TC_CARR22[1]=C
$TC_CARR23[1]="P"
"""


def odd() -> Iterator[tuple[str, bytes]]:
    """Names with endings, and contents: whole files, changed ones, and what is none."""
    noise = random.Random(33)
    for ending, name in KINDS.items():
        good = (FILES / name).read_bytes()
        yield f"empty{ending}", b""
        yield f"blank{ending}", b"\n \n\t\n"
        yield f"nul{ending}", b"\0" + good
        yield f"bytes{ending}", bytes(noise.randrange(1, 256) for _ in range(4000))
        yield f"half{ending}", good[: len(good) // 2]
        yield f"utf16{ending}", good.decode().encode("utf-16")
        yield f"gbk{ending}", good + "# 叶轮 机床\n".encode("gbk")
        yield f"bom{ending}", b"\xef\xbb\xbf" + good
        yield f"cr{ending}", good.replace(b"\n", b"\r")
        yield f"twice{ending}", good + good
        yield f"commas{ending}", good.replace(b".", b",")
        yield f"long{ending}", good + b"x" * 300_000 + b"\n"
        yield f"lines{ending}", good + b"x = 1\n" * 20_000
        yield f"digits{ending}", good.replace(b"0", b"9" * 5000)
        yield f"negative{ending}", good.replace(b"=", b"=-").replace(b' "', b' "-')
        yield f"quotes{ending}", good.replace(b'"', b"")
        yield f"shuffled{ending}", b"\n".join(noise.sample(good.split(b"\n"), len(good.split(b"\n"))))
        yield f"nested{ending}", b"{" * 50_000 + good
        yield f"brackets{ending}", good.replace(b"[", b"[[").replace(b"(", b"((")
        yield f"names{ending}", good.replace(b"X", b"../../X").replace(b'"B', b'"\xc3\x9f')
        for k in range(6):
            damaged = bytearray(good)
            for _ in range(40):
                damaged[noise.randrange(len(damaged))] = noise.randrange(1, 256)
            yield f"damaged{k}{ending}", bytes(damaged)
    for value in (
        b"1e999",
        b"-inf",
        b"NAN",
        b"1,5",
        b"AX4",
        b"",
        b'"',
        b"9" * 5000,
        "٣".encode(),
        b"_1",
        b"0x10",
        b"TRUE",
    ):
        for line in (b"$TC_CARR4[1]=0", b"$TC_CARR8[1]=-1", b"$TC_CARR21[1]=B", b'$TC_CARR23[1]="P"'):
            yield "swivel.arc", SWIVEL.replace(line, line.partition(b"=")[0] + b"=" + value)
    for line in (
        b"$MC_TRAFO_TYPE_1=72\n$MC_TRAFO5_TCARR_NO_1=1\n$MC_TRAFO_AXES_IN_1[3]=4\n$MC_TRAFO_AXES_IN_1[4]=4\n",
        b"$MC_AXCONF_MACHAX_USED[0]=1\n$MC_AXCONF_MACHAX_USED[1]=1\n$MN_AXCONF_MACHAX_NAME_TAB[0]=B\n",
        b"$MN_AXCONF_MACHAX_NAME_TAB[0]=B\n$MN_AXCONF_MACHAX_NAME_TAB[1]=B\n$TC_CARR21[1]=AX1\n$TC_CARR22[1]=AX2\n",
        b"$TC_CARR23[9]=P\n$TC_CARR23[-1]=T\n$TC_CARR23[]=M\n$TC_CARR99[1]=1\n$TC_CARR0[1]=1\n",
        b"$MN_AXCONF_MACHAX_NAME_TAB[0]=X\n$MC_AXCONF_MACHAX_USED[0]=1\n$TC_CARR21[1]=X\n$TC_CARR22[1]=Y\n",
    ):
        yield "circle.arc", line + SWIVEL


ALL = list(odd())


def test_there_are_enough_of_them() -> None:
    assert len(ALL) >= 100


@pytest.mark.parametrize(("name", "content"), ALL, ids=[f"{k}-{name}" for k, (name, _) in enumerate(ALL)])
def test_an_odd_file_ends_with_a_result_or_a_problem(
    name: str, content: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(content)
    assert main(["import", name, "--machine", "yl569"]) in (0, 1, 2)
    told = capsys.readouterr()
    assert told.out or "[DEF" in told.err
    result = main(["import", name, "--like", "yl569", "--output", "ours"])
    told = capsys.readouterr()
    assert result in (0, 2)
    assert told.out if result == 0 else "[DEF" in told.err
    if result == 0:  # what is written can be read, or says at which of its lines it cannot
        assert main(["check", "ours.toml"]) == 0, capsys.readouterr().err
    assert {file.name for file in tmp_path.iterdir()} <= {name, "ours.toml", "trunnion-machine.schema.json"}


@pytest.mark.parametrize("name", ["a b.pst", "-x.pst", "häß.pst", "叶轮.pst", "x'y.pst", "x\ny.pst", "*.pst"])
def test_names_of_files_are_told_as_they_are(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        (tmp_path / name).write_bytes((FILES / "mill.pst").read_bytes())
    except OSError:
        pytest.skip("this system has no such names")
    assert main(["import", f"./{name}", "--like", "yl569", "--output", "ours"]) == 0
    assert main(["check", "ours.toml"]) == 0, capsys.readouterr().err
