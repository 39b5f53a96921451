"""The JSON Schemas of definitions and projects, for editors that complete and check TOML while it is typed.

In:     a kind of file.
Out:    its schema, the first line by which a file names it, and the schema as a file beside a definition.

The schemas are made of what the loaders ask for (``tests/support/schemas.py``), and a test holds them against these.
"""

import json
from importlib.resources import files
from pathlib import Path
from typing import Final

from trunnion.files import atomic_file

#: What there are schemas of.
KINDS: Final = ("machine", "control", "project", "tools", "impeller", "nodes", "batch")

#: How the titles of schemas begin.
_TITLE: Final = "Trunnion: "


def file_name(kind: str) -> str:
    """Return the name of the file of a schema."""
    return f"trunnion-{kind}.schema.json"


def schema_text(kind: str) -> str:
    """Return the schema of a kind of file, as JSON."""
    return files(__name__).joinpath(file_name(kind)).read_text(encoding="utf-8")


def first_line(kind: str) -> str:
    """Return the line by which a file names the schema beside it; editors look for it at the top."""
    return f"#:schema ./{file_name(kind)}\n"


def put_beside(definition: Path, kind: str) -> Path | None:
    """Write the schema of a kind into the folder of a definition, unless it is there.

    One of another version of Trunnion is replaced; a file that is no schema of Trunnion is left alone.

    Path or None  the file that was written

    Raises ``InputError`` if it cannot be written.
    """
    place, text = definition.parent / file_name(kind), schema_text(kind)
    try:
        there = place.read_text(encoding="utf-8")
    except FileNotFoundError:
        there = ""
    except (OSError, ValueError):
        return None  # what is there can neither be read nor be a schema
    if there == text or (there and not _is_ours(there)):
        return None
    with atomic_file(place) as sink:
        sink.write(text.encode())
    return place


def _is_ours(text: str) -> bool:
    try:
        found = json.loads(text)
    except ValueError:
        return False
    return isinstance(found, dict) and str(found.get("title", "")).startswith(_TITLE)
