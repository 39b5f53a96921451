"""Cures of messages about pages: the builder, the viewer and reports."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended, file_of, limited, text_of, whole
from tests.support.simulating import SLOT
from trunnion.builder import saved_file
from trunnion.builder.chains import CHAINS, chain_text
from trunnion.controls import shipped_controls
from trunnion.jobs.view.viewing import prepare_view
from trunnion.machines import load_machine
from trunnion.reporting.write import write_refusal
from trunnion.viewer.serving import take_port

_OURS: Final = 'extends = "yl569"\n'


def _viewed(*names: str, **given: Any) -> Trial:
    """Return what prepares a view of files of the text."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        for name in names:
            (folder / name).write_text(text, encoding="utf-8")
        return ended(
            lambda: prepare_view([folder / name for name in names], **{"machine": "xyzac_trt", **given, **settings})
        )

    return tried


def _served(host: str = "127.0.0.1", port: int = 0, *, taken: bool = False) -> Trial:
    """Return what takes a port for a moment, or one that is taken."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with take_port("127.0.0.1", 0) as other:
            own = other.getsockname()[1] if taken else port
            return ended(lambda: take_port(host, own).close())

    return tried


def _at_link(*, linked: bool) -> Trial:
    """Return what opens a definition, which may be a link that leads out of its folder."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        own = folder / "own"
        own.mkdir(exist_ok=True)
        (folder / "ours.toml").write_text(text, encoding="utf-8")
        place = own / "ours.toml" if linked else folder / "ours.toml"
        if linked:
            place.symlink_to(folder / "ours.toml")
        return ended(lambda: saved_file.check_place(place))

    return tried


def _reported(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Write the report of a program that is refused into a file of a name."""
    return ended(lambda: write_refusal([], load_machine("xyzac_trt"), "part.ngc", folder / text))


def _unreadable(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    (folder / "ours.toml").write_text(text, encoding="utf-8")
    with patch.object(Path, "open", side_effect=OSError(5, "Input/output error")):
        return ended(lambda: saved_file.read_raw(folder / "ours.toml"))


def _of_bytes(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Open a definition whose bytes are the letters of a text."""
    (folder / "ours.toml").write_bytes(text.encode("latin-1"))
    return ended(lambda: saved_file.read_raw(folder / "ours.toml"))


_RAW: Final = file_of("ours.toml", saved_file.read_raw)
_chain: Final = whole("PAG210", text_of(lambda chain: chain_text(chain, "Ours", shipped_controls()[0])))
_KNOWN: Final = next(iter(CHAINS))
_VIEW: Final = _viewed("part.ngc")

CURES: Final = (
    Cure("PAG110", "nothing_to_view", _viewed(), SLOT, (), cured_by=_VIEW),
    Cure("PAG110", "missing_machine", _viewed("part.ngc", machine=None), SLOT, ({"machine": "xyzac_trt"},)),
    Cure("PAG111", "setup_without_project", _viewed("part.ngc", setup="A"), SLOT, (), cured_by=_VIEW),
    Cure("PAG111", "machine_without_program", _viewed("part.ngc", against_machine="yl569"), SLOT, (), cured_by=_VIEW),
    Cure("PAG111", "of_a_simulation", _viewed("part.ngc", near=1.0), SLOT, (), cured_by=_VIEW),
    Cure("PAG111", "settings_for_program", _viewed("part.ngc", settings={"title": "A"}), SLOT, (), cured_by=_VIEW),
    Cure("PAG113", "never_called", _viewed("part.ngc", "other.ngc"), SLOT, (), cured_by=_VIEW),
    Cure("PAG120", "no_port", _served(port=70000), "", (), cured_by=_served()),
    Cure("PAG120", "no_such_host", _served(host="no.such.host.invalid"), "", (), cured_by=_served()),
    Cure("PAG120", "not_served", _served(taken=True), "", (), cured_by=_served()),
    _chain("no_chain", "spindle and nothing else", _KNOWN),
    _chain("no_chain_but_near", _KNOWN[:-1], _KNOWN),
    Cure("PAG211", "link_leads_out", _at_link(linked=True), _OURS, (), cured_by=_at_link(linked=False)),
    Cure("PAG212", "not_utf_8", _of_bytes, _OURS + "# \xff\n", ((_OURS + "# \xff\n", _OURS),)),
    Cure("PAG212", "cannot_read", _unreadable, _OURS, (), cured_by=_RAW),
    Cure("PAG213", "more_letters", limited(_RAW, saved_file, "MOST_LETTERS", 20), _OURS * 2, ((_OURS * 2, _OURS),)),
    Cure("PAG310", "report_html_json", _reported, "part.txt", ((".txt", ".html"),)),
)
