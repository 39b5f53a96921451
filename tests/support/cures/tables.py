"""The tables of cures, by their names."""

from collections.abc import Mapping
from typing import Final

from tests.support.cures import (
    apt_files,
    cl_files,
    cl_tools,
    conversions,
    definitions,
    meshes,
    posts,
    programs,
    simulations,
    stated_words,
    stocks,
    tool_libraries,
    tool_words,
)
from tests.support.cures.cure import Cure

TABLES: Final[Mapping[str, tuple[Cure, ...]]] = {
    "apt_files": apt_files.CURES,
    "cl_files": cl_files.CURES,
    "cl_tools": cl_tools.CURES,
    "conversions": conversions.CURES,
    "definitions": definitions.CURES,
    "meshes": meshes.CURES,
    "posts": posts.CURES,
    "programs": programs.CURES,
    "simulations": simulations.CURES,
    "stated_words": stated_words.CURES,
    "stocks": stocks.CURES,
    "tool_libraries": tool_libraries.CURES,
    "tool_words": tool_words.CURES,
}
