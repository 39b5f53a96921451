"""CL files of commands that hand them on: as they are named, or read as the options of reading say."""

from collections.abc import Iterable
from typing import BinaryIO, Final

from trunnion.cl.read import ClReading
from trunnion.cli.terminal import Terminal
from trunnion.jobs.inputs.reading import read_toolpaths
from trunnion.jobs.job import Given, streams
from trunnion.model.toolpath import Toolpath

#: How CL files are read, and the settings that say so.
_SETTINGS: Final = (("units", "cl_units"), ("dialect", "dialect"))


def as_read(given: Given, files: Iterable[str]) -> list[str | BinaryIO | Toolpath]:
    """CL files as the library takes them: their toolpaths, where it is said how they are read.

    Raises ``InputError`` if stdin is named twice, or a file cannot be read so.
    """
    inputs = streams(files)
    stated = {name: given.values[name] for name in ("units", "dialect") if not _is_setting(given, name)}
    if not given.strict and not any(stated.values()):
        return list(inputs)
    units, dialect = (stated.get(name) or dict(given.values.get("settings", ())).get(key) for name, key in _SETTINGS)
    return list(read_toolpaths(inputs, Terminal(), ClReading(units, dialect, given.strict)))


def _is_setting(given: Given, name: str) -> bool:
    option = given.job.option(name)
    return option is not None and bool(option.setting)
