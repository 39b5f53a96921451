"""What a comparison must know of a control besides what its reader knows."""

import math
import sys
from typing import Final

from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ControlRules:
    """Rules of a control.

    blocks     across how many blocks without motion it finds the next corner within radius compensation
    most_feed  the largest F that it takes, mm/min: no block need be faster
    """

    blocks: int = sys.maxsize
    most_feed: float = math.inf


#: A control that takes anything.
ANY_RULES: Final = ControlRules()
