"""What the builder's page may ask for: a start, a change, a judgement, a sample program, and to save.

In:     requests as JSON has them.
Out:    answers of the same kind. Nothing is kept between two requests, and nothing is written but by ``save``.
"""

import base64
import binascii
import hashlib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from trunnion.builder.chains import CHAINS, chain_text
from trunnion.builder.document import (
    FieldPath,
    UnclearPlaceError,
    Value,
    located,
    same,
    with_table_moved,
    with_value,
    without_value,
)
from trunnion.builder.draft import Draft, draft_data, inherited_value, judge
from trunnion.builder.likeness import definition_like
from trunnion.builder.sample import sample_data, without_program
from trunnion.builder.saved_file import check_length, check_place, file_text, is_file_name, page_text, read_raw
from trunnion.controls.loading import shipped_controls
from trunnion.definitions.value_marks import without_mark
from trunnion.errors import InputError
from trunnion.files import atomic_file
from trunnion.machines import load_machine, shipped_machines
from trunnion.messages import LIBRARY, Words
from trunnion.records import dataclass
from trunnion.schemas import first_line, put_beside

#: A CL file for the sample program has so many bytes at most.
MOST_CL_BYTES: Final = 4_000_000


class RequestError(ValueError):
    """A request that the page does not make."""


@dataclass(slots=True)
class BuilderSession:
    """A definition that is being built.

    folder   where it is saved, and below which lies what it extends
    name     of the file that the builder was opened with; empty: a new definition
    """

    folder: Path
    name: str = ""

    def start(self, file: str = "", words: Words = LIBRARY) -> dict[str, Any]:
        """Return what the page begins with: the text of the file, and what a new definition can start from.

        file  name of another file of the folder, which a page has saved; empty: the one that was opened
        words  of who looks

        Raises ``InputError`` if the file cannot be read.

        Raises ``RequestError`` if no file of the folder has such a name.
        """
        name = file or self.name
        text = ""
        if name:
            check_place(self._place(name))
            text = read_raw(self._place(name))
        return {
            "title": name or "machine.toml",
            "language": words.language,
            "file": name,
            "text": page_text(text),
            "seen": _digest(text) if name else "",
            "machines": [{"key": key, "name": load_machine(key).name} for key in shipped_machines()],
            "controls": shipped_controls(),
            "chains": [{"key": key, "order": chain.order} for key, chain in CHAINS.items()],
        }

    def answer(self, what: str, given: Mapping[str, Any], words: Words = LIBRARY) -> dict[str, Any] | None:
        """Answer a request in the words of who makes it; None: there is no such request.

        Raises ``RequestError`` if it is not made as the page makes it.
        """
        match what:
            case "begin":
                return self._begin(given, words)
            case "judge":
                return self._judged(_text(given, "text"), given, words)
            case "change":
                return self._change(given, words)
            case "sample":
                return self._sample(given, words)
            case "save":
                return self._save(given, words)
        return None

    def _place(self, name: str) -> Path:
        """Return the path of a file of the folder."""
        if not is_file_name(name) and (not name or name != self.name):
            raise RequestError
        return self.folder / name

    def _draft(self, text: str, given: Mapping[str, Any]) -> Draft:
        """Return a text, as the file of the page would have it: each page has its own."""
        return judge(text, self._place(_text(given, "file") or self.name or "machine.toml"))

    def _judged(self, text: str, given: Mapping[str, Any], words: Words) -> dict[str, Any]:
        return {"text": text, **draft_data(self._draft(text, given), words)}

    def _begin(self, given: Mapping[str, Any], words: Words) -> dict[str, Any]:
        """Return a new definition: one that extends a shipped machine, or one with an order of axes."""
        name = _text(given, "name").strip() or "Our machine"
        base, chain, control = (_text(given, key) for key in ("base", "chain", "control"))
        if base:
            if base not in shipped_machines():
                raise RequestError
            text = definition_like(load_machine(base), name, words)
        else:
            if control not in shipped_controls() or chain not in CHAINS:
                raise RequestError
            text = chain_text(chain, name, control, words)
        return self._judged(text, given, words)

    def _change(self, given: Mapping[str, Any], words: Words) -> dict[str, Any]:
        """Return the definition with a value set, taken out, or an axis moved; ``unclear`` where only the user can do
        that.
        """
        text, draft = _text(given, "text"), self._draft(_text(given, "text"), given)
        if draft.root is None:
            return {"text": text, **draft_data(draft, words), "unclear": "broken"}
        try:
            if "move" in given:
                by = given.get("by")
                if by not in (-1, 1):
                    raise RequestError
                text = with_table_moved(text, "axis", _text(given, "move"), by)
            else:
                text = _with_entry(draft, text, _path(given.get("path")), given.get("value"))
        except RequestError:
            raise
        except (UnclearPlaceError, KeyError, TypeError, ValueError, RecursionError):
            return {"text": text, **draft_data(draft, words), "unclear": "unclear"}
        return self._judged(text, given, words)

    def _sample(self, given: Mapping[str, Any], words: Words) -> dict[str, Any]:
        draft = self._draft(_text(given, "text"), given)
        before = given.get("before", [])
        if not isinstance(before, list) or not all(isinstance(line, str) for line in before):
            raise RequestError
        if draft.machine is None or draft.problems:
            return without_program()
        name = _text(given, "clName")[:200]
        return sample_data(draft.machine, _cl(given.get("cl")), name, before, words)

    def _save(self, given: Mapping[str, Any], words: Words) -> dict[str, Any]:
        """Write the definition, unless another one would be lost that the user has not seen."""
        text, name, seen = _text(given, "text"), _text(given, "name"), _text(given, "seen")
        if name and name != self.name and "." not in name:
            name += ".toml"
        opened = _text(given, "file") or self.name
        try:
            file = self._place(name)
        except RequestError:
            return {"saved": "", "why": "name"}
        try:
            check_place(file)
            old = read_raw(file) if file.exists() else ""
            if file.exists() and _digest(old) != seen and given.get("replace") is not True:
                return {"saved": "", "why": "changed" if name == opened and seen else "exists"}
            written = file_text(text, old)
            check_length(file, written)
            with atomic_file(file) as sink:
                sink.write(written.encode())
            if text.startswith(first_line("machine")):
                put_beside(file, "machine")
        except InputError as error:
            return {
                "saved": "",
                "why": "cannot",
                "problems": [problem.line_of_text(words) for problem in error.problems],
            }
        return {"saved": str(file), "name": name, "seen": _digest(written), "mistakes": len(judge(text, file).problems)}


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _text(given: Mapping[str, Any], key: str) -> str:
    value = given.get(key, "")
    if not isinstance(value, str):
        raise RequestError
    return value


