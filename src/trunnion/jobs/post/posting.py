"""Posting: toolpaths to one proven NC program.

In:     toolpaths, a machine, settings.
Out:    the program: planned, written, read back, run and compared with its toolpaths. A program that fails is not
        written unless it is forced.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final, Unpack

from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.files import OutputGroup, file_on_disk
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.arguments import PostArguments, reported_by_arguments, taken
from trunnion.jobs.inputs.arguments import check_observer, check_paths, checked_angles, no_mapping, wrong_argument
from trunnion.jobs.inputs.hooked import loaded_hooks
from trunnion.jobs.inputs.input_files import cl_files, machine_files
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike, as_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.left_over_files import kept_files, left_over
from trunnion.jobs.post.machining_times import new_time_token, prints_times, write_times
from trunnion.jobs.post.papers.writing import PostPapers, post_papers
from trunnion.jobs.post.planning import load_toolpaths, new_problems, plan_program
from trunnion.jobs.post.post_job import PostJob, prepare
from trunnion.jobs.post.program_places import ProgramPlaces
from trunnion.jobs.post.proving import prove, report_proof
from trunnion.jobs.post.reading import as_clamped
from trunnion.jobs.post.refusals import refused, reported_refusals
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post.stages import PlannedProgram, Posting, WrittenProgram
from trunnion.jobs.post.writing import write_and_read_back
from trunnion.jobs.result_output import Target, open_target, paper_files
from trunnion.machines.loading import DEMANDS
from trunnion.messages import phrase
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.records import dataclass

if TYPE_CHECKING:  # imported where stock is known
    from pathlib import Path

    from trunnion.simulation.meshes import TriangleMesh

#: What ``sheet_tools`` may have.
_SHEET_TOOLS: Final = ("tools", "tool_libraries", "unit")


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """The work that a post is part of.

    others     its other files, none of which is written over
    group      with whose files the program appears; None: alone
    is_placed  the head of the program says how the part is clamped, even if that is as it is drawn
    can_force  whether refusals speak of ``force``
    later      takes the papers, and who gives it writes them; None: they are written
    stock      of the part as it is drawn, where nothing has cut it; None: it is not known
    """

    others: Sequence[FilePath] = ()
    group: OutputGroup | None = None
    is_placed: bool = False
    can_force: bool = True
    later: list[PostPapers] | None = None
    stock: "str | Path | TriangleMesh | None" = None


#: A post that is part of nothing.
ALONE: Final = Work()


def post(
    cl: ToolpathLike | Iterable[ToolpathLike],
    *,
    machine: MachineLike,
    observer: Observer = SILENT,
    **given: Unpack[PostArguments],
) -> PostResult:
    """Post CL files as one NC program, and prove it.

    The program is planned and written, read back by an independent reader, run on the machine and compared with its CL
    files. It appears at ``output`` only when every check has passed.

    Parameters
    ----------
    cl
        CL files in the order in which they are cut: paths (of archives too), binary streams, or toolpaths that are
        already read.
    machine
        The name of a shipped machine, the path of a definition, or a ``Machine``.
    output
        File of the program, or a binary stream; None: the result has the text. A file appears whole or not at all,
        with the files of its subprograms. It is never one of those that are read. A device or a pipe takes the program
        as a stream.
    settings
        As ``--set`` takes them, by the same keys: ``{"title": "BLADE", "zero": (0, 0, 80), "tcp": "off"}``; see
        docs/commands.md.
    units, dialect, zero, tool_length, feed, max_tilt, edited
        Settings, too; ``units`` is the setting ``cl_units``.
    strict
        Raise an error for unknown CL statements even if the definition says what becomes of them, and for what the
        proof would stand on and nobody has stated or measured (check ``basis``).
    force
        Write a program that must not run; its head says why. ``passed`` is then False.
    explain
        Record why the axes were planned as they are (``decisions``).
    report
        File of a report, ``.html`` or ``.json``. It appears together with the program, and alone where that is refused.
    sheet
        File of the setup sheet, ``.html`` or ``.json``, which appears together with the program; docs/paper.md.
    listing
        File of a listing of all motions, as text.
    manifest
        File of the manifest, ``.json``, in the folder of the program: checksums of all files, and what they were made
        from. ``trunnion.verify_manifest`` checks it.
    columns
        Work out the columns of the verification: ``seconds`` (n,), ``tip_feed`` (n,) in mm/min and ``cl_line`` (n,). A
        report needs them; without them a program of any length takes little memory.
    subprograms
        Files of subprograms that exist already and that templates of the definition call. No others are opened.
    simulation
        Simulate the program too, as ``trunnion.simulate`` does, with its arguments ``stock``, ``part``, ``fixtures``,
        ``near``, ``tools``, ``tool_libraries``, ``unit``, ``cell`` and ``accuracy``: ``{"stock": "box:100,80,30"}``. Or
        the path of a project file of one set-up, also as ``{"project": path}`` with others in its place. Tools come
        from the CL files where nothing else has them. What is found fails the checks ``removal``, ``collision`` and
        ``gouge``; the result has it as ``simulation``. Without ``stock`` it is that which the CL files state.
    sheet_tools
        Tools that the sheet names by their libraries without a simulation: ``tools``, ``tool_libraries`` and ``unit``
        as ``trunnion.simulate`` takes them. The CL files come first, and a tool that nothing describes is left as it
        is.
    hooks
        Python files whose functions change what the CL files ask for (``trunnion.hooks``). They are run: name none that
        you have not read. The program is proven against what they make of the CL files, and ``problems`` says which
        operations they changed.
    turn, tilt
        Of the part, degrees, where it is clamped otherwise than it is drawn: first the tilt about X of the program's
        coordinate system, then the turn about Z, right-handed, about the workpiece zero. Comments in the head of the
        program say so; a simulation takes stock, part and fixtures as they are drawn.
    observer
        Receives the progress, warnings, the plan and the proof.

    Returns
    -------
    PostResult
        ``passed``, ``checks``, ``run``, ``motions``, ``problems`` and the files.

    Raises
    ------
    InputError
        When a file, the machine or a setting cannot be used.
    RefusedError
        When the program must not run, as when an axis leaves its travel; nothing is written.
    ProofFailedError
        A ``RefusedError``: when a check fails. Its ``result`` has the verification.

    Notes
    -----
    docs/checks.md has the derivation of each check and of its tolerance.

    Examples
    --------
    >>> import trunnion
    >>> result = trunnion.post("tests/golden/yl569/2_hub_rough.cls", machine="yl569", settings={"title": "HUB"})
    >>> result
    PostResult(passed=True, 30 motions)
    """
    with reported_by_arguments("post", given):
        return post_beside(cl, machine, given, observer=observer)


def post_beside(
    cl: ToolpathLike | Iterable[ToolpathLike],
    machine: MachineLike,
    given: PostArguments,
    work: Work = ALONE,
    observer: Observer = SILENT,
) -> PostResult:
    """Post CL files as ``post`` does, as part of some work."""
    check_observer(observer)
    found = taken(PostArguments, "post", given)
    angles = checked_angles(found["turn"], found["tilt"])
    papers = paper_files(found["report"], found["sheet"], found["listing"], found["manifest"], found["output"])
    loaded = as_machine(machine)
    job = prepare(
        loaded, found["settings"], force=found["force"], explain=found["explain"], papers=papers,
        columns=found["columns"],
    )  # fmt: skip
    existing, hook_files = (check_paths(name, found.get(name)) for name in ("subprograms", "hooks"))
    job = replace(job, beside=tuple(existing), can_force=work.can_force, strict=found["strict"], stock=work.stock)
    inputs = [*cl_files(cl), *machine_files(machine, loaded), *existing, *hook_files, *work.others]
    if (simulation := found["simulation"]) is not None:
        from trunnion.jobs.simulate.posted import simulation_files, simulation_input

        read = tuple(simulation_files(simulation))
        simulated = simulation_input(simulation, job.machine, job.settings.get(RADIUS_REGISTER_SETTING))
        job = replace(job, simulation=simulated, simulation_files=read, stock=simulated.stock or None)
        inputs += read
    if (tools := found["sheet_tools"]) is not None:
        from trunnion.jobs.inputs.bodies import known_tools

        if not isinstance(tools, Mapping):
            raise no_mapping("sheet_tools", tools)
        if unknown := next((name for name in tools if name not in _SHEET_TOOLS), None):
            raise wrong_argument("sheet_tools", unknown, phrase("give_one_of", choices=_SHEET_TOOLS))
        libraries = check_paths("tool_libraries", tools.get("tool_libraries") or ())
        known = known_tools(tools.get("tools") or (), libraries, tools.get("unit"), ())
        job, inputs = replace(job, sheet_tools=known), [*inputs, *libraries]
    places, edited = papers.by_name(), job.settings.get("edited", "")
    with open_target(found["output"], papers=places, inputs=inputs, group=work.group, edited=edited) as target:
        compile_ahead(kernels.POSTING)
        job.subprograms(target.files, target.path)  # settings that contradict each other are found before any reading
        hooks = loaded_hooks(hook_files, job.machine.name, job.control.name, job.settings)
        if hooks is not None:
            job = replace(job, control=hooks.at_places(job.control, job.encoding))
        toolpaths = load_toolpaths(cl, job, found["strict"], observer, hooks.change if hooks else list)
        toolpaths, job = as_clamped(toolpaths, job, hooks, angles, is_placed=work.is_placed)
        target.files.protect(file_on_disk(toolpath.file) for toolpath in toolpaths)
        return post_toolpaths(toolpaths, job, target, observer, work.later)


def post_toolpaths(
    toolpaths: Sequence[Toolpath],
    job: PostJob,
    target: Target,
    observer: Observer,
    later: list[PostPapers] | None = None,
) -> PostResult:
    """Plan, write and prove a program; errors as ``post`` raises them, ``later`` as ``Work`` has it."""
    job = job.named_after(target.path)
    subprograms = job.subprograms(target.files, target.path)
    posting = Posting(toolpaths, job, target, observer, subprograms, ProgramPlaces(target))
    with reported_refusals(posting):
        written = write_and_read_back(posting, partial(_planned, posting))
        if job.options.fastest_feed:
            planned = _with_reached_feeds(posting, written)
            del written  # two runs would take twice the memory
            target.files.restart()
            written = write_and_read_back(posting, lambda: planned)
        expected = expectation(written.planned.program, job.options, demands=DEMANDS if job.strict else ())
    proof = prove(posting, written, expected)
    result = report_proof(posting, written.planned, proof)
    if proof.failed and not job.force:
        raise refused(posting, proof, result)
    program = written.planned.program
    if program.time_token:
        write_times(target.files, program, proof.times)
    return _with_papers(posting, program, result, later)


def _planned(posting: Posting) -> PlannedProgram:
    """Return the program as it is planned, with a token in the place of each machining time in its text."""
    planned = plan_program(posting.toolpaths, posting.job, posting.observer)
    if not prints_times(planned.program):
        return planned
    return planned._replace(program=replace(planned.program, time_token=new_time_token()))


def _with_reached_feeds(posting: Posting, written: WrittenProgram) -> PlannedProgram:
    """Return the program with the feeds that its axes reach in the run with the greatest feeds."""
    from trunnion.jobs.post.fastest_feeds import raised_feeds, unlimited_axes, with_reached_feeds  # for few posts

    planned, toolpaths, job = written.planned, posting.toolpaths, posting.job
    program = with_reached_feeds(planned.program, written.run, toolpaths, job.options)
    found = [*unlimited_axes(job.machine), *raised_feeds(program, toolpaths)]
    posting.observer.problems(found)
    found += new_problems(program, posting.observer, planned.problems)
    plan = replace(planned.plan, motions=tuple(program.motions))
    return PlannedProgram(program, plan, [*planned.problems, *found])


def _with_papers(posting: Posting, program: Program, result: PostResult, later: list[PostPapers] | None) -> PostResult:
    """Return the result of a program that is complete, with its papers: they are written, or go into the list
    ``later``.
    """
    target = posting.target
    if target.papers:
        papers = post_papers(target, program, posting.job, result, posting.observer.words)
        if later is None:
            papers.write()
        else:
            later.append(papers)
    stay = left_over(
        target, target.papers.values() if later is not None else [place for _, place in target.files.papers]
    )
    stay += kept_files(target)
    posting.observer.problems(stay)
    return replace(
        result,
        problems=(*result.problems, *stay),
        encoding=posting.job.encoding,
        output=target.path,
        subprograms=target.subprograms,
        _memory=target.memory,
    )
