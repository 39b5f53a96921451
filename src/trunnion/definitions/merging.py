"""One definition merged onto another that it extends.

Tables merge key by key. Arrays of tables with names merge by name: those that both have merge, new ones follow, and
``remove = true`` takes one out. Any other value of the child replaces that of the parent.
"""

from trunnion.definitions.messages import as_written, meant_word
from trunnion.definitions.source_lines import LocatedValue
from trunnion.errors import Problem
from trunnion.messages import Wording


def merge(
    parent: LocatedValue, child: LocatedValue, path: str, problems: list[Problem], keep_removals: bool = False
) -> LocatedValue:
    """Return the parent with what the child says instead.

    parent, child  values of the same key
    path           path of the key from the root of the definition, for messages
    problems       takes mistakes
    keep_removals  the value is within a table that extends something not loaded yet (``resolve_extends``). Its removals
                   must stay
    """
    if isinstance(parent.value, dict) and isinstance(child.value, dict):
        table = dict(parent.value)
        keep_removals = keep_removals or "extends" in parent.value or "extends" in child.value
        for key, value in child.value.items():
            below = f"{path}.{key}" if path else key
            table[key] = merge(table[key], value, below, problems, keep_removals) if key in table else value
        return LocatedValue(table, child.file, child.line)
    if _are_named(parent) and _holds_tables(child):
        return LocatedValue(_merge_by_name(parent, child, path, problems, keep_removals), child.file, child.line)
    return child


def _merge_by_name(
    parent: LocatedValue, child: LocatedValue, path: str, problems: list[Problem], keep_removals: bool
) -> list[LocatedValue]:
    """Merge two arrays of named tables: those of the parent in their order, then the new ones of the child."""
    result = list(_items(parent))
    merged: dict[str, LocatedValue] = {}
    for i, item in enumerate(_items(child)):
        assert isinstance(item.value, dict)
        name = _name_of(item)
        item_path = f"{path}[{i}]"
        if name is None:
            problems.append(Problem(item.file, item.line, Wording("DEF230", "name_missing", path=path, i=i)))
            continue
        remove = item.value.get("remove")
        item = item if keep_removals else _without_remove(item)
        at = next((k for k, old in enumerate(result) if _name_of(old) == name), None)
        if remove is not None and not isinstance(remove.value, bool):
            problems.append(
                Problem(
                    remove.file,
                    remove.line,
                    Wording("DEF230", "remove", path=path, i=i, remove=as_written(remove.value)),
                )
            )
        elif remove is not None and remove.value:
            if keep_removals:
                result = [old for old in result if _name_of(old) != name] + [item]
            elif at is None:
                near = meant_word(name, map(str, map(_name_of, result)))
                wording = (
                    Wording("DEF230", "nothing_to_remove_but_near", item=item_path, path=path, name=name, near=near)
                    if near
                    else Wording("DEF230", "nothing_to_remove", item=item_path, path=path, name=name)
                )
                problems.append(Problem(remove.file, remove.line, wording))
            else:
                del result[at]
        elif name in merged:
            problems.append(
                Problem(
                    item.file,
                    item.line,
                    Wording("DEF430", "name_second_time", path=path, i=i, name=name, merged_line=merged[name].line),
                )
            )
        elif at is None:
            result.append(item)
        else:
            result[at] = merge(result[at], item, item_path, problems, keep_removals)
        merged.setdefault(name, item)
    return result


def _holds_tables(array: LocatedValue) -> bool:
    return isinstance(array.value, list) and bool(array.value) and isinstance(array.value[0], LocatedValue)


def _are_named(array: LocatedValue) -> bool:
    return _holds_tables(array) and all(_name_of(item) is not None for item in _items(array))


def _items(array: LocatedValue) -> list[LocatedValue]:
    return array.value if isinstance(array.value, list) else []


def _name_of(item: LocatedValue) -> str | None:
    name = item.value.get("name") if isinstance(item.value, dict) else None
    return name.value if isinstance(name, LocatedValue) and isinstance(name.value, str) else None


def _without_remove(item: LocatedValue) -> LocatedValue:
    assert isinstance(item.value, dict)
    return LocatedValue({key: value for key, value in item.value.items() if key != "remove"}, item.file, item.line)
