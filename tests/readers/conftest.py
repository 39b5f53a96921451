"""Programs as texts, run on a machine."""

from tests.support.reading import run as run
from tests.support.reading import yl569 as yl569
