"""Cures of messages about twins, machines that are recorded, and views of projects."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.projects.simulated import CL, ONE, TWO, project_written
from tests.support.cures.reading import ended, text_of
from tests.support.simulating import HEAD, SLOT
from trunnion.jobs.twin import recording, serving
from trunnion.jobs.twin.serving import twin_program, users_file
from trunnion.jobs.view.viewing import prepare_view

_STILL: Final = "G21\nM30\n"
_HEAD: Final = "source,X,Y,Z,A,C\n"
_ROW: Final = "2026-05-04T08:30:00.020000Z,-20,0,20,0,0\n"


def _run(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have a program run as a twin."""
    (folder / "part.ngc").write_text(text, encoding="utf-8")
    return ended(lambda: twin_program(folder / "part.ngc", machine="xyzac_trt", tools=["1=flat:10,length=60"]))


def _posted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a CL file, and have the program run as a twin."""
    (folder / "part.cls").write_text(text, encoding="utf-8")
    trunnion.post(folder / "part.cls", machine="xyzac_trt", output=folder / "posted.ngc")
    return _run((folder / "posted.ngc").read_text(encoding="utf-8"), settings, folder)


def _homeless(call: Callable[[], object], module: Any, data: Path | None) -> Trial:
    """Return what asks for a folder of a user who has one or none."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.object(module, "user_data", return_value=data):
            return ended(call)

    return tried


def _compared(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Compare a recording with its program."""
    (folder / "part.ngc").write_text(HEAD + "M5\nM30\n", encoding="utf-8")
    (folder / "run.csv").write_text(text, encoding="utf-8")
    return ended(lambda: trunnion.verify(folder / "part.ngc", machine="xyzac_trt", recorded=folder / "run.csv"))


def _viewed(name: str = "part.toml", **given: Any) -> Trial:
    """Return what prepares a view of a project, or of one of its programs."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        project_written(text, folder)
        return ended(lambda: prepare_view(folder / name, **{**given, **settings}))

    return tried


_address: Final = text_of(recording.check_address)
_PROGRAM: Final = _viewed("one.ngc", machine="xyzac_trt")
_BOTH: Final = ONE.replace('["one.ngc"]', '["one.ngc", "high.ngc"]')

CURES: Final = (
    Cure("TWN110", "cl_file_served", _run, CL, (), cured_by=_posted),
    Cure("TWN111", "nothing_moves", _run, _STILL, ((_STILL, SLOT),)),
    Cure("TWN210", "user_in_address", _address, "opc.tcp://anna:secret@mill:4840", (("anna:secret@", ""),)),
    Cure(
        "TWN120",
        "no_folder_for_users",
        _homeless(users_file, serving, None),
        "",
        (),
        cured_by=_homeless(lambda: users_file("users"), serving, None),
    ),
    Cure(
        "TWN350",
        "no_column",
        _compared,
        (_HEAD + _ROW).replace(",C", "").replace(",0\n", "\n"),
        (((_HEAD + _ROW).replace(",C", "").replace(",0\n", "\n"), _HEAD + _ROW),),
    ),
    Cure(
        "TWN350",
        "no_columns",
        _compared,
        "source,X,Y,Z\n2026-05-04T08:30:00.020000Z,-20,0,20\n",
        (("source,X,Y,Z\n2026-05-04T08:30:00.020000Z,-20,0,20\n", _HEAD + _ROW),),
    ),
    Cure("PAG112", "several_setups", _viewed(), TWO, ({"setup": "A"},)),
    Cure("PAG112", "no_such_setup", _viewed(), TWO, ({"setup": "A"},), {"setup": "C"}),
    Cure("PAG112", "several_programs", _viewed(), _BOTH, (), cured_by=_PROGRAM),
    Cure(
        "PAG112",
        "several_programs_in_setup",
        _viewed(setup="A"),
        TWO.replace('["one.ngc"]', '["one.ngc", "high.ngc"]', 1),
        (),
        cured_by=_PROGRAM,
    ),
    Cure("PAG115", "clamped_turned", _viewed(), ONE + "turn_deg = 90\n", (), cured_by=_PROGRAM),
    Cure("PAG115", "clamped_turned_in_setup", _viewed(setup="B"), TWO + "turn_deg = 90\n", (), cured_by=_PROGRAM),
)
