"""Words with a value that leave the programmed path as it is, and still move the tool elsewhere."""

from trunnion.messages import Wording
from trunnion.readers.families.sinumerik.block import Block
from trunnion.readers.families.sinumerik.expressions import ExpressionError, Value
from trunnion.readers.families.sinumerik.words import (
    FEED_RADIUS,
    GREATEST,
    ORIENTATION_TOLERANCE,
    OTHER_FEEDS,
    TOLERANCES,
    TOOL_DELTAS,
    WITHIN_COMPENSATION,
)


def keep_value(block: Block, name: str, value: Value) -> None:
    """Keep what such a word says.

    Raises ``ExpressionError`` if it changes the feed in a way that is not simulated, or is none of its values.
    """
    if name in TOOL_DELTAS:
        block.deltas[name] = as_number(value)
    elif name in TOLERANCES:
        block.tolerances.append(as_number(value))
    elif name in WITHIN_COMPENSATION and value != 0.0:
        block.words.append(name)
    elif name == FEED_RADIUS:
        block.feed_radius = as_number(value)
    elif name in OTHER_FEEDS and value != OTHER_FEEDS[name]:
        raise ExpressionError(Wording("NC220", "changes_feed_not_simulated", name=name))
    elif name in GREATEST and not 0.0 <= as_number(value) <= GREATEST[name]:
        raise ExpressionError(Wording("NC215", "tolerance_too_great", name=name, most=GREATEST[name]))
    elif name == ORIENTATION_TOLERANCE:
        block.orientation_tolerance = as_number(value)


def as_number(value: Value) -> float:
    """Return the number of a word; a text is an ``ExpressionError``."""
    if isinstance(value, str):
        raise ExpressionError(Wording("NC210", "text_for_number", value=value[:40]))
    return value
