"""Cures of messages about files on computers that refuse something: disks, rights, archives, jobs that died."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import looked_at, script

_POST: Final = "trunnion post part.cls --machine yl569"
_OUT: Final = f"{_POST} --output out.mpf"
_MANIFEST: Final = f"{_OUT} --manifest out.json\nfails io.open EACCES out.json\ntrunnion verify out.json"
_DIVIDED: Final = "trunnion post part.cls --machine matsuura_mx330 --output out.nc --set programs=operations"
_UNREADABLE: Final = "fails io.open EACCES part.cls\ntrunnion info part.cls"
_DISK: Final = "fails trunnion.files.hidden_folders.HiddenFolders._make ENOSPC full"
_FULL: Final = f"{_DISK}\nmkdir full\n{_POST}"
_BATCH: Final = "mkdir in\ncp part.mpf in/a.mpf\ntrunnion batch in --action verify --machine yl569 --results out"
_REFUSED: Final = "set os.access 'lambda path, mode: not str(path).endswith(\"bad\")'\nmkdir bad\n"
_CLOSED: Final = "(lambda s: (s.close(), trunnion.post('part.cls', machine='yl569', output=s)))(io.BytesIO())"
_NO_SPACE: Final = "fails pathlib.Path.replace ENOSPC .\n"
_OURS: Final = f"write part.mpf ours\n{_POST}"
_PAPERS: Final = f"{_OUT} --listing a.html --report b.html --json c.json"
_NEXT: Final = "trunnion post two.cls --machine yl569 --output out.mpf"
_FEW: Final = "set trunnion.jobs.post.left_over_files._MOST_NAMED 1\n"


def _archive(message: str, text: str, old: str, new: str) -> Cure:
    """A ZIP archive that is asked about, and what the cure changes."""
    return script(message, f"zip part.zip part.cls\n{text}\ntrunnion info part.zip", old, new)


CURES: Final = (
    script(
        "FIL120 cannot_read",
        "cp part.mpf b.mpf\nfails pathlib.Path.stat EACCES part.mpf\ntrunnion verify part.mpf --machine yl569",
        "verify part",
        "verify b",
    ),
    script("FIL120 file_unreadable", _UNREADABLE, "info part.cls", "info two.cls"),
    script("FIL120 ", _UNREADABLE, "info part.cls", "info two.cls"),
    script("FIL130 not_regular_file", "fifo a.mpf\ntrunnion verify a.mpf --machine yl569", "verify a", "verify part"),
    script(
        "FIL150 archive_of_other_kind",
        "Path('a.rar').write_bytes(b'Rar!' + bytes([26, 7]))\ntrunnion info a.rar",
        "info a.rar",
        "info part.cls",
    ),
    script(
        "FIL150 archive_of_other_kind",
        "Path('a.rar').write_bytes(b'Rar!' + bytes([26, 7]))\ntrunnion info a.rar",
        "trunnion info a.rar",
        "zip part.zip part.cls\ntrunnion info part.zip",
    ),
    _archive("FIL150 password", "listed part.zip 8 1", "listed part.zip 8 1\n", ""),
    _archive("FIL150 packed_way_not", "listed part.zip 10 99", "listed part.zip 10 99\n", ""),
    script(
        "FIL160 files_more",
        "set trunnion.cl.sources.MAX_FILES 1\nzip part.zip part.cls two.cls\ntrunnion info part.zip",
        "part.cls two.cls",
        "part.cls\nzip two.zip two.cls\ntrunnion info two.zip",
    ),
    _archive("FIL160 too_long", "set trunnion.cl.sources.MAX_BYTES 5", "info part.zip", "info part.cls"),
    _archive(
        "FIL160 out_of_proportion",
        "set trunnion.cl.sources._FREE_BYTES 5\nset trunnion.cl.sources.MAX_RATIO 0",
        "info part.zip",
        "info part.cls",
    ),
    looked_at("FIL170 left_out", "append part.mpf ''\nzip part.zip part.cls part.mpf\ntrunnion info part.zip"),
    script(
        "FIL180 two_files_named",
        "zip part.zip part.cls part.cls\ntrunnion info part.zip",
        "part.cls part.cls",
        "part.cls two.cls",
    ),
    script(
        "FIL210 cannot_written_names",
        "mkdir out\ntrunnion.post('part.cls', machine='yl569', output='out/')",
        "'out/'",
        "'out/a.mpf'",
    ),
    script("FIL210 cannot_written_no", f"socket out\n{_POST} --output out", "--output out", "--output out.mpf"),
    script(
        "FIL210 device_several_files",
        "fifo a.mpf\nedit project.toml out.mpf a.mpf\ntrunnion post project.toml",
        "out.mpf a.mpf",
        "out.mpf b.mpf",
    ),
    script("FIL210 subprogram_cannot_written", f"fifo O1001.nc\n{_DIVIDED}", "trunnion", "rm O1001.nc\ntrunnion"),
    script(
        "FIL230 no_temporary_file",
        "set tempfile.tempdir '\"gone\"'\ntrunnion.post('part.cls', machine='yl569', output=io.BytesIO())",
        "gone",
        ".",
    ),
    script("FIL230 cannot_written", f"{_REFUSED}{_POST} --output bad/a.mpf", "bad/a.mpf", "a.mpf"),
    script("FIL230 disk_full", f"{_FULL} --output full/a.mpf", f"{_DISK}\n", ""),
    script("FIL230 disk_full", f"{_FULL} --output full/a.mpf", "full/a.mpf", "a.mpf"),
    script("FIL230 ", f"{_FULL} --output full/a.mpf", "full/a.mpf", "a.mpf"),
    script("FIL230 stream", _CLOSED, "s.close()", "s"),
    script("FIL230 stream", _CLOSED, "output=s", "output='out.mpf'"),
    script("FIL230 store_full", f"{_NO_SPACE}{_BATCH}", _NO_SPACE, ""),
    script("FIL230 store", f"fails pathlib.Path.mkdir EROFS bad\n{_BATCH[:-3]}bad", "--results bad", "--results out"),
    script(
        "FIL250 not_as_posted",
        "write a.txt ours\nedit project.toml out.mpf a.txt\ntrunnion post project.toml",
        "out.mpf a.txt",
        "out.mpf b.txt",
    ),
    script(
        "FIL250 not_as_posted",
        "write a.txt ours\nedit project.toml out.mpf a.txt\ntrunnion post project.toml",
        "trunnion",
        "mv a.txt c.txt\ntrunnion",
    ),
    script("FIL250 not_as_written", _OURS, "yl569", "yl569 --output part.mpf --set edited=keep"),
    script("FIL250 not_as_written", _OURS, "yl569", "yl569 --output b.mpf"),
    script(
        "FIL250 not_as_written_among_others",
        f"mkdir out\nwrite out/part.mpf ours\n{_POST.replace('part.cls', 'part.cls two.cls')} --output out",
        "trunnion",
        "mv out/part.mpf a.mpf\ntrunnion",
    ),
    script(
        "FIL280 many_files_left_over",
        f"{_FEW}{_PAPERS}\n{_NEXT}",
        _NEXT,
        f"{_NEXT} --listing a.html --report b.html --json c.json",
    ),
    script("FIL330 cannot_be_read", _MANIFEST, "fails io.open EACCES out.json\n", ""),
)
