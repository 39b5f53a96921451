"""What an answer about programs stands on besides their blocks: one record, from which every command says it.

In:     runs, and the values of their machine that nobody has measured and that the answer stands on.
Out:    ``Grounds``, as data and in words.
"""

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Annotated, Final

from trunnion.messages import Wording, phrase, texts
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.results import Figure
from trunnion.verification.axes_from_home import axes_from_home
from trunnion.verification.basis import assumed_modes, stated_texts, turns_before_offset


@dataclass(frozen=True, slots=True)
class Grounds:
    """What nobody has measured, what is assumed, and what was stated.

    unmeasured    values of the definition that it stands on although nobody has measured them
    assumed       modes that the control is taken to start with: neither the program nor the definition states them
    stated        words and variables that the program relies on, with what somebody has stated of them
    turns_before_offset  the block that turns rotary axes before a work offset is selected: none is taken to be in force
    axes_from_home  the axes that the first cut takes to be at home: nothing states them before it
    """

    unmeasured: Annotated[tuple[Wording, ...], Figure("not_measured", take=texts)] = ()
    assumed: tuple[str, ...] = ()
    stated: Annotated[tuple[str, ...], Figure(is_optional=True, none=())] = ()
    turns_before_offset: str = ""
    axes_from_home: Annotated[str, Figure(is_optional=True, none="")] = ""

    @property
    def not_measured(self) -> tuple[str, ...]:
        """The values that nobody has measured, in words."""
        return texts(self.unmeasured)

    def wordings(self, *, named: bool = False) -> Iterator[Wording]:
        """Yield what is said of it; nothing where it stands on the program and measured values alone.

        named  the values that nobody has measured are named; else they are counted
        """
        if self.unmeasured and named:
            yield phrase("stands_on", values=self.unmeasured)
        elif self.unmeasured:
            yield phrase("standing_not_measured", count=len(self.unmeasured))
        if self.stated:
            yield phrase("stands_on_stated", words=self.stated)
        if self.assumed:
            yield phrase("assumed_modes", words=self.assumed)
        if self.turns_before_offset:
            yield phrase("assumed_offset", block=self.turns_before_offset)
        if self.axes_from_home:
            yield phrase("assumed_home", axes=self.axes_from_home)


#: What stands on the program and measured values alone.
NO_GROUNDS: Final = Grounds()


class Grounded:
    """An answer that stands on something: its record has the field ``grounds``."""

    __slots__ = ()

    grounds: Grounds

    @property
    def not_measured(self) -> tuple[str, ...]:
        """Values of the definition that it stands on although nobody has measured them."""
        return self.grounds.not_measured

    @property
    def assumed(self) -> tuple[str, ...]:
        """Modes that the control is taken to start with: neither the program nor the definition states them."""
        return self.grounds.assumed

    @property
    def stated(self) -> tuple[str, ...]:
        """Words and variables that the program relies on, with what somebody has stated of them."""
        return self.grounds.stated

    @property
    def turns_before_offset(self) -> str:
        """The block that turns rotary axes before a work offset is selected: none is taken to be in force."""
        return self.grounds.turns_before_offset

    @property
    def axes_from_home(self) -> str:
        """The axes that the first cut takes to be at home: nothing states them before it."""
        return self.grounds.axes_from_home


def grounds_of(runs: Iterable[Run], unmeasured: Iterable[Wording] = ()) -> Grounds:
    """Return what an answer about some programs stands on; ``unmeasured`` are the values that count for it."""
    programs = tuple(runs)
    return Grounds(
        unmeasured=tuple(dict.fromkeys(unmeasured)),
        assumed=_every(map(assumed_modes, programs)),
        stated=_every(map(stated_texts, programs)),
        turns_before_offset=_listed(str(turns_before_offset(run) or "") for run in programs),
        axes_from_home=_listed(str(axes_from_home(run) or "") for run in programs),
    )


def joined_grounds(parts: Iterable[Grounds]) -> Grounds:
    """Return the grounds of several answers as those of one."""
    answers = tuple(parts)
    return Grounds(
        unmeasured=tuple(dict.fromkeys(chain.from_iterable(each.unmeasured for each in answers))),
        assumed=_every(each.assumed for each in answers),
        stated=_every(each.stated for each in answers),
        turns_before_offset=_listed(each.turns_before_offset for each in answers),
        axes_from_home=_listed(each.axes_from_home for each in answers),
    )


def _every(found: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(chain.from_iterable(found)))


def _listed(found: Iterable[str]) -> str:
    return ", ".join(dict.fromkeys(filter(None, found)))
