"""The tables of cures, by their names."""

from collections.abc import Mapping
from typing import Final

from tests.support.cures import cl_files, conversions, definitions, posts, programs, stated_words, stocks
from tests.support.cures.cure import Cure

TABLES: Final[Mapping[str, tuple[Cure, ...]]] = {
    "cl_files": cl_files.CURES,
    "conversions": conversions.CURES,
    "definitions": definitions.CURES,
    "posts": posts.CURES,
    "programs": programs.CURES,
    "stated_words": stated_words.CURES,
    "stocks": stocks.CURES,
}
