"""Posting: toolpaths to one proven NC program.

In:     toolpaths, a machine, settings.
Out:    the program: planned, written, read back, run and compared with its toolpaths. A program that fails is not
        written unless it is forced.
"""

from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from trunnion.controls.vocabulary import HOOKS_NOTICE
from trunnion.errors import Problem, Severity, TrunnionError
from trunnion.files import OutputGroup, file_on_disk
from trunnion.hooks.calling import Hooks
from trunnion.hooks.files import load_hooks
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.inputs.arguments import check_observer, check_paths, checked_angles
from trunnion.jobs.inputs.input_files import cl_files, machine_files
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike, as_machine
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.papers.files import PaperFiles, paper_files
from trunnion.jobs.papers.reports import write_refusal
from trunnion.jobs.papers.writing import PostPapers, post_papers
from trunnion.jobs.post.expected_values import Expectation, expectation
from trunnion.jobs.post.forced_program import Proof, Untold, write_forced
from trunnion.jobs.post.left_over_files import left_over
from trunnion.jobs.post.machining_times import new_time_token, operation_times, prints_times, write_times
from trunnion.jobs.post.planning import load_toolpaths, new_problems, plan_program
from trunnion.jobs.post.post_job import FORCING, PostJob, prepare
from trunnion.jobs.post.program_places import ProgramPlaces
from trunnion.jobs.post.result import PostResult, ProofFailedError
from trunnion.jobs.post.writing import named_verification, read_back_while_writing, write
from trunnion.jobs.result_output import OutputLike, Target, open_target
from trunnion.jobs.verify.program_warnings import program_warnings, stated_words
from trunnion.model.clamped_toolpaths import clamped_after, stated_clamping, turned_toolpaths
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.model.toolpath import Message, Toolpath
from trunnion.placing.program_heads import placed_notices
from trunnion.verification import Verification, rows_from_starts, verify, without_columns

if TYPE_CHECKING:  # imported where a program is simulated: others start sooner
    from trunnion.jobs.simulate.posted import SimulationLike


