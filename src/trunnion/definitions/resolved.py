"""A merged definition as TOML, with the file and line behind each value from which it comes."""

from collections.abc import Iterator, Mapping
from pathlib import PurePath

from trunnion.definitions.marked_values import marked_in
from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.toml_text import written, written_key
from trunnion.definitions.value_marks import ANY_MARK
from trunnion.messages import LIBRARY, Words, phrase


def resolved_text(root: LocatedValue, words: Words = LIBRARY) -> str:
    """Return a merged definition as TOML that says the same; what it extends is in it, and not named.

    A comment behind each value names file and line, after the mark of a value that is still to be measured or assumed;
    the files are listed at the top, with their folders.
    """
    names = _short_names(sorted(set(_files(root))))
    marks = {(each.file, each.line): f"{each.mark}; " for each in marked_in(root, ANY_MARK)}
    head = "".join(f"# {name}: {file}\n" for file, name in names.items())
    lines = "\n".join(_table(root, (), names, marks))
    return f"# {phrase('where_values_come_from').text('what', words)}\n{head}\n{lines}\n"


def _files(value: LocatedValue) -> Iterator[str]:
    inner = value.value
    if isinstance(inner, dict):
        for item in inner.values():
            yield from _files(item)
    elif _is_tables(value):
        for item in inner if isinstance(inner, list) else []:
            yield from _files(item)
    else:
        yield value.file


def _short_names(files: list[str]) -> Mapping[str, str]:
    """Return the name of each file without its folder, where no other one has the same."""
    names = [PurePath(file.replace("\\", "/")).name for file in files]
    return {file: name if names.count(name) == 1 else file for file, name in zip(files, names, strict=True)}


def _is_tables(value: LocatedValue) -> bool:
    return isinstance(value.value, list) and bool(value.value) and isinstance(value.value[0], LocatedValue)


def _table(
    table: LocatedValue, path: tuple[str, ...], names: Mapping[str, str], marks: Mapping[tuple[str, int], str]
) -> Iterator[str]:
    """Yield the lines of a table: values first, then the tables in it."""
    content = table.value if isinstance(table.value, dict) else {}
    for key, item in content.items():
        if not isinstance(item.value, dict) and not _is_tables(item) and key != "extends":
            mark = marks.get((item.file, item.line), "")
            yield f"{written_key(key)} = {written(item.value)}  # {mark}{names[item.file]}:{item.line}"
    for key, item in content.items():
        below = (*path, key)
        dotted = ".".join(map(written_key, below))
        if isinstance(item.value, dict):
            yield from ("", f"[{dotted}]")
            yield from _table(item, below, names, marks)
        elif _is_tables(item) and isinstance(item.value, list):
            for each in item.value:
                yield from ("", f"[[{dotted}]]")
                yield from _table(each, below, names, marks)
