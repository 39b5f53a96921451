"""Pages speak the language of who looks: nothing in their sources is said in English alone."""

import json
import re
import threading
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from string import Formatter
from types import SimpleNamespace
from typing import Any

import pytest
import uvicorn
from playwright.sync_api import Browser, Page

from tests.support.browser import PATIENCE, needs_browser
from tests.support.browser import browser as browser
from tests.support.locations import GOLDEN, ROOT
from trunnion import write_view
from trunnion.builder.fields import PAGES
from trunnion.builder.server import builder_application
from trunnion.builder.session import BuilderSession
from trunnion.jobs.observer import Observer
from trunnion.messages import LANGUAGES, catalogue, library_words
from trunnion.viewer.language import Speech, page_texts
from trunnion.viewer.serving import Access, take_port

PROGRAM = GOLDEN / "yl569" / "2_hub_rough.expected.mpf"
WEB = {page: ROOT / "src" / "trunnion" / page / "web" for page in ("viewer", "builder")}

#: Keys of the builder's page that answers of its server name.
FROM_SERVER = {"broken", "unclear", "name", "changed", "exists", "cannot", "homePage", "controlPage", *PAGES}

#: What is no word of a sentence: a font, keys of the keyboard, a question to the browser, classes, a state of checks.
NO_WORDS = {
    "(prefers-color-scheme: dark)", "not checked", "11px system-ui, sans-serif", "Home", "End", "Enter",
    "mark warn", "entry dashed",
}  # fmt: skip

#: Elements that a selector names.
TAGS = {"button", "input", "select", "summary", "textarea"}


def speaking(language: str) -> Observer:
    """Who asks for pages in a language."""
    asking = Observer()
    asking.words = library_words(language)
    return asking


def asked(header: str = "", lang: str = "") -> Any:
    """A request of a browser."""
    return SimpleNamespace(headers={"accept-language": header}, query_params={"lang": lang} if lang else {})


@pytest.mark.parametrize(
    ("header", "language"),
    [
        ("", "en"),
        ("zh-CN,zh;q=0.9,en;q=0.8", "zh"),
        ("de", "de"),
        ("fr-FR, fr;q=0.9, de;q=0.5, en;q=0.4", "de"),
        ("en;q=0.5,zh-Hans-CN;q=0.7", "zh"),
        ("zh;q=0, de;q=0.1", "de"),
        ("fr, ja", "en"),
        ("*", "en"),
        ("zh;q=nonsense, \x00, ;;;,de-AT", "de"),
        ("x," * 100_000 + "de", "en"),
    ],
)
def test_a_browser_gets_the_language_that_it_asks_for(header: str, language: str) -> None:
    assert Speech().to(asked(header)).language == language
    assert Speech(stated="zh").to(asked(header)).language == "zh"
    assert Speech(stated="zh").to(asked(header, "de")).language == "de"
    assert Speech(stated="zh").to(asked(header, "<script>")).language == "zh"


def scene_of(page: str) -> tuple[str, dict[str, str], dict[str, Any]]:
    """The language of a page, its texts and its data."""
    tag = re.search(r'<html lang="([\w-]+)"', page)
    found = {name: re.search(rf'id="{name}">([^<]*)<', page) for name in ("texts", "scene")}
    assert tag
    assert found["texts"]
    assert found["scene"]
    return tag[1], json.loads(found["texts"][1]), json.loads(found["scene"][1])


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_file_is_in_the_language_of_who_writes_it(language: str, tmp_path: Path) -> None:
    said = write_view(PROGRAM, machine="yl569", output=tmp_path / "view.html", observer=speaking(language))
    tag, texts, scene = scene_of((tmp_path / "view.html").read_text(encoding="utf-8"))
    assert tag == {"zh": "zh-Hans"}.get(language, language)
    assert texts == page_texts("viewer", language)
    assert scene["standing"] == said
    assert any("一" <= letter <= "鿿" for letter in said) == (language == "zh")


