"""Cures of messages about arguments of further commands, and of what they find on their computer."""

import getpass
import io
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.cures.scripts import looked_at, script
from tests.support.example_impellers import EXAMPLES
from trunnion.cli import twin
from trunnion.extras import import_extra

_COPIED: Final = "".join(
    f"cp {(EXAMPLES / name).as_posix()!r} {name}\n" for name in ("impeller.toml", "blade_points.csv")
)
_OF_BYTES: Final = "next(resolve_name('os:scandir')(b'.'))"
_COARSE: Final = (
    "edit impeller.toml 'stepover_mm = 0.5' 'stepover_mm = 8'\n"
    "edit impeller.toml 'step_down_mm = 1.5' 'step_down_mm = 6'\n"
    "edit impeller.toml '\\[\\[operation\\]\\]\\nkind = \"channel.*' ''\n"
)
_CUT: Final = f"{_COPIED}{_COARSE}trunnion impeller cut impeller.toml --machine yl569 --operation STOCK_ROUGHING"
_LEFT_THERE: Final = (
    "(lambda read: trunnion.post(read, machine='dmu65', settings={'normals': 'contact'}))(trunnion.read_cl('part.cls'))"
)
_REMOVED: Final = _LEFT_THERE.replace("(lambda read: ", "(lambda read: (Path('part.cls').unlink(), ").replace(
    "}))(", "})))("
)
_PRINTED: Final = (
    "append ours.toml '[control.templates]\\nbefore_operation = \";{operation:coordinate}\"\\n'\n"
    "trunnion post part.cls --machine ours.toml"
)


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def _asked(*answers: str) -> Trial:
    """Return what asks for a password at a terminal, at which these are given."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.object(sys, "stdin", _Terminal()), patch.object(getpass, "getpass", side_effect=answers):
            return ended(twin._password)

    return tried


def _imported(*, there: bool) -> Trial:
    """Return what imports a package that is installed, or is not."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.dict(sys.modules, {} if there else {"json": None}):
            return ended(lambda: import_extra("json", "cluster"))

    return tried


CURES: Final = (
    script("FIL270 result_without_name", "trunnion convert - --to-cl < part.cls", "--to-cl", "--to-cl --output a.cls"),
    script(
        "FIL210 no_name_file",
        f"trunnion.post('part.cls', machine='yl569', output={_OF_BYTES})",
        "next(resolve_name('os:scandir')(b'.'))",
        "'a.mpf'",
    ),
    script("ARG130 missing_folder", _CUT, "--machine", "--output out --machine"),
    script(
        "ARG130 not_for_this_step",
        f"{_COPIED}trunnion impeller model impeller.toml --tolerance 1 --cell 1",
        " --cell 1",
        "",
    ),
    Cure(
        "ARG180",
        "passwords_differ",
        _asked("long enough", "long enouhg"),
        "",
        (),
        cured_by=_asked("long enough", "long enough"),
    ),
    Cure("ARG150", "needs_not_installed", _imported(there=False), "", (), cured_by=_imported(there=True)),
    script("DEF510 text_with_format", _PRINTED, "{operation:coordinate}", "{operation}"),
    script("FIL120 input_gone", _REMOVED, _REMOVED, _LEFT_THERE),
    looked_at(
        "HOK140 ",
        "write shop.py 'from dataclasses import replace\\n\\ndef on_operation(operation, context):\\n"
        '    return replace(operation, name="OTHER")\\n\'\ntrunnion post part.cls --machine yl569 --hooks shop.py',
    ),
)
