"""The documentation site: guides in Markdown, reference from the docstrings. Built by ``python3 make.py docs``."""

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
