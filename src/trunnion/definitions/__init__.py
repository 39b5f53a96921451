"""Definitions in TOML: typed getters, account of every key that is read, and the file and line of every value.

In:     a TOML file, or the name of a shipped one, that may extend one other.
Out:    a ``Table``. Mistakes are collected, and raised together by ``Table.raise_problems``.
Knows:  TOML, files and keys. What the keys mean is up to the code that reads the table: machines and controls.

A definition may come from anyone, so reading one runs nothing, and opens nothing but TOML files that the user named,
that are shipped with Trunnion, or that lie beside or below the file that extends them.
"""

from trunnion.definitions.account import in_order
from trunnion.definitions.extends import (
    MAX_FILE_BYTES,
    definition_names,
    load_draft,
    load_table,
    own_keys,
    resolve_extends,
)
from trunnion.definitions.source_lines import KeyPath, Layout, LocatedValue, layout
from trunnion.definitions.table import Table, TextForm
from trunnion.definitions.units import unit_of

__all__ = [
    "MAX_FILE_BYTES",
    "KeyPath",
    "Layout",
    "LocatedValue",
    "Table",
    "TextForm",
    "definition_names",
    "in_order",
    "layout",
    "load_draft",
    "load_table",
    "own_keys",
    "resolve_extends",
    "unit_of",
]
