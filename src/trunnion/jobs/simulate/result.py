"""What a simulation found, as a record for scripts, data and reports."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from typing import Annotated, Any, ClassVar, Final

import numpy as np

from trunnion.errors import Problem, Severity
from trunnion.jobs.simulate.travel import ProgramTravel, judged_travel, travel_data
from trunnion.machines.unmeasured import POSITIONS, ValueKind, unmeasured_values
from trunnion.messages import LIBRARY, Wording, Words, joined, phrase
from trunnion.model.run_samples import joint_samples
from trunnion.records import dataclass
from trunnion.reporting.remarks import remark_data
from trunnion.results import NOT_DATA, CubicMillimetres, Degrees, Figure, Millimetres, to_data
from trunnion.simulation.setup_findings import AirCut, NearMiss, SimulatedOperation, SimulationFinding, setup_findings
from trunnion.simulation.simulator import Simulation
from trunnion.simulation.steps import CutSetup
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.tools.profile import ToolShape
from trunnion.verification import Verdict
from trunnion.verification.grounds import NO_GROUNDS, Grounded, Grounds, grounds_of, joined_grounds

#: Air cuts that are told, the longest ones.
_MOST_AIR: Final = 20


#: Why bodies of the machine were not checked, by the variants of ``SIM310`` that say so.
_WHY_NOT_CHECKED: Final = {
    "no_spindle_gauge": "gauge_point_unstated", "gauge_at_machine": "gauge_point_unstated_at_machine",
    "bodies_machine_not": "zero_or_length_unstated",
}  # fmt: skip

#: Remarks on what was not judged: the stock outside, where nobody knows the tool, blocks that are not simulated.
_NOT_JUDGED: Final = ("SIM131", "SIM143", "SIM146", "SIM162", "SIM310")

#: What data says of each of several set-ups.
_OF_SETUP: Final = (
    "name", "machine", "programs", "passed", "cells_mm", "removed_mm3", "left", "gouge", "turn_deg", "tilt_deg",
)  # fmt: skip


def _sentences(said: Iterable[Wording]) -> tuple[str, ...]:
    return tuple(map(str, said))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationResult(Grounded):
    """What a simulation found.

    programs   files, in their order
    machine    its key; of several set-ups their keys
    cell       width of the cells along X, Y and Z, mm
    accuracy   how far motions and tools are off at most, mm; across a ray another 0.41 cells
    limit      what is no deeper than this is not told, mm
    removed    mm³ of the stock
    operations consecutive blocks with one tool, ``SimulatedOperation``
    findings   what must not be, ``SimulationFinding``; in the data they are ``collisions``
    near       bodies that come near each other, ``NearMiss``
    air        the longest air cuts, ``AirCut``
    left       what the stock has beyond the part; None without a part. ``volume`` in mm³, ``largest`` in mm, places,
               each ``at`` (mm) and its ``thickness``
    gouge      what of the part is missing; None without a part. Both are those of the last set-up
    remarks    what was not simulated, or was taken for granted
    seconds    of computing
    cuts_unknown  why it is not known what is cut under radius compensation; empty: it is
    grounds    what it stands on besides the programs
    bodies_on  values of the definition that the distances of bodies stand on, though nobody has measured them
    has_bodies  whether the definition of the machine states bodies
    simulation  that of the last set-up: ``simulation.stock`` is the finished stock
    skip_meanings  which blocks were skipped (``/``) in further runs: what these found is among the findings; none
               where no block may be skipped. All other figures but ``gouge``, the worst, are those with none skipped
    travel     of each program, as ``trunnion verify`` judges it
    setup      its name, where this is one of several
    setups     the results of each, where there are several
    stock_from  the CL file that states the stock; empty where it was given
    tools      their bodies by the words of the program; of several set-ups those of the last
    pairs      of bodies that were checked against each other, of all programs
    turn, tilt of the part as it is clamped, degrees; all places are those of the part as it is drawn. Of several
               set-ups those of the last one
    """

    SCHEMA: ClassVar[int] = 2
    DECIMALS: ClassVar[int] = 6

    programs: tuple[str, ...]
    machine: str
    turn: Degrees = 0.0
    tilt: Degrees = 0.0
    cell: Annotated[tuple[float, float, float], Figure("cell", unit="mm", take=max), Figure("cells", unit="mm")]
    accuracy: Millimetres
    limit: Millimetres
    removed: CubicMillimetres
    left: Excess | None
    gouge: Excess | None
    pairs: Annotated[int, Figure("pairs_checked")] = 0
    setups: Annotated[tuple["SimulationResult", ...], Figure(take=partial(to_data, only=_OF_SETUP))] = ()
    findings: Annotated[tuple[SimulationFinding, ...], Figure("collisions")]
    near: tuple[NearMiss, ...]
    air: tuple[AirCut, ...]
    operations: tuple[SimulatedOperation, ...]
    remarks: Annotated[tuple[Problem, ...], NOT_DATA]
    seconds: float
    simulation: Annotated[Simulation, NOT_DATA]
    setup: Annotated[str, Figure("name", is_extra=True)] = ""
    cuts_unknown: Annotated[tuple[Wording, ...], Figure("cuts_not_checked", after="remarks", take=_sentences)] = ()
    skip_meanings: Annotated[tuple[Wording, ...], Figure("meanings", after="remarks", take=_sentences)] = ()
    grounds: Annotated[Grounds, Figure(is_flat=True, after="remarks")] = NO_GROUNDS
    bodies_on: Annotated[tuple[Wording, ...], NOT_DATA] = ()
    has_bodies: Annotated[bool, NOT_DATA] = True
    travel: Annotated[tuple[ProgramTravel, ...], Figure(take=travel_data, after="remarks")] = ()
    stock_from: Annotated[str, Figure(after="remarks")] = ""
    tools: Annotated[Mapping[str, ToolShape], NOT_DATA] = field(default_factory=dict)

    @property
    @Figure(after="remarks")
    def not_checked(self) -> tuple[str, ...]:
        """Why collisions with the machine were not checked, in words; empty: they were."""
        return _sentences(self.collisions_unknown)

    @property
    def cuts_not_checked(self) -> tuple[str, ...]:
        """Why it is not known what is cut under radius compensation, in words; empty: it is."""
        return _sentences(self.cuts_unknown)

    @property
    def meanings(self) -> tuple[str, ...]:
        """Which blocks were skipped in further runs, in words."""
        return _sentences(self.skip_meanings)

    @property
    def collisions_unknown(self) -> tuple[Wording, ...]:
        """Why collisions with the machine were not checked."""
        variants = [each.wording.variant for each in self.remarks if each.code == "SIM310"]
        why = dict.fromkeys(_WHY_NOT_CHECKED[each] for each in variants if each in _WHY_NOT_CHECKED)
        return (*map(phrase, why), *(() if self.has_bodies else (phrase("no_machine_bodies"),)))

    @property
    def outcome(self) -> Verdict:
        """``PASSED`` only where all that can be judged was."""
        if not self.passed:
            return Verdict.FAILED
        return Verdict.IN_PART if self.not_judged else Verdict.PASSED

    def line(self, words: Words = LIBRARY) -> str:
        """Return the last line that is said of a simulation, in the language of who asks."""
        verdict = phrase("said_of", name=phrase(self.outcome.value), what=self.said_verdict(words))
        return verdict.text("what", words)

    @property
    def told(self) -> str:
        """The last line that is said of a simulation."""
        return self.line()

    def said_verdict(self, words: Words = LIBRARY) -> str:
        """Return what was found, and what nothing was found of because nobody could check it."""
        meanings = () if self.meanings_said is None else (self.meanings_said,)
        return joined((self._found_said(), *meanings, *self.not_judged, *self.grounds.wordings()), words)

    def _found_said(self) -> Wording:
        rubs = sum(each.rubs for each in self.near)
        rubbing = phrase("rubs_counted", count=rubs)
        if self.passed:
            return phrase("nothing_but_rubs", rubs=rubbing) if rubs else phrase("nothing_found")
        errors = sum(remark.severity is Severity.ERROR for remark in self.remarks)
        beyond = sum(not each.check.passed for each in self.travel)
        parts = (
            phrase("findings_counted", count=len(self.findings)),
            *([phrase("errors_counted", count=errors)] if errors else []),
            *([phrase("programs_beyond", count=beyond)] if beyond else []),
            *([rubbing] if rubs else []),
        )
        return phrase("must_not_run", found=parts)

    @property
    def verdict(self) -> str:
        """What was found, and what nothing was found of because nobody could check it."""
        return self.said_verdict()

    @property
    def cuts_said(self) -> Wording | None:
        """That it is not known what is cut under radius compensation, and why; None: it is."""
        return phrase("cuts_not_checked", why=self.cuts_unknown) if self.cuts_unknown else None

    @property
    def meanings_said(self) -> Wording | None:
        """In which meanings of blocks that may be skipped it was simulated; None: there are none."""
        return phrase("simulated_with_skipped", meanings=self.skip_meanings) if self.skip_meanings else None

    @property
    def stock_said(self) -> Wording | None:
        """That the stock is that of a CL file; None: it was given."""
        return phrase("stock_of_cl_file", file=self.stock_from) if self.stock_from else None

    @property
    def collisions_said(self) -> Wording | None:
        """That collisions with the machine were not checked, and why; None: they were."""
        return phrase("collisions_not_checked", why=self.collisions_unknown) if self.collisions_unknown else None

    @property
    def not_judged(self) -> tuple[Wording, ...]:
        """What was not checked, and why."""
        codes = dict.fromkeys(each.code for each in self.remarks if each.code in _NOT_JUDGED)
        if self.not_checked:
            codes.pop("SIM310", None)
        others = phrase("not_all_judged", codes=tuple(codes)) if codes else None
        travel = dict.fromkeys(why for each in self.travel for why in each.check.missing if each.check.passed)
        axes = phrase("travel_not_checked", why=tuple(travel)) if travel else None
        return tuple(each for each in (self.cuts_said, self.collisions_said, axes, others) if each is not None)

    @property
    @Figure("remarks", after="operations")
    def remarks_of_setups(self) -> list[dict[str, Any]]:
        """The remarks as data, each thing once with its count, and the names of their set-ups."""
        parts = self.setups or (self,)
        return [{**each, "setup": part.setup or None} for part in parts for each in remark_data(part.remarks)]

    @property
    @Figure(after="schema")
    def passed(self) -> bool:
        """Whether nothing was found that must not be: no finding, no gouge, no program that breaks off."""
        if self.setups:
            return all(each.passed for each in self.setups)
        broken = any(remark.severity is Severity.ERROR for remark in self.remarks)
        gouged = self.gouge is not None and self.gouge.largest > self.limit
        beyond = not all(each.check.passed for each in self.travel)
        return not self.findings and not gouged and not broken and not beyond


def make_result(cut: CutSetup) -> SimulationResult:
    """Return the result of a set-up."""
    found, own, programs = cut.simulation, setup_findings(cut), cut.programs
    travel = tuple(judged_travel(cut.setup.runs, cut.setup.register_holds))
    on_bodies = _unmeasured(cut, *POSITIONS, ValueKind.BODIES) if cut.pairs else ()
    on_travel = (value for each in travel for value in each.check.stands_on)
    x, y, z = found.stock.lattice.cell.tolist()
    return SimulationResult(
        programs=tuple(program.run.files[0] for program in programs),
        machine=cut.setup.machine.key,
        turn=cut.setup.clamping.turn,
        tilt=cut.setup.clamping.tilt,
        cell=(x, y, z),
        accuracy=found.model.tolerance + found.error,
        limit=found.model.limit,
        removed=found.start_volume - found.stock.volume,
        left=found.left,
        gouge=found.gouge,
        pairs=cut.pairs,
        findings=own.findings,
        near=own.near,
        air=_longest(own.air),
        operations=own.operations,
        remarks=cut.remarks,
        seconds=found.seconds,
        simulation=found,
        setup=cut.setup.name,
        grounds=grounds_of(cut.setup.runs, (*_unmeasured(cut, ValueKind.ANGLES), *on_bodies, *on_travel)),
        bodies_on=tuple(on_bodies),
        has_bodies=bool(cut.setup.machine.bodies),
        cuts_unknown=tuple(cut.setup.missing()),
        travel=travel,
        tools=cut.setup.tools,
    )


def _unmeasured(cut: CutSetup, *kinds: ValueKind) -> tuple[Wording, ...]:
    """Return the values of some kinds that nobody has measured, and that matter to the programs."""
    joints = [joint_samples(run) for run in cut.setup.runs]
    if not joints:
        return ()
    values = unmeasured_values(cut.setup.machine, kinds, np.concatenate(joints))
    return tuple(value.said for value in values)


def bodies_stand_lines(found: SimulationResult, words: Words = LIBRARY) -> Iterator[str]:
    """Yield what distances of bodies stand on though nobody has measured it; nothing where there is none."""
    if found.bodies_on:
        stands = phrase("stands_on", values=found.bodies_on)
        yield phrase("distances_stand_on", stands=stands).text("what", words)


def travel_lines(found: SimulationResult, words: Words = LIBRARY) -> Iterator[str]:
    """Yield what was found of the travel of the axes in each program."""
    for each in found.travel:
        yield from each.lines(words)


def join_results(results: Sequence[SimulationResult]) -> SimulationResult:
    """Return the results of set-ups in their order as one; a single one stays as it is."""
    last = results[-1]
    if len(results) == 1:
        return last
    return replace(
        last,
        programs=tuple(program for each in results for program in each.programs),
        machine=", ".join(dict.fromkeys(each.machine for each in results)),
        cell=max((each.cell for each in results), key=max),
        accuracy=max(each.accuracy for each in results),
        limit=max(each.limit for each in results),
        removed=sum(each.removed for each in results),
        operations=tuple(one for each in results for one in each.operations),
        findings=tuple(one for each in results for one in each.findings),
        near=tuple(one for each in results for one in each.near),
        air=_longest([one for each in results for one in each.air]),
        remarks=tuple(one for each in results for one in each.remarks),
        seconds=sum(each.seconds for each in results),
        setup="",
        setups=tuple(results),
        pairs=sum(each.pairs for each in results),
        grounds=joined_grounds(each.grounds for each in results),
        bodies_on=tuple(dict.fromkeys(value for each in results for value in each.bodies_on)),
        has_bodies=all(each.has_bodies for each in results),
        travel=tuple(one for each in results for one in each.travel),
        cuts_unknown=tuple(dict.fromkeys(why for each in results for why in each.cuts_unknown)),
    )


def _longest(air: Iterable[AirCut]) -> tuple[AirCut, ...]:
    return tuple(sorted(air, key=lambda each: -each.length)[:_MOST_AIR])
