"""What the documents show is run."""

import doctest
import os
from pathlib import Path

import pytest

from tests.support.locations import TESTS

ROOT = TESTS.parent


@pytest.mark.parametrize("page", ["docs/tour.md"])
def test_the_snippets_of_the_page_do_what_it_says(page: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    result = doctest.testfile(str(ROOT / page), module_relative=False, encoding="utf-8")
    assert result.attempted > 0
    assert result.failed == 0


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
