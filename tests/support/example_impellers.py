"""Impellers for the tests of their solids: the shipped examples with changes."""

import shutil
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "impeller"


def changed(folder: Path, example: str, *changes: tuple[str, str]) -> Path:
    """A definition of an example without its operations, with texts replaced, and its points beside it."""
    text = (EXAMPLES / f"{example}.toml").read_text("utf-8")
    text = text[: text.index("[[tool]]")]
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    for points in EXAMPLES.glob("*.csv"):
        shutil.copy(points, folder)
    (folder / "part.toml").write_text(text, "utf-8")
    return folder / "part.toml"
