"""Definitions in TOML: read with account of every key, and with the place that each value came from.

In:     a TOML file, or the name of a shipped one, that may extend one other.
Out:    a ``Table`` with typed getters. Mistakes are collected, and raised together by ``Table.raise_problems``.
Knows:  TOML, files and keys. What the keys mean is the reader's business: machines and controls both use this.

A definition may come from anybody, so reading one runs nothing and opens nothing but TOML files that were named by the
user, shipped with Trunnion, or lie beside or below the file that extends them.
"""

from trunnion.definitions.extends import MAX_FILE_BYTES, definition_names, load_table, resolve_extends
from trunnion.definitions.source_lines import LocatedValue, key_lines
from trunnion.definitions.table import Table, unit_of

__all__ = [
    "MAX_FILE_BYTES",
    "LocatedValue",
    "Table",
    "definition_names",
    "key_lines",
    "load_table",
    "resolve_extends",
    "unit_of",
]
