"""What a project states: the options with keys of the commands that take projects, as they are declared."""

from typing import Final

from trunnion.jobs.registry import JOBS
from trunnion.options.groups import WORK_OFFSET
from trunnion.options.kinds import FileOut
from trunnion.options.option import Level, Option

#: Options of a simulation; the work offset is a setting of a post, and a simulation is judged by it.
_SIMULATED: Final = (*(each for each in JOBS["simulate"].flags if each.key and not each.own), WORK_OFFSET)

#: Those of the project as a whole, and those of set-ups.
OF_PROJECT: Final[tuple[Option, ...]] = tuple(each for each in _SIMULATED if each.level is Level.WHOLE)
OF_SETUP: Final[tuple[Option, ...]] = tuple(each for each in _SIMULATED if each.level is not Level.WHOLE)

#: Arguments that nothing else may state where a project has several set-ups.
OF_ONE_SETUP: Final = tuple(each.name for each in OF_SETUP if each.level is Level.OWN)

#: Options of a post that a set-up states for it alone, or for the simulation too; settings of the post.
_POSTED: Final = tuple(
    each for each in JOBS["post"].flags
    if each.key and each.level is not Level.WHOLE and not each.heading and not isinstance(each.kind, FileOut)
    and each.name not in ("machine", "settings")
)  # fmt: skip
POSTED: Final[tuple[Option, ...]] = tuple(each for each in _POSTED if not each.setting)
SETTINGS: Final[tuple[Option, ...]] = (
    *(each for each in _POSTED if each.setting),
    WORK_OFFSET.but(setting="work_offset"),
)

#: Options that only a post has.
_ONLY_POSTED: Final = tuple(each for each in POSTED if each.name not in {option.name for option in OF_SETUP})

#: Argument -> key that states it.
KEYS: Final = {"nc": "programs"} | {each.name: each.key for each in (*_SIMULATED, *_ONLY_POSTED)}

#: What is asked of each table of set-ups.
STATED: Final[tuple[Option, ...]] = (*OF_SETUP, *_ONLY_POSTED)
