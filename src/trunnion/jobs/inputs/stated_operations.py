"""What settings state of single operations: open cycles, compensation, speeds, feeds, rapids."""

from collections.abc import Iterable, Mapping

from trunnion.jobs.inputs.stated_compensation import with_stated_compensation
from trunnion.jobs.inputs.stated_cycles import check_stated_cycles
from trunnion.jobs.inputs.stated_feeds import with_stated_feeds
from trunnion.jobs.inputs.stated_rapids import with_stated_rapids
from trunnion.jobs.inputs.stated_speeds import with_stated_speeds
from trunnion.model.toolpath import Toolpath


def with_stated_operations(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Return toolpaths with the speeds, feeds and rapids that settings state, and without CUTCOM where they leave it
    out; the reader knows what they state of cycles.

    Raises ``InputError`` for an operation that is not there, or of which nothing is to be stated.
    """
    found = with_stated_rapids(toolpaths, settings)
    check_stated_cycles(found, settings)
    return with_stated_feeds(with_stated_speeds(with_stated_compensation(found, settings), settings), settings)