def _with_entry(draft: Draft, text: str, path: FieldPath, value: Any) -> str:
    """Return a text with what was entered at a place; None, or what it inherits anyway, leaves the place out.

    A value with a mark has been measured now, even if it is the one that another machine has.
    """
    was = tomllib.loads(text)
    is_marked = without_mark(text, located(was, path)) != text
    if value is None or (same(value, inherited_value(draft, path)) and not is_marked):
        return without_value(text, path)
    changed = with_value(text, path, _value(value))
    return without_mark(changed, located(tomllib.loads(changed), path))


def _path(given: object) -> FieldPath:
    if not isinstance(given, list) or not given or not isinstance(given[-1], str):
        raise RequestError
    path: FieldPath = ()
    for step in given:
        follows_key = bool(path) and isinstance(path[-1], str)
        if isinstance(step, list) and len(step) == 1 and isinstance(step[0], str) and follows_key:
            path = (*path, (step[0],))
        elif isinstance(step, str):
            path = (*path, step)
        else:
            raise RequestError
    return path


def _value(given: object) -> Value:
    if isinstance(given, str | bool | int | float):
        return given
    if isinstance(given, list) and all(isinstance(item, int | float) and not isinstance(item, bool) for item in given):
        return given
    raise RequestError


def _cl(given: object) -> bytes | None:
    if given is None:
        return None
    if not isinstance(given, str) or len(given) > MOST_CL_BYTES * 4 // 3 + 4:
        raise RequestError
    try:
        return base64.b64decode(given, validate=True)
    except binascii.Error:
        raise RequestError from None
