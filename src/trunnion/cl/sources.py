"""Where the text of CL files comes from: plain files, gzip, bzip2, ZIP archives, and streams such as stdin.

In:     a path or a binary stream.
Out:    ``ClSource``: the texts of the CL files in it, each of which can be read from its beginning again and again.

The first bytes of a file decide how it is packed, never its name. Nothing is unpacked to disk. A text that grows out
of proportion while it is unpacked is refused.
"""

import gzip
import io
import re
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import BinaryIO, Final, cast

from trunnion.cl.byte_streams import Bzip2Stream, SharedStream
from trunnion.cl.dialects import recognize_dialect
from trunnion.encoding import EncodingDetector
from trunnion.errors import InputError, Problem, unusable_file, warning
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.wording import one_line

#: A text that is longer than this may be no more than so many times as long as its archive. CL files are some 3 to 25
#: times as long; what is made to fill the memory, 1000 times and more.
_FREE_BYTES: Final = 16 << 20
MAX_RATIO: Final = 200

#: Longest text of an archive or a stream.
MAX_BYTES: Final = 4 << 30

#: Most files in an archive.
MAX_FILES: Final = 500

#: A stream is kept in memory up to this size, and beyond it in a file without a name.
_IN_MEMORY: Final = 64 << 20
_PIECE: Final = 1 << 20

_GZIP, _BZIP2, _ZIP = b"\x1f\x8b", b"BZh", (b"PK\x03\x04", b"PK\x05\x06")

#: First bytes of archives that are not read.
_OTHERS: Final = {
    b"\xfd7zXZ\x00": "an xz file",
    b"7z\xbc\xaf\x27\x1c": "a 7-Zip archive",
    b"Rar!\x1a\x07": "a RAR archive",
    b"\x28\xb5\x2f\xfd": "a zstd file",
    b"\x1f\x9d": "a compress file",
}

#: Where a tar archive says that it is one.
_TAR: Final = slice(257, 262)

#: Text that the reader refuses with a cure.
_UTF16: Final = (b"\xff\xfe", b"\xfe\xff")

#: Bytes by which the dialect of a file in an archive is recognized.
_HEAD: Final = 1 << 16

#: A statement that only CL files have.
_MOTION: Final = re.compile(rb"^[ \t]*(?:GOTO|GODLTA|TLON)[ \t]*[/,]", re.MULTILINE | re.IGNORECASE)


#: The flag of a name in UTF-8 in a ZIP archive.
_NAMES_IN_UTF8: Final = 1 << 11

#: Ways of packing that are read in a ZIP archive.
_METHODS: Final = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2})

