"""Definitions written into a folder, and loaded from it."""

from pathlib import Path

from trunnion.definitions import (
    Table,
    load_table,
)


def written(folder: Path, name: str, text: str) -> Path:
    """Write a file and return its path."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def loaded(folder: Path, text: str, shelf: Path | None = None) -> Table:
    """Load a definition from text, with a library of its own."""
    shelf = shelf or folder / "shelf"
    shelf.mkdir(exist_ok=True)
    return load_table(written(folder, "mine.toml", text), shelf)


# Lines
