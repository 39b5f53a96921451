"""The modules of our pages, checked by the TypeScript compiler: JSDoc has their types."""

import os
import shutil
import subprocess

import pytest

from tests.support.locations import ROOT

COMPILER = shutil.which("tsc")

PAGES = [ROOT / "src" / "trunnion" / name / "web" for name in ("viewer", "builder")]


@pytest.mark.skipif(
    not COMPILER and not os.environ.get("CI"), reason="there is no tsc (Debian package node-typescript)"
)
def test_every_call_fits_what_is_called() -> None:
    modules = [str(path) for folder in PAGES for path in sorted(folder.glob("*.js"))]
    command = [
        str(COMPILER), "--noEmit", "--allowJs", "--checkJs", "--strict", "--strictNullChecks", "false", "--target",
        "es2022", "--module", "es2022", "--moduleResolution", "node", "--lib", "es2022,dom,dom.iterable",
        str(PAGES[0] / "globals.d.ts"), *modules,
    ]  # fmt: skip
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.stdout == ""
    assert found.returncode == 0
