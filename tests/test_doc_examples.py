"""What the documents show is run."""

import doctest
import re
import shutil
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN, TESTS, YL569
from trunnion.cli import main

ROOT = TESTS.parent

#: Pages with blocks of Python that are run as they stand; the tour is a doctest.
PAGES_WITH_CODE = sorted(
    page.relative_to(ROOT).as_posix()
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    if "```python" in page.read_text(encoding="utf-8") and page.name != "tour.md"
)


@pytest.fixture(scope="module")
def folder_of_examples(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that the pages name: those of the checkout, and ``part`` as CL file and as programs."""
    folder = tmp_path_factory.mktemp("examples")
    shutil.copytree(YL569, folder / "tests" / "golden" / "yl569")
    shutil.copy(YL569 / "3_blade_finish.cls", folder / "part.cls")
    shutil.copy(GOLDEN / "linuxcnc" / "blade.expected.ngc", folder / "part.ngc")
    for machine, program in (("yl569", "part.mpf"), ("dmu65", "part.h")):
        trunnion.post(folder / "part.cls", machine=machine, output=folder / program)
    return folder


@pytest.mark.parametrize("page", PAGES_WITH_CODE)
def test_the_python_of_a_page_runs(
    page: str, folder_of_examples: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder_of_examples)
    text = (ROOT / page).read_text(encoding="utf-8")
    for block in re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        assert "from trunnion" not in block, "the page shows what the library does not offer"
        exec(compile(block, page, "exec"), {"__name__": "page"})
    shown = re.findall(r"^[a-z]+ +(?:ok  |FAIL)  .+$", text, re.MULTILINE)
    printed = capsys.readouterr().out.splitlines()
    for line in shown:
        beginning = line.removesuffix("…")
        assert any(each == line or (line.endswith("…") and each.startswith(beginning)) for each in printed), line
    assert shown or page != "README.md"


@pytest.mark.parametrize("asked", ["--plot placing.svg", pytest.param("--goal collisions", marks=pytest.mark.nightly)])
def test_the_samples_of_placing_are_what_is_printed(
    asked: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Word for word; the ends of boxes and regions within what their search leaves open."""
    monkeypatch.chdir(ROOT)
    blocks = re.findall(r"^```\n(.*?)^```", (ROOT / "docs" / "placing.md").read_text(encoding="utf-8"), re.M | re.S)
    at = next(k for k, block in enumerate(blocks) if block.startswith("trunnion place ") and asked in block)
    command, printed = blocks[at].replace("\\\n", " ").split(), blocks[at + 1]
    assert main([str(tmp_path / word) if word.endswith(".svg") else word for word in command[1:]]) == 0
    out, number = capsys.readouterr().out, re.compile(r"-?\d+\.\d{3}")
    assert number.sub("#", out) == number.sub("#", printed)
    numbers = [[float(each) for each in number.findall(text)] for text in (out, printed)]
    assert numbers[0] == pytest.approx(numbers[1], abs=0.02)


@pytest.mark.parametrize("page", ["docs/tour.md"])
def test_the_snippets_of_the_page_do_what_it_says(page: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    result = doctest.testfile(str(ROOT / page), module_relative=False, encoding="utf-8")
    assert result.attempted > 0
    assert result.failed == 0
