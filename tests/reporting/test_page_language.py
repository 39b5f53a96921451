"""Pages are in the language of who asks, and the data of a report is the same whoever asks."""

import json
import re
from pathlib import Path

import pytest

from tests.support.reports import blade
from trunnion.messages import LIBRARY, Words, catalogue
from trunnion.reporting.content import collect_content
from trunnion.reporting.plot_series import collect_series
from trunnion.reporting.write import render_report


class Spoken(Words):
    def __init__(self, language: str) -> None:
        self.language = language


def page(words: Words, name: str = "x.html") -> str:
    content, series = collect_content(blade()), collect_series(blade())
    return b"".join(render_report(Path(name), content, series, words)).decode()


def shown(text: str) -> str:
    """What a reader sees, without scripts and tags."""
    body = re.sub(r"<script.*?</script>", "", text[text.index("<body>") :], flags=re.DOTALL)
    return re.sub(r"<[^>]+>", "\n", body)


@pytest.mark.parametrize(("language", "tag"), [("zh", "zh-CN"), ("de", "de")])
def test_a_report_has_no_english_of_its_own(language: str, tag: str) -> None:
    text = page(Spoken(language))
    assert f'<html lang="{tag}">' in text
    seen = set(filter(None, map(str.strip, shown(text).split("\n"))))
    known, said = (catalogue(each, "report")["report"] for each in ("en", language))
    english = {entry["what"] for name, entry in known.items() if entry["what"] != said[name]["what"]}
    alike = {entry["what"] for entry in said.values()}
    assert not seen & (english - alike)
    assert said["checks"]["what"] in seen
    specification = json.loads(re.search(r'id="report">(.*?)</script>', text, re.DOTALL)[1])  # type: ignore[index]
    assert specification["words"]["held"] == said["plot_held"]["what"]


def test_a_page_of_the_library_is_english_also_behind_one_that_is_not() -> None:
    before = page(LIBRARY)
    page(Spoken("zh"))
    assert page(LIBRARY) == before
    assert '<html lang="en">' in before


def test_data_is_the_same_in_every_language() -> None:
    assert page(Spoken("zh"), "x.json") == page(LIBRARY, "x.json")
