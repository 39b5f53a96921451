"""The tables of cures, by the names of their modules: each module below this folder that has ``CURES``."""

from collections.abc import Mapping
from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from tests.support import cures
from tests.support.cures.cure import Cure


def _tables() -> dict[str, tuple[Cure, ...]]:
    rooms = sorted(room.name for room in iter_modules(cures.__path__) if room.ispkg)
    packages = [(room, import_module(f"{cures.__name__}.{room}")) for room in rooms]
    names = [f"{room}.{name}" for room, package in packages for _, name, _ in iter_modules(package.__path__)]
    modules = {name: import_module(f"{cures.__name__}.{name}") for name in names}
    return {name: tuple(module.CURES) for name, module in modules.items() if hasattr(module, "CURES")}


TABLES: Final[Mapping[str, tuple[Cure, ...]]] = _tables()
