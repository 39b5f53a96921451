"""Cures of messages about NC programs that cannot be read, call too much, or leave too much behind."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, marked, verify
from tests.support.cures.reading import ended
from tests.support.cures.scripts import script
from tests.support.locations import ROOT
from tests.support.program_heads import HEADS
from trunnion.readers.program.settings import no_reading

_VERIFY: Final = "trunnion verify part.mpf --machine yl569"
_UNREAD: Final = "fails trunnion.readers.program.source_text.Path.open EIO part.mpf\n"
_GONE: Final = "fails trunnion.verification.checks.word_checks.Path.read_bytes EIO p.mpf\n"
_INSERTED: Final = (
    "edit part.cls END 'INSERT/G777\\nEND'\ntrunnion post part.cls --machine yl569 --force --output p.mpf\n"
    "trunnion verify p.mpf --machine yl569 --cl part.cls"
)


def _of_axes(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program on a machine whose linear axes have names."""
    library = (ROOT / "src/trunnion/machines/library/generic_head_table_bc.toml").read_text(encoding="utf-8")
    for name, own in zip("XYZ", text, strict=True):
        library = library.replace(f'"{name}"', f'"{own}"')
    (folder / "ours.toml").write_text(library, encoding="utf-8")
    return verify(str(folder / "ours.toml"))(HEADS["yl569"].format(lines="G1 X10 F100"), settings, folder)


def _with_two(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program with two subprograms where one is the most that is followed."""
    files = [folder / "SUBA.SPF", folder / "SUBB.SPF"]
    for file in files:
        file.write_text("G1 X12 F100\nM17\n", encoding="utf-8")
    program = folder / "part.mpf"
    program.write_text(HEADS["yl569"].format(lines=text.rstrip()), encoding="utf-8")
    with patch("trunnion.readers.program.interpreter.MAX_SUBPROGRAMS", 1):
        return ended(lambda: trunnion.verify(program, machine="yl569", subprograms=files))


def _two_told(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program where the first of the modes that it leaves on is said alone."""
    with patch("trunnion.jobs.verify.program_warnings._MOST_TOLD", 1):
        return verify("matsuura_mx330")(text, settings, folder)


def _no_reading(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Load a definition whose family has nothing under [control.reading]."""
    file = folder / "ours.toml"
    file.write_text(f'schema = 1\nextends = "yl569"\nname = "Ours"\n{text}', encoding="utf-8")
    return ended(lambda: no_reading(trunnion.load_machine(file)))


_READING: Final = "[control.reading]\nrapid_height = 5\n"
_HEAD, _, _FOOT = HEADS["matsuura_mx330"].partition("{lines}\n")

CURES: Final = (
    script("NC111 cannot_read", _UNREAD + _VERIFY, _UNREAD, ""),
    script("NC111", _UNREAD + _VERIFY, _UNREAD, ""),
    script("NC111 cannot_read_again", _INSERTED.replace("trunnion verify", f"{_GONE}trunnion verify"), _GONE, ""),
    Cure("DEF320", "unknown_key", _no_reading, _READING, ((_READING, ""),)),
    Cure("NC121", "other_axes", _of_axes, "UVW", (("UVW", "XYZ"),)),
    marked("NC140 too_many_subprograms", _with_two, "SUBA", "- SUBB"),
    marked("NC351 more_noted", _two_told, "G16", "+ G15", head=_HEAD, foot=_FOOT),
)
