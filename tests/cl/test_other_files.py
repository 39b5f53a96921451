"""Files that are no CL data are named for what they are, and the cure says what to output."""

from pathlib import Path

import pytest

from trunnion.cl import read_cl
from trunnion.errors import InputError

_STL = b"binary".ljust(80) + (1).to_bytes(4, "little") + bytes(50)


@pytest.mark.parametrize(
    ("name", "content", "what"),
    [
        ("a.cls", b"ISO-10303-21;\nHEADER;\n", "STEP data"),
        ("a.cls", b"  0\r\nSECTION\r\n  2\r\nHEADER\r\n", "DXF data"),
        ("a.cls", b"999\nby hand\n0\nSECTION\n", "DXF data"),
        ("a.cls", b"AutoCAD Binary DXF\r\n\x1a\x00", "DXF data"),
        ("a.cls", b"solid part\n facet normal 0 0 1\n", "STL data"),
        ("a.cls", _STL, "STL data"),
        ("a.stl", b"\x00\x01", "STL data"),
        ("a.cls", b"part".ljust(72) + b"S      1\n", "IGES data"),
        ("a.cls", b"%PDF-1.7\n", "PDF data"),
        ("a.cut", b"CL\x00\x01", "binary data of PowerMill (.cut)"),
        ("a.mcam", b"\x00\x01", "binary data of Mastercam (.mcam)"),
    ],
)
def test_a_file_of_another_kind_is_named(tmp_path: Path, name: str, content: bytes, what: str) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_cl(file)
    (problem,) = caught.value.problems
    assert (problem.code, what in problem.what) == ("CL115", True), problem.what
    assert "No reader for your CAM?" in problem.cure


@pytest.mark.parametrize("content", [b"0\n1\n", b"solid ground\nGOTO/1,2,3\n", b"GOTO/1,2,\x003\n"])
def test_what_only_looks_like_one_keeps_its_own_message(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "a.cls"
    file.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_cl(file)
    assert "CL115" not in {problem.code for problem in caught.value.problems}