def test_a_served_page_and_its_answers_are_in_one_language(builder: str, tmp_path: Path) -> None:
    for header, tag in (("de-DE,en", "de"), ("zh-CN", "zh-Hans"), ("fr", "en")):
        request = urllib.request.Request(builder, headers={"Accept-Language": header})
        with urllib.request.urlopen(request) as answer:
            found, texts, start = scene_of(answer.read().decode())
        assert found == tag
        assert texts == page_texts("builder", start["language"])
    begun = BuilderSession(tmp_path).answer("begin", {"name": "x", "base": "yl569"}, library_words("zh"))
    assert begun is not None
    fields = [each for page in begun["pages"].values() for each in page]
    named = {each["key"]: each["name"] for each in fields}
    assert named["axis.kind"] == catalogue("zh", "builder")["fields"]["axis.kind"]["name"]


def sources(page: str) -> dict[str, str]:
    """The modules of a page and its body, without comments."""
    texts = {
        path.name: path.read_text(encoding="utf-8") for path in sorted(WEB[page].glob("*.*")) if path.suffix != ".css"
    }
    return {name: re.sub(r"/\*.*?\*/|(?m:^\s*//[^\n]*$)", "", text, flags=re.DOTALL) for name, text in texts.items()}


@pytest.mark.parametrize("page", WEB)
def test_each_text_of_a_page_is_used_and_each_that_is_used_is_there(page: str) -> None:
    known, text = set(page_texts(page, "en")), "\n".join(sources(page).values())
    named = set(re.findall(r'data-(?:say|label)="(\w+)"|\bsay\("(\w+)"', text))
    assert {one or other for one, other in named} <= known
    words = set(re.findall(r'"(\w+)"|\b(\w+):', text))
    assert known - {one for pair in words for one in pair} <= (FROM_SERVER if page == "builder" else set())


