"""What the documents link to is there, and they name nothing of one computer."""

import os
from pathlib import Path

from tests.support.locations import ROOT


def test_every_file_that_a_page_links_to_is_there() -> None:
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
    for page in pages:
        for part in page.read_text(encoding="utf-8").split("](")[1:]:
            link = part.split(")")[0].split("#")[0]
            if link and not link.startswith("http"):
                assert (page.parent / link).exists(), f"{page.relative_to(ROOT)} links to {link}"


def test_the_project_names_no_place_outside_itself() -> None:
    """No path of one machine gets into a page."""
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        assert str(Path.home()) + os.sep not in text
        assert str(ROOT) not in text
