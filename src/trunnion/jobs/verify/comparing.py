"""Comparison of two NC programs by what they make the tool do."""

import math
from dataclasses import replace
from functools import partial
from typing import Final, Unpack

from trunnion import readers
from trunnion.jit import compile_ahead
from trunnion.jobs.arguments import DiffArguments, taken
from trunnion.jobs.inputs.control_settings import (
    blocks_in_compensation,
    greatest_feed,
    rapid_feed_of,
    written_control,
)
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine
from trunnion.jobs.inputs.settings import check_tolerance
from trunnion.jobs.inputs.stated_words import refuse_settings, with_stated
from trunnion.jobs.verify.compared_programs import ComparedProgram, read_both
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.verification import restore_rapids
from trunnion.verification.comparison import Comparison, ControlRules, compare
from trunnion.verification.skip_meanings import other_meanings, words_of

#: How far tips may be apart, mm: the last digit of most programs; and that of programs in inches.
_DEFAULT_TOLERANCE: Final = 0.001
_INCH_TOLERANCE: Final = 0.0026

#: What a reader notes of words and values that were stated and that its program does not need.
_NOT_NEEDED: Final = "NC228"


def diff(
    first: FilePath | Run, second: FilePath | Run, *, machine: MachineLike, **given: Unpack[DiffArguments]
) -> Comparison:
    """Compare what two NC programs make the tool do, whatever their words.

    Parameters
    ----------
    first, second
        Programs: paths, or their runs (``trunnion.read_program``).
    machine
        The machine that runs the first program.
    to_machine
        The machine that runs the second one, if it is another.
    subprograms, to_subprograms
        Files of the subprograms that each program calls. No others are opened.
    tolerance
        How far tips may be apart, mm, and tool axes, degrees. The default is 0.0026 mm for tips if one of the programs
        is in inches: their last digit is 0.0001 inch.
    path
        Compare where the tool goes, and whether at rapid, but not feed, spindle, tool and coolant.
    zero, tool_length
        The workpiece zero in the machine frame and the tool length, mm, of programs that cut with rotary axes turned
        and without TCP; those that the head of such a program states come first.
    settings, assume
        Values of variables that the programs read and do not set, such as ``{"#100": 5}``, and what words do that
        the reader does not know, as for ``verify``.

    Returns
    -------
    Comparison
        ``same``; the first and the worst difference, with the blocks of both programs.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no reader knows a control. Also when one program cuts without TCP
        as the other does not, and the zero or the tool length that this depends on is unknown.

    Examples
    --------
    >>> import trunnion
    >>> program = "tests/golden/yl569/2_hub_rough.expected.mpf"
    >>> trunnion.diff(program, program, machine="yl569").same
    True
    """
    found = taken(DiffArguments, "diff", given)
    tolerance, to_machine = found["tolerance"], found["to_machine"]
    check_tolerance("tolerance", tolerance)
    one = as_machine(machine)
    two = one if to_machine is None else as_machine(to_machine, "to_machine")
    one, left = with_stated(one, found["settings"], found["assume"])
    two, of_two = (one, left) if to_machine is None else with_stated(two, found["settings"], found["assume"])
    refuse_settings([key for key in left if key in of_two], one, two)
    for each in (one, two):
        readers.reader_of(each)
    compile_ahead(readers.KERNELS)
    both = read_both(
        ComparedProgram(first, one, found["subprograms"], ("first", "subprograms")),
        ComparedProgram(second, two, found["to_subprograms"], ("second", "to_subprograms")),
        found["zero"], found["tool_length"],
    )  # fmt: skip
    runs = both.one, both.two
    coarse = tolerance == _DEFAULT_TOLERANCE and any(run.state.inches.values.any() for run in runs)
    limits = _INCH_TOLERANCE if coarse else tolerance
    rules = _rules(one), _rules(two)
    compared = partial(compare, tolerance=limits, axis_tolerance=tolerance, path=found["path"], rules=rules)
    result = compared(*runs)
    if not result.same:
        both.refuse_unknown()
    result = replace(result, not_needed=_not_needed(runs), stated=(*result.stated, *both.stands_on))
    for levels in other_meanings(*runs) if result.same else ():
        others = (_skipping(runs[0], levels), _skipping(runs[1], levels))
        other = compared(*others)
        if not other.same:
            other = replace(other, not_needed=result.not_needed, stated=result.stated)
            return other.within("with_meaning", meaning=words_of(levels, *runs))
    return result


def _rules(machine: Machine) -> ControlRules:
    """Return the rules of a machine's control."""
    feed = greatest_feed(written_control(machine))
    return ControlRules(blocks_in_compensation(machine), math.inf if feed is None else feed)


def _not_needed(runs: tuple[Run, Run]) -> tuple[str, ...]:
    """Return what was stated for both programs and neither needs."""
    one, two = ([each.wording for each in run.diagnostics if each.code == _NOT_NEEDED] for run in runs)
    words = [str(each.parameter("word")) for each in one if each in two]
    return tuple(dict.fromkeys(words))


def _skipping(run: Run, levels: frozenset[int]) -> Run:
    """Return the run of a program without its blocks of some levels; as it is where none of its blocks has them."""
    other = run.with_skips(levels)
    return run if other is run else restore_rapids(other, rapid_feed_of(run.machine))
