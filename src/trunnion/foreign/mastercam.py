"""A post of Mastercam: the customization file (``.pst``), beside which an encrypted part (``.psb``) may lie.

In:     the files of one post. None is run: switches, tables of codes, formats and names of post blocks are text.
Out:    a ``ForeignMachine`` without axes.

``NAME : VALUE`` is a switch, ``sg00 G0`` a code of the table of strings, ``fs2 NUMBER INCH MM`` a format and
``fmt X NUMBER VARIABLE`` the format of an address. A post block begins at a name in the first column and has the
indented lines below it. Switches of rotary axes have names of each post's own, or their values are in the machine
definition of Mastercam: they are reported, and not taken.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.foreign.machine import (
    ForeignMachine,
    Key,
    Left,
    Stated,
    WordCounts,
    because,
    index,
    not_taken,
    place_in,
    read_text,
)
from trunnion.messages import Wording
from trunnion.records import dataclass

_SWITCH: Final = re.compile(r"([A-Za-z_]\w*)\$?\s*[:=]\s*([^\s#][^#]*?)\s*(?:#.*)?$", re.ASCII)
_STRING: Final = re.compile(r"(s\w*)\$?\s+(?:\"([^\"]*)\"|([GM]\d+))\s*(?:#.*)?$", re.ASCII)
_CODE: Final = re.compile(r"[GM](\d{1,4})", re.ASCII)
_FORMAT: Final = re.compile(r"fs2?\s+(\d+)\s+(\S+)(?:\s+(\S+))?\s*(?:#.*)?$", re.ASCII)
_DECIMALS: Final = re.compile(r"\d+(?:[.^](\d+))?[a-z]*", re.ASCII)
_ADDRESS: Final = re.compile(r"fmt\s+\"?([A-Za-z]+)\"?\s+(\d+)\s+(\w+)\$?", re.ASCII)
_BLOCK: Final = re.compile(r"(p\w*)\$?\s*(?:,.*|#.*)?$", re.ASCII)
_MISC: Final = re.compile(r"(?:mi|mr)\d+", re.ASCII)

#: Names of the table of strings -> keys of a control.
_CODES: Final = {
    "sg00": ("codes", "rapid"), "sg01": ("codes", "linear"), "sg02": ("codes", "arc_clockwise"),
    "sg03": ("codes", "arc_counterclockwise"), "sm03": ("codes", "spindle_clockwise"),
    "sm04": ("codes", "spindle_counterclockwise"), "sm05": ("codes", "spindle_off"), "sm08": ("coolant", "FLOOD"),
    "sm08_1": ("coolant", "MIST"), "sm09": ("coolant", "OFF"),
}  # fmt: skip

#: Addresses -> the number format of a definition that they use.
_ADDRESSES: Final = {"X": "coordinate", "A": "angle", "B": "angle", "C": "angle", "F": "feed", "S": "speed"}

#: Post blocks -> the template in which a definition has their lines.
_TEMPLATES: Final = {
    "pheader": "program_start", "psof": "first_tool", "psof0": "first_tool", "peof": "program_end",
    "peof0": "program_end", "ptlchg": "tool_change", "ptlchg0": "operation_start",
}  # fmt: skip

_WHYS: Final = (
    (_MISC, "own_setting"),
    (re.compile(r".*(?:rot|axis|pri_|sec_|lim|mtype|pivot|nut|head|tilt).*", re.ASCII),
     "enter_axes"),
    (re.compile(r"omitseq|omit_seq", re.ASCII), "setting_of_block_numbers"),
    (re.compile(r"arc\w*", re.ASCII), "table_of_arcs"),
)  # fmt: skip
_OTHER: Final = "no_such_value"

#: Switches and lines of post blocks that are reported one by one; the rest is counted.
_MOST: Final = 400


@dataclass(slots=True)
class _Post:
    """What the files say, before it is understood."""

    switches: dict[str, Stated] = field(default_factory=dict)
    strings: dict[str, Stated] = field(default_factory=dict)
    formats: dict[str, Stated] = field(default_factory=dict)
    addresses: dict[str, tuple[str, Stated]] = field(default_factory=dict)
    blocks: dict[str, tuple[str, int]] = field(default_factory=dict)
    literals: list[Left] = field(default_factory=list)
    left: list[Left] = field(default_factory=list)
    words: WordCounts = field(default_factory=WordCounts)


def read_mastercam_post(files: Sequence[Path]) -> ForeignMachine:
    """Return what a post says; its axes are in the machine definition, so ``rotary`` is empty.

    Raises ``InputError`` if a file cannot be read, only the encrypted part is there, or none of it is a post.
    """
    readable = [file for file in files if file.suffix.lower() != ".psb"]
    if not readable:
        raise InputError(Problem(str(files[0]), 0, Wording("DEF610", "encrypted")))
    post = _Post()
    for file in readable:
        _read(file, read_text(file), post)
    if not (post.switches or post.strings or post.formats or post.blocks):
        raise InputError(Problem(str(readable[0]), 0, Wording("DEF635", "no_post")))
    values = dict(_values(post))
    encrypted = [
        Left(because("encrypted_part"), place_in(file, 1), because("only_its_maker"))
        for file in files
        if file not in readable
    ]
    return ForeignMachine((), values, (*encrypted, *_left(post, values)), post.words.control)


def _read(file: Path, text: str, post: _Post) -> None:
    block = ""
    for line_number, line in enumerate(text.splitlines(), 1):
        post.words.count(line)
        place = place_in(file, line_number)
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if line[0] in " \t":
            if block:
                name, count = post.blocks[block]
                post.blocks[block] = name, count + 1
                if block in _TEMPLATES and '"' in line:
                    post.literals.append(
                        Left(line.strip()[:120], place, because("in_template", name=_TEMPLATES[block]))
                    )
            continue
        if found := _FORMAT.match(line):
            post.formats.setdefault(found[1], Stated((found[2], found[3]), f"fs2 {found[1]}", str(file), line_number))
        elif found := _ADDRESS.match(line):
            at = Stated(found[2], f"fmt {found[1]} {found[2]}", str(file), line_number)
            post.addresses.setdefault(found[1].upper(), (found[2], at))
        elif found := _STRING.match(line):
            text_of = found[2] if found[2] is not None else found[3]
            _note(post.strings, Stated(text_of, found[1], str(file), line_number), post)
        elif found := _SWITCH.match(line):
            _note(post.switches, Stated(found[2].strip(), found[1], str(file), line_number), post)
        elif found := _BLOCK.match(line):
            block = found[1]
            post.blocks.setdefault(block, (place, 0))
            continue
        else:
            post.left.append(Left(line.strip()[:120], place, because("line_not_understood")))
        block = ""


def _note(stated: dict[str, Stated], value: Stated, post: _Post) -> None:
    known = stated.setdefault(value.name, value)
    if known is not value and known.value != value.value:
        post.left.append(not_taken(value, because("value_counts", value=str(known.value), place=known.place)))


def _values(post: _Post) -> Iterator[tuple[Key, Stated]]:
    for name, key in _CODES.items():
        stated = post.strings.get(name)
        if stated is not None and (code := _CODE.fullmatch(str(stated.value).strip())):
            yield ("control", *key), stated.as_value(int(code[1]))
    if (highest := post.switches.get("seqmax")) and (last := index(highest.value)):
        yield ("control", "block_numbers", "highest"), highest.as_value(last)
    for address, name in _ADDRESSES.items():
        which, _ = post.addresses.get(address, ("", None))
        stated = post.formats.get(which)
        if stated is not None and (decimals := _decimals(stated)) is not None:
            yield ("control", "format", name, "decimals"), stated.as_value(decimals)


def _decimals(stated: Stated) -> int | None:
    """Return the decimals of a format in mm: of two numbers, the second is for mm."""
    inch, mm = stated.value
    found = _DECIMALS.fullmatch(mm or inch)
    count = index(found[1] or "0") if found else None
    return count if count is not None and count <= 9 else None


def _left(post: _Post, values: dict[Key, Stated]) -> Iterator[Left]:
    taken = {(value.file, value.line) for value in values.values()}
    rows = list(post.left)
    for stated in (*post.switches.values(), *post.strings.values()):
        if (stated.file, stated.line) not in taken:
            variant = next((why for pattern, why in _WHYS if pattern.fullmatch(stated.name)), _OTHER)
            rows.append(Left(f"{stated.name} = {stated.value}"[:120], stated.place, because(variant)))
    for stated in post.formats.values():
        if (stated.file, stated.line) not in taken:
            shown = " ".join(each for each in stated.value if each)
            rows.append(Left(f"{stated.name} = {shown}"[:120], stated.place, because("no_address")))
    for address, (_, stated) in post.addresses.items():
        if address not in _ADDRESSES:
            rows.append(Left(stated.name, stated.place, because("table_of_words")))
    rows += post.literals
    for name, (place, count) in post.blocks.items():
        why = because("in_template", name=_TEMPLATES[name]) if name in _TEMPLATES else because("nothing_is_run")
        rows.append(Left(because("post_block", name=name, count=count), place, why))
    yield from rows[:_MOST]
    if len(rows) > _MOST:
        yield Left(because("more_lines", count=len(rows) - _MOST), rows[_MOST].where, because("as_above"))
