"""The version of the package, which whatever is written names."""

from typing import Final

__version__: Final = "0.1.0"