#: What Python raises for archives that are damaged.
_DAMAGE: Final = (
    OSError, EOFError, ValueError, KeyError, IndexError, RuntimeError, OverflowError, zlib.error, struct.error,
    zipfile.BadZipFile,
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class ClSource:
    """The text of one CL file.

    name     for messages: its path; in an archive, the path of the archive and its name there
    open     the text from its beginning; raises ``InputError`` while it is read if it cannot be unpacked
    packed   it is a stream, or packed: it cannot be opened by its name
    remarks  what else is in the archive, with its first file
    """

    name: str
    open: Callable[[], BinaryIO]
    packed: bool = True
    remarks: tuple[Problem, ...] = ()


def is_cl_file(path: Path) -> bool:
    """Whether a file holds CL data, by its content: an archive, or lines of a dialect; False if it cannot be read.

    A pipe is not opened: nobody may ever write into it.
    """
    try:
        if not path.is_file():
            return False
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except (OSError, ValueError):
        return False
    packed = head.startswith((_GZIP, _BZIP2, *_ZIP))
    return packed or recognize_dialect(head).marked or _MOTION.search(head) is not None


def cl_sources(file: Path | BinaryIO) -> list[ClSource]:
    """Return the CL files in a file or a stream: several in a ZIP archive, in the order of their names.

    file  a path, or a binary stream, which is read to its end

    Raises ``InputError`` if it cannot be read, is damaged, has no CL file, or is an archive in an archive.
    """
    if isinstance(file, Path):
        unusable = unusable_file(file, phrase("file_of_cl"))
        if unusable:
            raise InputError(unusable)
        name, path = str(file), file

        def open_packed() -> BinaryIO:
            return path.open("rb", buffering=0)

        try:
            with open_packed() as packed:
                head, size = packed.read(1024), packed.seek(0, io.SEEK_END)
        except OSError as error:
            raise InputError(
                Problem(name, 0, Wording("FIL120", "file_unreadable", strerror=error.strerror or error))
            ) from error
    else:
        name = "stdin"
        spool = _spooled(file, name)
        size = spool.seek(0, io.SEEK_END)

        def open_packed() -> BinaryIO:
            spool.seek(0)
            return cast("BinaryIO", SharedStream(spool))

        head = open_packed().read(1024)
    if head.startswith(_ZIP):
        return _zip_sources(name, open_packed, size)
    if unpack := _unpacker(head):
        source = ClSource(name, lambda: _unpacked(name, open_packed(), unpack, size))
        with source.open() as text:
            _refuse_archive(name, text.read(1024), "an archive in an archive")
        return [source]
    _refuse_archive(name, head, "")
    return [ClSource(name, open_packed, packed=not isinstance(file, Path))]


def _unpacked(name: str, packed: BinaryIO, unpack: Callable[[BinaryIO], BinaryIO], size: int) -> BinaryIO:
    """Return the text of a packed file; to close it closes the file too."""
    return cast("BinaryIO", _Unpacked(unpack(packed), name, size, packed))


def not_one_file(first: str, count: int) -> InputError:
    """Return the error for an archive of several CL files where one is meant; ``first`` is its first file."""
    return InputError(Problem(first, 0, Wording("FIL180", "one_cl_files", count=count)))


def _unpacker(head: bytes) -> Callable[[BinaryIO], BinaryIO] | None:
    """Return what unpacks a text that begins so; None if it is not packed."""
    if head.startswith(_GZIP):
        return lambda packed: cast("BinaryIO", gzip.GzipFile(fileobj=packed, mode="rb"))
    if head.startswith(_BZIP2) and head[3:4].isdigit():
        return lambda packed: cast("BinaryIO", Bzip2Stream(packed))
    return None


def _refuse_archive(name: str, head: bytes, nested: str) -> None:
    """Refuse a text that is an archive, of a kind that is not read or within another one."""
    kind = next((kind for begin, kind in _OTHERS.items() if head.startswith(begin)), "")
    if head[_TAR] == b"ustar":
        kind = "a tar archive"
    if nested and (head.startswith(_ZIP) or _unpacker(head)):
        kind = nested
    if kind:
        raise InputError(
            Problem(
                name,
                0,
                Wording("FIL150", "not_read", nested=nested)
                if nested and (head.startswith(_ZIP) or _unpacker(head))
                else (
                    Wording("FIL150", "tar_archive_not")
                    if head[_TAR] == b"ustar"
                    else Wording(
                        "FIL150",
                        "archive_of_other_kind",
                        others=next((kind for begin, kind in _OTHERS.items() if head.startswith(begin)), ""),
                    )
                ),
            )
        )


def _zip_sources(name: str, open_packed: Callable[[], BinaryIO], size: int) -> list[ClSource]:
    """Return the CL files of a ZIP archive."""
    try:
        with open_packed() as packed, zipfile.ZipFile(packed) as archive:
            infos = [info for info in archive.infolist() if not info.is_dir()]
    except _DAMAGE as error:
        raise InputError(Problem(name, 0, Wording("FIL140", "cannot_unpacked", error=error))) from error
    _check_infos(name, infos, size)
    sources, left_out = [], []
    for info in sorted(infos, key=lambda info: _by_numbers(_member_name(info))):
        inside = f"{name}/{one_line(_member_name(info))}"
        opened = _member_opener(inside, open_packed, info.filename, size)
        why = _why_no_cl_file(inside, info, opened)
        if why:
            wording = Wording("FIL170", "left_out", reason=why)
            left_out.append(warning(inside, 0, wording))
        else:
            sources.append(ClSource(inside, opened))
    if not sources:
        raise InputError([Problem(name, 0, Wording("FIL180", "no_cl_file" if infos else "empty")), *left_out])
    first = sources[0]
    return [ClSource(first.name, first.open, remarks=tuple(left_out)), *sources[1:]]


def _check_infos(name: str, infos: Iterable[zipfile.ZipInfo], size: int) -> None:
    """Refuse an archive by its list of files."""
    files = list(infos)
    if len(files) > MAX_FILES:
        raise InputError(Problem(name, 0, Wording("FIL160", "files_more", count=len(files), max_files=MAX_FILES)))
    names = [_member_name(info) for info in files]
    if twice := next((each for each in names if names.count(each) > 1), ""):
        raise InputError(Problem(name, 0, Wording("FIL180", "two_files_named", twice=twice)))
    for info in files:
        if info.flag_bits & 1:
            raise InputError(Problem(name, 0, Wording("FIL150", "password", member_name=_member_name(info))))
        if info.compress_type not in _METHODS:
            raise InputError(Problem(name, 0, Wording("FIL150", "packed_way_not", member_name=_member_name(info))))
    _check_size(name, sum(info.file_size for info in files), size)


def _check_size(name: str, unpacked: int, packed: int) -> None:
    """Refuse what is out of all proportion."""
    if unpacked > MAX_BYTES:
        wording = Wording("FIL160", "too_long", gigabytes=MAX_BYTES >> 30)
    elif unpacked > _FREE_BYTES and unpacked > MAX_RATIO * packed:
        wording = Wording("FIL160", "out_of_proportion", ratio=MAX_RATIO)
    else:
        return
    raise InputError(Problem(name, 0, wording))


def _member_name(info: zipfile.ZipInfo) -> str:
    """Return the name of a file in an archive, also where it is in UTF-8 or GBK and the archive does not say so."""
    if info.flag_bits & _NAMES_IN_UTF8 or info.filename.isascii():
        return info.filename
    raw = info.filename.encode("cp437")
    detector = EncodingDetector()
    detector.add(raw)
    encoding = detector.encoding()
    return info.filename if encoding == "latin-1" else raw.decode(encoding, "replace")


def _by_numbers(name: str) -> list[tuple[int, int, str]]:
    """Names in their order, with the numbers in them by their values: 2 comes before 10."""
    parts = re.split(r"([0-9]+)", name)
    return [(0, int(part), part) if part.isdecimal() and part.isascii() else (1, 0, part) for part in parts]


def _member_opener(inside: str, open_packed: Callable[[], BinaryIO], member: str, size: int) -> Callable[[], BinaryIO]:
    def opened() -> BinaryIO:
        packed = open_packed()
        try:
            text = zipfile.ZipFile(packed).open(member)  # noqa: SIM115 - closed with what reads it
        except _DAMAGE as error:
            packed.close()
            raise InputError(Problem(inside, 0, Wording("FIL140", "cannot_unpacked", error=error))) from error
        return cast("BinaryIO", _Unpacked(cast("BinaryIO", text), inside, size, packed))

    return opened


def _why_no_cl_file(inside: str, info: zipfile.ZipInfo, opened: Callable[[], BinaryIO]) -> str:
    """Why a file of an archive is not read; empty if it is."""
    parts = info.filename.split("/")
    if "__MACOSX" in parts or parts[-1].startswith("."):
        return "is a file of a system, and is left out"
    with opened() as text:
        head = text.read(_PIECE)
    _refuse_archive(inside, head, "an archive in an archive")
    if (
        not head.strip(b"\0")
        or head.startswith(_UTF16)
        or _MOTION.search(head)
        or recognize_dialect(head[:_HEAD]).marked
    ):
        return ""  # damaged ones too: the reader says what is wrong
    return "is no CL file, and is left out"


def _spooled(stream: BinaryIO, name: str) -> BinaryIO:
    """Return the content of a stream, so that it can be read twice."""
    spool: BinaryIO = io.BytesIO()
    done = 0
    try:
        while piece := stream.read(_PIECE):
            if not isinstance(piece, bytes):
                raise InputError(Problem(name, 0, Wording("FIL190", "stream_text")))
            done += len(piece)
            _check_size(name, done, done)
            if done > _IN_MEMORY and isinstance(spool, io.BytesIO):
                memory, spool = spool, _temporary_file()
                spool.write(memory.getbuffer())
            spool.write(piece)
    except OSError as error:
        raise InputError(
            Problem(name, 0, Wording("FIL120", "archive_unreadable", strerror=error.strerror or error))
        ) from error
    return spool


def _temporary_file() -> BinaryIO:
    """Return a file without a name, which goes when nothing reads it any more."""
    return cast("BinaryIO", tempfile.TemporaryFile())


class _Unpacked(io.RawIOBase):
    """A text while it is unpacked: damage and unreasonable growth are ``InputError``; reads are full up to the end."""

    def __init__(self, text: BinaryIO, name: str, packed_bytes: int, packed: BinaryIO) -> None:
        self._text = text
        self._name = name
        self._packed_bytes = packed_bytes
        self._packed = packed
        self._done = 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview, /) -> int:  # type: ignore[override]
        count = 0
        try:
            while count < len(buffer) and (piece := self._text.read(min(len(buffer) - count, _PIECE))):
                buffer[count : count + len(piece)] = piece
                count += len(piece)
                _check_size(self._name, self._done + count, self._packed_bytes)
        except _DAMAGE as error:
            raise InputError(Problem(self._name, 0, Wording("FIL140", "cannot_unpacked", error=error))) from error
        self._done += count
        return count

    def close(self) -> None:
        self._text.close()
        self._packed.close()
        super().close()
