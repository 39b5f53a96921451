"""CL files in archives and streams: read as they are, or refused with a cure; nothing is unpacked to disk."""

import bz2
import gzip
import io
import random
import zipfile
from pathlib import Path

import pytest

import trunnion
from tests.support.cl_dialects import WRITERS, Step
from trunnion.cl import read_cl, read_cl_files, sources
from trunnion.cl.surface_normals import with_normals
from trunnion.cli import main

PATH = [
    Step("TOOL", (5.0, 10.0, 5.0)),
    Step("SPINDLE", (900.0,), "CLW"),
    Step("RAPID", point=(10.0, 0.0, 50.0)),
    Step("FEED", (300.0,)),
    Step("GOTO", point=(10.0, 0.0, 5.0)),
]
CLSF = WRITERS["clsf"](False).write(PATH)
NCL = WRITERS["ncl"](True).write(PATH)


def zipped(files: dict[str, str | bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return out.getvalue()


def problem_of(file: Path) -> str:
    with pytest.raises(trunnion.InputError) as caught:
        read_cl_files(file)
    return str(caught.value)


def in_two_streams(text: bytes) -> bytes:
    return bz2.compress(text[:100]) + bz2.compress(text[100:])


@pytest.mark.parametrize(
    "pack",
    [gzip.compress, bz2.compress, in_two_streams, lambda text: zipped({"a.txt": text})],
    ids=["gz", "bz2", "bz2 in two streams", "zip"],
)
def test_a_packed_file_is_read_like_the_file(tmp_path: Path, pack: object) -> None:
    plain, packed = tmp_path / "plain", tmp_path / "packed.cls"  # the name says nothing
    plain.write_text(CLSF)
    packed.write_bytes(pack(CLSF.encode()))  # type: ignore[operator]
    one, other = read_cl(plain), read_cl(packed)
    assert one.operations[0].moves.tip.tolist() == other.operations[0].moves.tip.tolist()
    assert (one.dialect, one.recognized) == (other.dialect, other.recognized)
    assert trunnion.read_cl(io.BytesIO(packed.read_bytes())).operations[0].name == "OP5"
    assert [path.name for path in tmp_path.iterdir()] in (["plain", "packed.cls"], ["packed.cls", "plain"])


def test_an_archive_is_one_job_in_the_order_of_its_names(tmp_path: Path) -> None:
    names: dict[str, str | bytes] = {
        "10.cls": CLSF,
        "2/side.ncl": NCL,
        "notes.txt": "CALL ME",
        "__MACOSX/2/._side.ncl": b"\0",
        "1.cls": CLSF,
    }
    file = tmp_path / "jobs.zip"
    file.write_bytes(zipped(names))
    found = read_cl_files(file)
    assert [Path(toolpath.file).relative_to(file).as_posix() for toolpath in found] == ["1.cls", "2/side.ncl", "10.cls"]
    assert [toolpath.dialect for toolpath in found] == ["clsf", "ncl", "clsf"]
    assert [toolpath.unit for toolpath in found] == [1.0, 25.4, 1.0]
    left_out = [remark.file.removeprefix(f"{file}/") for remark in found[0].remarks if "left out" in remark.what]
    assert left_out == ["__MACOSX/2/._side.ncl", "notes.txt"]
    for damaged, what in ((b"", "the file is empty"), (bytes(100), "NUL byte")):
        file.write_bytes(zipped(names | {"3.cls": damaged}))
        with pytest.raises(trunnion.InputError, match=what):
            read_cl_files(file)
    file.write_bytes(zipped(names))
    with pytest.raises(trunnion.InputError, match="one of 3 CL files in an archive"):
        trunnion.read_cl(file)
    assert len(trunnion.describe_cl(file).files) == 3


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (gzip.compress(CLSF.encode())[:-9], "cannot be unpacked"),
        (gzip.compress(CLSF.encode())[:40] + b"xxxx" + gzip.compress(CLSF.encode())[44:], "cannot be unpacked"),
        (bz2.compress(CLSF.encode())[:-5], "cannot be unpacked"),
        (bz2.compress(CLSF.encode()) + b"BZi" + in_two_streams(CLSF.encode())[3:], "cannot be unpacked"),
        (bz2.compress(CLSF.encode()) + b"GOTO/1,2,3", "cannot be unpacked"),
        (in_two_streams(CLSF.encode())[:-5], "cannot be unpacked"),
        (zipped({"a.cls": CLSF})[:-30], "cannot be unpacked"),
        (zipped({"a.cls": CLSF}, zipfile.ZIP_STORED).replace(b"GOTO", b"GOTP", 1), "Bad CRC-32"),
        (zipped({"a.cls": CLSF}, zipfile.ZIP_LZMA), "packed in a way that is not read"),
        (zipped({"a.txt": "hello"}), "has no CL file in it"),
        (zipped({}), "is empty"),
        (zipped({"a.zip": zipped({"a.cls": CLSF})}), "an archive in an archive"),
        (gzip.compress(gzip.compress(CLSF.encode())), "an archive in an archive"),
        (b"7z\xbc\xaf\x27\x1c" + bytes(50), "is a 7-Zip archive"),
        (gzip.compress(bytes(257) + b"ustar" + bytes(500)), "is a tar archive"),
        (gzip.compress(b""), "the file is empty"),
        (zipped({"a.cls": CLSF.encode("utf-16")}), "UTF-16"),
    ],
    ids=[
        "gz cut", "gz damaged", "bz2 cut", "bz2 damaged", "bz2 text", "bz2 2 cut", "zip cut", "zip damaged", "lzma",
        "no cl", "empty", "zip in zip", "gz in gz", "7z", "tar", "gz of nothing", "utf-16",
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_with_its_name(tmp_path: Path, content: bytes, said: str) -> None:
    file = tmp_path / "part.cls"
    file.write_bytes(content)
    text = problem_of(file)
    assert said in text
    assert text.startswith(str(file))
    assert "; " in text


def test_no_damage_ends_in_a_traceback(tmp_path: Path) -> None:
    seeds = [
        gzip.compress(CLSF.encode()),
        bz2.compress(CLSF.encode()),
        zipped({"1.cls": CLSF, "2.ncl": NCL, "x.txt": "hi"}),
        zipped({"1.cls": CLSF}, zipfile.ZIP_BZIP2),
    ]
    rng, file, refused = random.Random(1), tmp_path / "part", 0
    for k in range(200):
        content = bytearray(seeds[k % len(seeds)])
        for _ in range(rng.choice((1, 1, 2, 5, 20))):
            at, what = rng.randrange(len(content)), rng.random()
            if what < 0.7:
                content[at] = rng.randrange(256)
            elif what < 0.9:
                del content[at : at + rng.randrange(1, 30)]
            else:
                content[at:at] = rng.randbytes(5)
        file.write_bytes(content)
        try:
            read_cl_files(file)
        except trunnion.InputError:
            refused += 1
    assert refused > 100


def test_names_in_archives_are_read_and_cannot_act_on_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "part.zip"
    gbk = zipped({"a____.cls": CLSF}).replace(b"a____.cls", b"a" + "中文".encode("gbk") + b".cls")
    file.write_bytes(gbk)
    assert read_cl(file).file == f"{file}/a中文.cls"
    file.write_bytes(zipped({"a\nb\x1b[31m\u202e.cls": CLSF.replace("GOTO", "GOTP", 1)}))
    assert main(["info", str(file)]) == 0
    assert main(["post", str(file), "--machine", "yl569", "--output", "-"]) == 2
    told = "".join(capsys.readouterr())
    assert f"{file}/a b\ufffd[31m\ufffd.cls:" in told
    assert "\x1b" not in told


def test_names_in_cl_files_cannot_act_on_a_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, plot = tmp_path / "part.cls", tmp_path / "part.html"
    evil = "A\x9b31m\u202eB"
    file.write_text(CLSF.replace("TOOL PATH/OP5", f"TOOL PATH/{evil}"), encoding="utf-8")
    assert read_cl(file).operations[0].name == evil
    assert main(["info", str(file), "--plot", str(plot)]) == 0
    assert main(["info", str(file), "--json"]) == 0
    told = "".join(capsys.readouterr()) + plot.read_text(encoding="utf-8")
    assert "A\ufffd31m\ufffdB" in told
    assert "\x9b" not in told
    assert "\u202e" not in told


def test_a_password_and_two_files_of_one_name_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "part.zip"
    content = zipped({"a.cls": CLSF})
    file.write_bytes(content.replace(b"PK\x01\x02\x14\x03\x14\x00\x00\x00", b"PK\x01\x02\x14\x03\x14\x00\x01\x00"))
    assert "has a password" in problem_of(file)
    file.write_bytes(zipped({"a.cls": CLSF, "b.cls": CLSF}).replace(b"b.cls", b"a.cls"))
    assert "has two files named a.cls" in problem_of(file)


def test_bombs_are_refused_before_they_fill_the_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sources, "_FREE_BYTES", 1 << 18)
    bomb = (CLSF + "GOTO/0,0,0\n" * 100_000).encode()
    file = tmp_path / "part.gz"
    for content in (gzip.compress(bomb), bz2.compress(bomb), zipped({"a.cls": bomb})):
        file.write_bytes(content)
        assert "becomes more than 200 times as long" in problem_of(file)
    monkeypatch.setattr(sources, "MAX_BYTES", 1000)
    file.write_bytes(gzip.compress((CLSF * 20).encode()))
    assert "is longer than" in problem_of(file)
    with pytest.raises(trunnion.InputError, match="is longer than"):
        read_cl_files(io.BytesIO(CLSF.encode() * 20))


def test_a_long_stream_is_kept_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sources, "_IN_MEMORY", 100)
    monkeypatch.setattr(sources, "_PIECE", 30)
    (found,) = sources.cl_sources(io.BytesIO(CLSF.encode()))
    for _ in range(2):
        with found.open() as text:
            assert text.read() == CLSF.encode()


def test_contact_points_of_a_packed_file_are_found(tmp_path: Path) -> None:
    text = CLSF.replace("TLDATA", "$$ centerline and contact point\nTLDATA")
    lines = [f"{line} $$ 1.0,1.0,0.0" if line.startswith("GOTO") else line for line in text.splitlines()]
    file = tmp_path / "part.zip"
    file.write_bytes(zipped({"a.cls": "\n".join(lines) + "\n"}))
    (toolpath,) = read_cl_files(file)
    normal = with_normals(toolpath).operations[0].moves.normal
    assert normal is not None
    assert normal.shape == (2, 3)
    assert (normal == normal).all()
