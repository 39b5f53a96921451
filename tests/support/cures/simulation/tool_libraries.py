"""Cures of messages about tool libraries, and about tools in them that cannot be used."""

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended, file_of, limited, whole
from trunnion.simulation.tools.choice import choose_tools
from trunnion.simulation.tools.library import json_text, reading
from trunnion.simulation.tools.library.reading import read_tools
from trunnion.simulation.tools.shapes import tool_shape
from trunnion.simulation.tools.sizes import ToolKind, ToolSizes
from trunnion.simulation.tools.text import parse_tool

_TOML: Final = '[[tool]]\nnumber = 3\nkind = "ball"\ndiameter_mm = 10\nlength_mm = 60\nflute_length_mm = 20\n'
_BALL: Final[Mapping[str, Any]] = {
    "type": "ball end mill", "unit": "millimeters", "description": "B10", "post-process": {"number": 3},
    "geometry": {"DC": 10, "RE": 5, "LCF": 20, "LB": 60},
}  # fmt: skip
_JSON: Final = json.dumps({"data": [_BALL]})
_BIT: Final = json.dumps(
    {"name": "B10", "shape": "ballend.fcstd", "parameter": {"Diameter": "10 mm", "Length": "60 mm"}}
)
_TABLE: Final = "T3 P3 D10.0 Z+95.2 ;comment\n"


def _zipped(*names: str, encrypted: bool = False, content: str = _JSON) -> str:
    """An archive of files that are all the library."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name in names:
            archive.writestr(name, content, zipfile.ZIP_DEFLATED)
    data = packed.getvalue()
    if encrypted:
        at = data.index(b"PK\x01\x02") + 8
        data = data[:at] + b"\x01" + data[at + 1 :]
    return data.decode("latin-1")


def _called(name: str, called: str = "3", stated: str = "", **how: str) -> Trial:
    """Return what has the tool of a program sought in a library, and a tool stated before it."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / name).write_bytes(text.encode("latin-1"))
        own = [parse_tool(each) for each in stated.split()]
        return ended(lambda: choose_tools([called], own, [read_tools(folder / name, **how, **settings)]))

    return tried


