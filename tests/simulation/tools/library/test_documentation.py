"""The page of tool libraries: its samples are read, and it names every size."""

import re
from pathlib import Path

from tests.support.locations import TESTS
from trunnion.simulation.tools.library import read_tools
from trunnion.simulation.tools.shapes import ToolKind
from trunnion.simulation.tools.sizes import OF_BODY, OF_KIND
from trunnion.simulation.tools.text import parse_tool

PAGE = (TESTS.parent / "docs" / "tool-libraries.md").read_text(encoding="utf-8")


def test_the_library_of_the_page_is_one(tmp_path: Path) -> None:
    (sample,) = re.findall(r"^```toml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    file = tmp_path / "tools.toml"
    file.write_text(sample, encoding="utf-8")
    assert [tool.number for tool in read_tools(file).tools] == [3, 4]


def test_the_texts_of_the_page_are_tools() -> None:
    texts = re.findall(r"^\| `(\w+=\w+:[^`]+)` \|", PAGE, re.MULTILINE)
    shapes = [parse_tool(text) for text in texts]
    assert shapes[1].length == 140.0
    assert {text.partition("=")[2].partition(":")[0] for text in texts} == set(ToolKind)


def test_the_page_names_every_size_and_kind() -> None:
    sizes = {size for sizes in OF_KIND.values() for each in sizes for size in each} | set(OF_BODY)
    keys = {size + ("_deg" if size.endswith("angle") else "_mm") for size in sizes}
    assert [key for key in sorted(keys) if f"`{key}`" not in PAGE] == []
    assert [kind for kind in ToolKind if f"| `{kind}` |" not in PAGE] == []