def literals(text: str) -> Iterator[str]:
    """Texts in the source of a module: quoted ones, and what stands around the values of templates.

    Errors that nothing but a fault of ours can throw are none.
    """
    text = re.sub(
        r"^import .*$|throw new Error\(.*$|/(?:[^/\n\\]|\\.)+/[a-z]*(?=[,)\].;])", "", text, flags=re.MULTILINE
    )
    for double, template in re.findall(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`', text):
        yield from [double] if double else re.split(r"\$\{[^}]*\}", template)


def is_said(text: str) -> bool:
    """Whether a text is words of a sentence, or a word with a capital; none is that names elements or keys."""
    if not re.search(r"[a-z]{2}[,;:.]? [a-z]{2}|^[A-Z][a-z]+[.:]? ?$", text) or text in NO_WORDS:
        return False
    return not re.search(r"[\[\]#=<>{}]", text) and not set(re.split(r",? ", text)) <= TAGS


@pytest.mark.parametrize("page", WEB)
def test_no_source_of_a_page_says_anything_itself(page: str) -> None:
    found = sources(page)
    body = re.sub(r"<kbd>.*?</kbd>|<option>[xyz]</option>", "", found.pop("body.html"))
    said = [each.strip() for each in re.findall(r">([^<]*[A-Za-z][^<]*)<", body)]
    said += re.findall(r'(?:title|alt|placeholder|aria-label|value)="([A-Z][a-z]+[^"]*|[^"]* [^"]*)"', body)
    assert said == []
    sentences = [f"{name}: {text}" for name, source in found.items() for text in literals(source) if is_said(text)]
    assert sentences == []


@pytest.mark.parametrize("page", WEB)
@pytest.mark.parametrize("language", LANGUAGES)
def test_values_of_texts_are_plain_or_counted(page: str, language: str) -> None:
    """The page fills in names and counts, and nothing else of what templates have."""
    for text in page_texts(page, language).values():
        for _, name, spec, conversion in Formatter().parse(text):
            assert not name or (name.isidentifier() and (not spec or "#" in spec) and conversion is None), text


@pytest.fixture
def builder(tmp_path: Path) -> Iterator[str]:
    listening = take_port("127.0.0.1", 0)
    application = builder_application(BuilderSession(tmp_path), Access(("127.0.0.1",)))
    server = uvicorn.Server(uvicorn.Config(application, log_level="critical"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://127.0.0.1:{listening.getsockname()[1]}/"
    server.should_exit = True
    thread.join()
    listening.close()


#: All that is read or heard on a page, but the program's text, names of the definition, and what it is made of.
_READ = """() => {
  const found = [];
  const aside = "#listing, #program, #text, #gutter, code, kbd, script, style, #begin-base, #begin-control, #title";
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) if (!walk.currentNode.parentElement.closest(aside)) found.push(walk.currentNode.textContent);
  for (const each of document.querySelectorAll("*")) if (!each.closest(aside))
    for (const name of ["title", "aria-label", "placeholder", "alt"]) found.push(each.getAttribute(name) ?? "");
  return found.map(text => text.trim()).filter(Boolean);
}"""


def english_of(page: str, language: str) -> set[str]:
    """English texts of a page that another language says otherwise."""
    english, other = page_texts(page, "en"), page_texts(page, language)
    tables = [catalogue(each, page).get("fields", {}) for each in ("en", language)]
    flat = [{(key, part): text for key, parts in table.items() for part, text in parts.items()} for table in tables]
    return {text for key, text in english.items() if other[key] != text} | {
        text for key, text in flat[0].items() if flat[1].get(key) != text
    }


#: Elements that are wider than the page, or whose text is cut; what scrolls, and the title with its dots, may be.
_CUT = """() => {
  const aside = "#listing, .listing, #program, #text, #gutter, #title, input, select, textarea, option, script, style";
  const wide = each => each.clientWidth && each.scrollWidth > each.clientWidth + 1;
  const cut = each => wide(each) && getComputedStyle(each).overflowX !== "auto";
  const found = Array.from(document.querySelectorAll("body *")).filter(each => !each.closest(aside)).filter(cut);
  if (document.documentElement.scrollWidth > innerWidth) found.push(document.body);
  return found.map(each => `${innerWidth} px: ${each.tagName} ${each.id} ${each.textContent.trim().slice(0, 40)}`);
}"""


def cut_texts(page: Page) -> list[str]:
    """What a page cuts off at the widths of a phone, a tablet, a laptop and a large screen."""
    found: list[str] = []
    for width, height in ((390, 844), (768, 1024), (1280, 720), (1920, 1080)):
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        found += page.evaluate(_CUT)
    return found


@needs_browser
@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_that_is_read_is_left_in_english_or_cut_off(
    language: str, builder: str, browser: Browser, tmp_path: Path
) -> None:
    write_view(PROGRAM, machine="yl569", output=tmp_path / "view.html", observer=speaking(language))
    page = browser.new_page(locale={"zh": "zh-CN"}.get(language, language))
    page.set_default_timeout(PATIENCE)
    page.goto((tmp_path / "view.html").as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")
    read = page.evaluate(_READ)
    assert len(read) > 80
    assert cut_texts(page) == []
    assert set(read) & english_of("viewer", language) == set()
    page.goto(builder)
    page.wait_for_selector("html[data-ready=true]", state="attached")
    page.locator("#begin-base").select_option("yl569")
    page.locator("#begin-go").click()
    page.wait_for_function("() => builder.data && document.getElementById('program').dataset.ready === 'true'")
    assert page.evaluate("document.documentElement.lang").startswith(language)
    assert cut_texts(page) == []
    for name in PAGES:
        page.locator(f"[data-page={name}]").click()
        assert set(page.evaluate(_READ)) & english_of("builder", language) == set()
    page.close()
