"""Reports of a verification: a page or data."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.jobs.inputs.input_files import verified_files
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import check_report_name
from trunnion.machines import Machine
from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.model.motion import Decision
from trunnion.records import dataclass
from trunnion.verification import Verification

if TYPE_CHECKING:  # imported where a program is simulated
    from trunnion.jobs.simulate.result import SimulationResult


@dataclass(frozen=True, slots=True, eq=False)
class OfPost:
    """What the report of a post has beside its proof: the decisions of the planner, and what a simulation found."""

    decisions: Sequence[Decision]
    simulation: "SimulationResult | None" = None


def write_post_report(verification: Verification, file: FilePath, of_post: OfPost | None, words: Words) -> None:
    """Write the report of a post, or without one of a verification, as ``write_report`` does."""
    place = check_report_name(file)
    with atomic_file(place, inputs=verified_files(verification)) as sink:
        add_report(verification, sink, place.name, of_post, words)


def write_report(
    result: "Verification | SimulationResult",
    file: FilePath,
    *,
    decisions: Sequence[Decision] = (),
    words: Words = LIBRARY,
) -> None:
    """Write a report: a page that works offline (``.html``), or data (``.json``).

    Parameters
    ----------
    result
        Of ``trunnion.verify`` or ``trunnion.post``, with its columns, or of ``trunnion.simulate``.
    file
        An older file is replaced when the new one is complete.
    decisions
        Of the planner, beside a verification.
    words
        The language of a page and what it calls settings: English, and the words of the library.

    Raises
    ------
    InputError
        When the name ends otherwise, the verification has no columns, the file cannot be written, or it is one that the
        result is about.
    """
    if isinstance(result, Verification):
        write_post_report(result, file, OfPost(decisions) if decisions else None, words)
        return
    from trunnion.jobs.simulate.report import write_simulation_report
    from trunnion.jobs.simulate.result import SimulationResult

    if not isinstance(result, SimulationResult):
        raise wrong_argument("result", result, phrase("give_result"))
    write_simulation_report(result, file, words=words)


def add_report(
    verification: Verification,
    sink: BinaryIO,
    name: str,
    of_post: OfPost | None,
    words: Words = LIBRARY,
) -> None:
    """Write a report of a post, or without one of a verification, into a file that appears later.

    Raises ``InputError`` when the verification has no columns.
    """
    if len(verification.seconds) != len(verification.run):
        raise InputError(Problem(name, 0, Wording("ARG130", "verified_without_columns")))
    from trunnion.reporting.content import collect_content  # most runs write no report
    from trunnion.reporting.plot_series import collect_series
    from trunnion.reporting.write import render_report

    content = None
    if of_post is not None and of_post.simulation is not None:
        from trunnion.jobs.simulate.report import simulation_content

        content = simulation_content(of_post.simulation)
        # How long it was computed differs each time, and the same post gives the same bytes.
        content = replace(content, data={key: value for key, value in content.data.items() if key != "seconds"})
    collected = collect_content(
        verification, decisions=() if of_post is None else of_post.decisions, simulation=content
    )
    collected = replace(collected, command="verify" if of_post is None else "post")
    sink.writelines(render_report(Path(name), collected, collect_series(verification), words))


def write_refusal(
    problems: Sequence[Problem], machine: Machine, program: str, place: Path, words: Words = LIBRARY
) -> None:
    """Write the report of a program that was refused before it was run; arguments as ``reporting`` has them."""
    from trunnion.reporting import write  # most runs are not refused

    write.write_refusal(problems, machine, program, place, words)
