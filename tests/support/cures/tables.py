"""The tables of cures, by their names."""

from collections.abc import Mapping
from typing import Final

from tests.support.cures import (
    apt_files,
    cl_files,
    conversions,
    definitions,
    posts,
    programs,
    simulations,
    stated_words,
    stocks,
)
from tests.support.cures.cure import Cure

TABLES: Final[Mapping[str, tuple[Cure, ...]]] = {
    "apt_files": apt_files.CURES,
    "cl_files": cl_files.CURES,
    "conversions": conversions.CURES,
    "definitions": definitions.CURES,
    "posts": posts.CURES,
    "programs": programs.CURES,
    "simulations": simulations.CURES,
    "stated_words": stated_words.CURES,
    "stocks": stocks.CURES,
}
