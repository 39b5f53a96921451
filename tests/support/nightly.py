"""``python -m tests.support.nightly`` lists what ``make.py nightly`` has and ``make.py test`` has not."""

import sys
from contextlib import redirect_stdout

import pytest

from tests.support.examples import DRAWS, part_of

CAMPAIGNS = "python -m tests.fuzz.campaign every"


class Listing:
    """What pytest has collected."""

    lines: tuple[str, ...] = ()

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Keep what each item has in nightly alone."""
        self.lines = tuple(filter(None, map(only_nightly, session.items)))


def only_nightly(item: pytest.Item) -> str:
    """What an item has in nightly alone: itself, or draws; those of a property that says so are the same each time."""
    if item.get_closest_marker("hypothesis") is None or item.get_closest_marker("nightly") is not None:
        return item.nodeid
    settings = item.obj._hypothesis_internal_use_settings  # type: ignore[attr-defined]
    before = part_of(settings.max_examples, DRAWS["trunnion"])
    if settings.derandomize and before == settings.max_examples:
        return ""
    seeds = "" if settings.derandomize else ", from a fresh seed"
    return f"{item.nodeid}: {settings.max_examples} draws{seeds}; {before} in test"


def main() -> None:
    """Collect and list."""
    listing = Listing()
    with redirect_stdout(sys.stderr):
        code = pytest.main(["--nightly", "--collect-only", "-qq"], plugins=[listing])
    sys.stdout.write("".join(f"{line}\n" for line in (*listing.lines, CAMPAIGNS)))
    sys.exit(code)


if __name__ == "__main__":
    main()