def post(
    cl: ToolpathLike | Iterable[ToolpathLike],
    *,
    machine: MachineLike,
    output: OutputLike = None,
    settings: Settings | None = None,
    strict: bool = False,
    force: bool = False,
    explain: bool = False,
    report: FilePath | None = None,
    sheet: FilePath | None = None,
    listing: FilePath | None = None,
    manifest: FilePath | None = None,
    columns: bool = True,
    subprograms: Sequence[FilePath] = (),
    simulation: "SimulationLike | None" = None,
    hooks: Sequence[FilePath] = (),
    turn: float = 0.0,
    tilt: float = 0.0,
    observer: Observer = SILENT,
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
    strict
        Raise an error for unknown CL statements even if the definition says what becomes of them.
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
        ``near``, ``tools``, ``libraries``, ``unit``, ``cell`` and ``accuracy``: ``{"stock": "box:100,80,30"}``. Or the
        path of a project file of one set-up, also as ``{"project": path}`` with others in its place. Tools come from
        the CL files where nothing else has them. What is found fails the checks ``removal``, ``collision`` and
        ``gouge``; the result has it as ``simulation``.
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
    return post_beside(
        cl, (), machine=machine, output=output, settings=settings, strict=strict, force=force, explain=explain,
        papers=paper_files(report, sheet, listing, manifest, output), columns=columns, subprograms=subprograms,
        simulation=simulation, hooks=hooks, turn=turn, tilt=tilt, observer=observer,
    )  # fmt: skip


def post_beside(
    cl: ToolpathLike | Iterable[ToolpathLike],
    others: Sequence[FilePath],
    *,
    machine: MachineLike,
    output: OutputLike,
    settings: Settings | None,
    strict: bool,
    force: bool,
    explain: bool,
    papers: PaperFiles,
    columns: bool,
    subprograms: Sequence[FilePath],
    observer: Observer,
    simulation: "SimulationLike | None" = None,
    hooks: Sequence[FilePath] = (),
    turn: float | None = None,
    tilt: float | None = None,
    is_placed: bool = False,
    group: OutputGroup | None = None,
    forcing: str = FORCING,
    later: list[PostPapers] | None = None,
) -> PostResult:
    """Post CL files as ``post`` does, and write over none of the other files of the same work.

    The program appears with those of the ``group``, if there is one. Where it ``is_placed``, its head says how the part
    is clamped, even if that is as it is drawn. What a refusal says of ``force`` is ``forcing``. Papers are written, or
    go into the list ``later``: who gives it writes them.
    """
    check_observer(observer)
    angles = checked_angles(turn, tilt)
    loaded = as_machine(machine)
    job = prepare(loaded, settings, force=force, explain=explain, papers=papers, columns=columns)
    existing = check_paths("subprograms", subprograms)
    job = replace(job, beside=tuple(existing), forcing=forcing)
    hook_files = check_paths("hooks", hooks)
    inputs = [*cl_files(cl), *machine_files(machine, loaded), *existing, *hook_files, *others]
    if simulation is not None:
        from trunnion.jobs.simulate.posted import simulation_files, simulation_input

        read = tuple(simulation_files(simulation))
        job = replace(job, simulation=simulation_input(simulation, job.machine), simulation_files=read)
        inputs += read
    with open_target(output, papers=papers.by_name(), inputs=inputs, group=group) as target:
        compile_ahead(kernels.POSTING)
        job.subprograms(target.files, target.path)  # settings that contradict each other are found before any reading
        changes = Hooks(load_hooks(hook_files), job.machine.name, job.control.name, job.settings)
        toolpaths = load_toolpaths(cl, job, strict, observer, changes.change)
        stated = stated_clamping(toolpaths)
        clamping = clamped_after(stated, angles, toolpaths[0].file if toolpaths else target.name)
        toolpaths, carried = _without_notices(toolpaths, job)
        toolpaths = turned_toolpaths(toolpaths, *angles, absolute=job.options.absolute_frame)
        decisions = tuple(changes.decisions) if job.options.explain else ()
        notices: tuple[str, ...] = ()
        if is_placed or stated is not None or not clamping.is_as_drawn:
            notices = placed_notices(clamping, job.machine.workpiece_zero, job.machine.tool_length)
        job = replace(job, notices=(*notices, *carried, *changes.notices), decisions=decisions, clamping=clamping)
        if simulation is not None and job.simulation is not None:
            from trunnion.jobs.simulate.posted import simulated_as_clamped

            job = replace(job, simulation=simulated_as_clamped(job.simulation, clamping))
        target.files.protect(file_on_disk(toolpath.file) for toolpath in toolpaths)
        return post_toolpaths(toolpaths, job, target, observer, later)


def _without_notices(toolpaths: list[Toolpath], job: PostJob) -> tuple[list[Toolpath], tuple[str, ...]]:
    """Toolpaths without the notices of hooks that they were converted with, and these for the head of the program."""
    operations = (operation for toolpath in toolpaths for operation in toolpath.operations)
    texts = (event.text for operation in operations for event in operation.events if isinstance(event, Message))
    if not any(text.strip().upper().startswith(HOOKS_NOTICE) for text in texts):
        return toolpaths, ()
    from trunnion.conversion import take_notices  # few CL files have some

    taken = [take_notices(toolpath, job.control.family) for toolpath in toolpaths]
    return [toolpath for toolpath, _ in taken], tuple(dict.fromkeys(text for _, found in taken for text in found))


def post_toolpaths(
    toolpaths: Sequence[Toolpath],
    job: PostJob,
    target: Target,
    observer: Observer,
    later: list[PostPapers] | None = None,
) -> PostResult:
    """Plan, write and prove a program; errors as ``post`` raises them, ``later`` as ``post_beside`` takes it."""
    subprograms = job.subprograms(target.files, target.path)
    divided = subprograms is not None
    reading = partial(
        read_back_while_writing, target.files, job.machine, encoding=job.encoding, divided=divided, beside=job.beside
    )
    places = ProgramPlaces(target)
    try:
        with reading() as (progress, running):
            program, planned, problems = plan_program(toolpaths, job, observer)
            program = replace(program, time_token=new_time_token() if prints_times(program) else "")
            starts = write(program, target.files.main, progress, subprograms, observer, places.passages)
        run = _run_of(running, job, places)
        if job.options.fastest_feed:
            from trunnion.jobs.post.fastest_feeds import (
                raised_feeds,
                unlimited_axes,
                with_reached_feeds,
            )  # few posts ask for it

            program = with_reached_feeds(program, run, toolpaths, job.options)
            found = [*unlimited_axes(job.machine), *raised_feeds(program, toolpaths)]
            observer.problems(found)
            problems += [*found, *new_problems(program, observer, problems)]
            planned = replace(planned, motions=tuple(program.motions))
            del run, running
            target.files.restart()
            with reading() as (progress, running):
                starts = write(program, target.files.main, progress, subprograms, observer, places.passages)
            run = _run_of(running, job, places)
        expected = expectation(program, job.options)
    except TrunnionError as error:
        if job.papers.report is not None:
            write_refusal(error.problems, job.machine, target.name, job.papers.report)
            target.files.remember_alone(job.papers.report)
        raise
    columns = job.columns or bool(program.time_token)

    def prove(run: Run | None, starts: Sequence[OperationStart]) -> Proof:
        verification = _prove(run, toolpaths, expected, target, starts, job, columns=columns)
        # What may get notices in its head is told when lines are those of the file that stays.
        quiet = Untold(observer) if job.force else observer
        return _with_simulation(job, run, target.name, toolpaths, verification, quiet)

    proof = prove(run, starts)
    if job.force and proof.failed:
        proof = write_forced(program, proof, prove, job, target, subprograms)
    verification, simulated = proof.verification, proof.simulation
    times = operation_times(program, verification) if program.time_token else []
    if verification is not None and not job.columns:
        verification = without_columns(verification)
    if verification is None:
        problems.append(_nothing_checked(job, target))
        observer.problems(problems[-1:])
    if simulated is not None:
        if job.force:
            observer.problems(simulated.remarks)
        problems += [remark for remark in simulated.remarks if remark.severity is Severity.WARNING]
    if verification is not None:
        words = program_warnings(verification.run, stated_words(job.control, {**job.control.settings, **job.settings}))
        problems += words
        observer.problems(words)
        observer.verified(verification)
    remarks = [remark for toolpath in toolpaths for remark in toolpath.remarks]
    result = PostResult(tuple(toolpaths), planned, verification, (*remarks, *problems), simulation=simulated)
    if proof.failed and not job.force:
        assert verification is not None
        result = replace(result, verification=places.explained(verification, job.control))
        if job.papers.report is not None:
            result.write_report(job.papers.report)
            target.files.remember_alone(job.papers.report)
        raise _proof_failed(result, job.forcing, places.cause(proof.failed, job.control))
    if program.time_token:
        write_times(target.files, program, times)
    if target.papers:
        papers = post_papers(target, program, job, result, verification)
        if later is None:
            papers.write()
        else:
            later.append(papers)
    stay = left_over(
        target, target.papers.values() if later is not None else [place for _, place in target.files.papers]
    )
    observer.problems(stay)
    return replace(
        result,
        problems=(*result.problems, *stay),
        encoding=job.encoding,
        output=target.path,
        subprograms=target.subprograms,
        _memory=target.memory,
    )


def _with_simulation(
    job: PostJob,
    run: Run | None,
    name: str,
    toolpaths: Sequence[Toolpath],
    found: Verification | None,
    observer: Observer,
) -> Proof:
    """The proof of a program with what it cuts and hits, if that is asked for."""
    if job.simulation is None:
        return Proof(found, None)
    from trunnion.jobs.simulate.posted import simulate_posted, simulation_checks

    simulated = simulate_posted(job.simulation, run, name, toolpaths, observer)
    if found is not None:
        found = replace(found, checks=(*found.checks, *simulation_checks(simulated)))
    return Proof(found, simulated)


def _prove(
    run: Run | None,
    toolpaths: Sequence[Toolpath],
    expected: Expectation,
    target: Target,
    starts: Sequence[OperationStart],
    job: PostJob,
    *,
    columns: bool,
) -> Verification | None:
    """What the proof of a program finds; None without its run."""
    if run is None:
        return None
    found = verify(run, toolpaths, tolerances=expected.tolerances, settings=expected.settings, columns=columns)
    found = named_verification(found, target.name, job.beside)
    return replace(found, operations=rows_from_starts(run, found.operations, starts), clamping=job.clamping)


def _nothing_checked(job: PostJob, target: Target) -> Problem:
    """The warning of a forced program that no reader can read."""
    what = "it is written by force, and nothing has been checked"
    without = ["setup sheet" if name == "sheet" else name for name in job.papers.by_name() if name != "manifest"]
    lost = f": there is no {' and no '.join(without)}" if without else ""
    return Problem(target.name, 0, f"{what}{lost}", severity=Severity.WARNING, code="CTL930")


def _run_of(running: Future[Run | None], job: PostJob, places: ProgramPlaces) -> Run | None:
    """The run of a program; what cannot be followed in it is told by the names that its files will have."""
    with places.told(job.control):
        return running.result()


def _proof_failed(result: PostResult, forcing: str, cause: str) -> ProofFailedError:
    """The error for a program that fails its proof; ``cause`` is the template that is likely to be why."""
    failed = "; ".join(f"{check.summary} ({check.key})" for check in result.checks if not check.passed)
    what = "; ".join(filter(None, (f"the program fails its proof: {failed}", cause)))
    cure = "; ".join(filter(None, ("no program is written", forcing)))
    problem = Problem(result.toolpaths[0].file, 0, what, cure, code="CTL910")
    return ProofFailedError(problem, result)
