"""The documentation site: guides in Markdown, reference from the docstrings. Built by ``python3 make.py docs``."""

import re

from sphinx.application import Sphinx

from trunnion import __version__

project = "Trunnion"
author = "The Trunnion authors"
release = version = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
exclude_patterns = ["decisions/_*"]
html_theme = "furo"
html_title = f"Trunnion {release}"
html_static_path: list[str] = []

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False

# A warning fails the build: every link inside the site must lead somewhere.
suppress_warnings: list[str] = []

#: A line of the tables in docstrings: names, at least two blanks, text. Lines that are indented further belong to it.
_ROW = re.compile(r"^\S+(?:, \S+)*(?: \([^)]*\))? {2,}\S")


def _keep_tables(app: object, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Show the aligned tables of docstrings as they are written."""
    inside = False
    shown: list[str] = []
    for line in lines:
        belongs = bool(_ROW.match(line)) or (inside and line.startswith("  "))
        if belongs and not inside:
            shown += ["", "::", ""]
        elif inside and not belongs:
            shown.append("")
        inside = belongs
        shown.append("    " + line if belongs else line)
    lines[:] = shown


def setup(app: Sphinx) -> None:
    """Set up the site, as Sphinx asks."""
    app.connect("autodoc-process-docstring", _keep_tables)
