"""The modules of our pages, checked by the TypeScript compiler: types are in JSDoc, those of texts in catalogues."""

import os
import re
import shutil
import subprocess
from pathlib import Path
from string import Formatter

import pytest

from tests.support.locations import ROOT
from trunnion.viewer.language import page_texts

COMPILER = shutil.which("tsc")

WEB = {page: ROOT / "src" / "trunnion" / page / "web" for page in ("viewer", "builder")}


def declarations(page: str) -> str:
    """What values each text of a page takes, as ``say`` wants them."""
    lines = []
    for key, text in page_texts(page, "en").items():
        names = sorted({name for _, name, _, _ in Formatter().parse(text) if name})
        values = "; ".join(f"{name}: string | number" for name in names)
        lines.append(f"  {key}: [{f'values: {{ {values} }}' if names else ''}];")
    plain = "{ [Key in keyof PageTexts]: PageTexts[Key] extends [] ? Key : never }[keyof PageTexts]"
    return "\n".join(["interface PageTexts {", *lines, "}", f"declare type PlainKey = {plain};", ""])


def compiled(page: str, folder: Path, *more: Path) -> str:
    """What the compiler says of the modules of a page; those of the other one have texts of their own."""
    texts = folder / "texts.d.ts"
    texts.write_text(declarations(page), encoding="utf-8")
    modules = [str(path) for path in (*sorted(WEB[page].glob("*.js")), *more)]
    command = [
        str(COMPILER), "--noEmit", "--allowJs", "--checkJs", "--strict", "--strictNullChecks", "false", "--target",
        "es2022", "--module", "es2022", "--moduleResolution", "node", "--lib", "es2022,dom,dom.iterable",
        str(WEB["viewer"] / "globals.d.ts"), str(texts), *modules,
    ]  # fmt: skip
    found = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    others = tuple(f"{each}/web/" for each in WEB if each != page)
    messages = re.split(r"\n(?! )", found.strip())  # lines that go on with a message are indented
    return "\n".join(each for each in messages if not any(other in each.splitlines()[0] for other in others if each))


needs_compiler = pytest.mark.skipif(
    not COMPILER and not os.environ.get("CI"), reason="there is no tsc (Debian package node-typescript)"
)


@needs_compiler
@pytest.mark.parametrize("page", WEB)
def test_every_call_fits_what_is_called(page: str, tmp_path: Path) -> None:
    assert compiled(page, tmp_path) == ""


@needs_compiler
def test_a_text_that_there_is_not_and_a_value_that_is_missing_are_found(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.js"
    calls = ['say("nothing")', 'say("stockEnds")', 'say("stockEnds", { lines: 1 })', 'say("stockEnds", { line: 1 })']
    head = f'import {{ say }} from "{(WEB["viewer"] / "texts.js").as_posix()}";'
    wrong.write_text("\n".join([head, *calls]), encoding="utf-8")
    found = compiled("viewer", tmp_path, wrong)
    assert [f"wrong.js({line}," in found for line in (2, 3, 4, 5)] == [True, True, True, False], found