def _asked(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Ask a library for one tool, by its name or number."""
    (folder / "tools.toml").write_text(text, encoding="utf-8")
    number, name = settings.get("number"), settings.get("name", "")
    return ended(lambda: read_tools(folder / "tools.toml").tool(int(number) if number else None, name))


def _sizes(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Make a tool of sizes: a JSON object."""
    given = json.loads(text)
    return ended(lambda: tool_shape(ToolSizes(ToolKind(given.pop("kind")), **given)))


def _unreadable(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    (folder / "tools.json").write_text(text, encoding="utf-8")
    with patch.object(Path, "open", side_effect=OSError(5, "Input/output error")):
        return ended(lambda: read_tools(folder / "tools.json"))


def _unusable(variant: str, text: str, name: str, called: str = "3") -> Cure:
    """A tool of a library that cannot be used is stated in its place."""
    stated = f"{called}=ball:10,length=60,flutes=20"
    return Cure("SIM152", variant, _called(name, called), text, (), cured_by=_called(name, called, stated))


def _of_table(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """State the kind of a tool of which a table says the diameter."""
    (folder / "tool.tbl").write_text(text, encoding="utf-8")
    table = read_tools(folder / "tool.tbl", "mm")
    return ended(lambda: choose_tools(["3"], [parse_tool("3=ball", table.diameters)], [table]))


def _found_in_table(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have a tool sought in a table."""
    return file_of("tool.tbl", lambda file: read_tools(file, "mm").find(3))(text, settings, folder)


def _zipped_read(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have an archive read of the tools of a text."""
    return file_of("ours.tools", read_tools)(_zipped("tools.json", content=text), settings, folder)


def _large(variant: str, trial: Trial, module: ModuleType) -> Cure:
    """More tools than a limit of one tool takes, and one of them."""
    two = json.dumps({"data": [_BALL] * 5})
    return Cure("SIM172", variant, limited(trial, module, "MAX_BYTES", 2 * len(_JSON)), two, ((two, _JSON),))


_damaged: Final = whole("SIM170", file_of("tools.json", read_tools))
_kind: Final = whole("SIM171", file_of("tools.json", read_tools))
_table: Final = whole("SIM174", _found_in_table)
_READ: Final = file_of("tools.json", read_tools)
_TWICE: Final = json.dumps({"data": [_BALL, {**_BALL, "geometry": {"DC": 12, "RE": 6, "LCF": 20, "LB": 60}}]})
_STATED: Final = _called("tools.json", stated="3=ball:10,length=60,flutes=20")


CURES: Final = (
    Cure(
        "SIM152",
        "size_of_other_kind",
        _sizes,
        '{"kind": "ball", "diameter": 10, "corner_radius": 2}',
        ((', "corner_radius": 2', ""),),
    ),
    _unusable("of_library", _JSON.replace('"RE": 5', '"RE": 4'), "tools.json"),
    _unusable("tool_bit", _BIT.replace("10 mm", "ten"), "tool.fctb", "B10"),
    _damaged("not_utf_8", '{"data": ["\xff"]}', _JSON),
    _damaged("nests_too_deeply", '{"data": ' + "[" * 100_000, _JSON),
    _damaged("not_json", '{"data": [}', _JSON),
    _damaged("library_not_json", '{"data": NaN}', _JSON),
    _damaged("faulty", '{"data": 5}', _JSON),
    _damaged("damaged_archive", _zipped("tools.json")[:-30], _zipped("tools.json")),
    _damaged("archive_file_them", _zipped("one.json", "two.json"), _zipped("tools.json")),
    _damaged("archive_password_rare", _zipped("tools.json", encrypted=True), _zipped("tools.json")),
    Cure("SIM170", "", _unreadable, _JSON, (), cured_by=file_of("tools.json", read_tools)),
    _kind("json_but_neither", "{}", _JSON),
    _kind("no_tool_library", "tools of ours", _JSON),
    _kind("no_tool_library", "tools of ours", _BIT),
    _large("more_bytes", _READ, reading),
    _large("more_mb_tools", _READ, json_text),
    _large("grows_more_mb", _zipped_read, reading),
    Cure(
        "SIM172",
        "archive_more_files",
        limited(file_of("ours.tools", read_tools), reading, "_MAX_FILES", 1),
        _zipped("tools.json", "note.txt"),
        ((_zipped("tools.json", "note.txt"), _zipped("tools.json")),),
    ),
    Cure(
        "SIM173",
        "tools_have",
        _called("tools.json"),
        _TWICE,
        (('"number": 3}, "geometry": {"DC": 12', '"number": 4}, "geometry": {"DC": 12'),),
    ),
    Cure("SIM173", "tools_have", _called("tools.json"), _TWICE, (), cured_by=_STATED),
    Cure("SIM150", "tool_diameter_mm", _called("tool.tbl", unit="mm"), _TABLE, (), cured_by=_of_table),
    Cure(
        "SIM150",
        "nothing_says_form",
        _called("tools.toml", "4"),
        _TOML,
        (),
        cured_by=_called("tools.toml", "4", "4=ball:10,length=60,flutes=20"),
    ),
    Cure("SIM150", "nothing_says_form", _called("tools.toml", "4"), _TOML, (), cured_by=_called("tools.toml", "3")),
    Cure(
        "SIM151",
        "tool_stated_times",
        _called("tools.toml", "4", "4=ball:10 4=ball:10"),
        _TOML,
        (),
        cured_by=_called("tools.toml", "4", "4=ball:10"),
    ),
    Cure("SIM173", "no_tool_number", _asked, _TOML, (("number = 3", "number = 4"),), {"number": "4"}),
    Cure("SIM173", "no_tool_name", _asked, _TOML, (("number = 3", 'name = "B10"'),), {"name": "B10"}),
    Cure(
        "SIM174",
        "neither_number_nor",
        file_of("tools.toml", read_tools),
        _TOML.replace("number = 3\n", ""),
        (("[[tool]]", "[[tool]]\nnumber = 3"),),
    ),
    Cure(
        "SIM151",
        "too",
        file_of("tools.toml", read_tools),
        _TOML + _TOML,
        ((_TOML + _TOML, _TOML + _TOML.replace("= 3", "= 4")),),
    ),
    Cure(
        "SIM151",
        "tool_twice",
        _found_in_table,
        _TABLE + _TABLE,
        ((_TABLE + _TABLE, _TABLE + _TABLE.replace("T3", "T4")),),
    ),
    _table("tool_diameter", "T3 P3 D-1\n", _TABLE),
    _table("no_word", "T3 P3 10.0\n", _TABLE),
    _table("letter_twice", "T3 P3 D10.0 D11.0\n", _TABLE),
    _table("no_number_of_tool", "P3 D10.0\n", _TABLE),
    Cure("SIM175", "not_stated_tool", file_of("tool.tbl", read_tools), _TABLE, ({"unit": "mm"},)),
    Cure("SIM175", "is", file_of("tool.tbl", read_tools), _TABLE, ({"unit": "inch"},), {"unit": "cm"}),
)
