"""The manifest of a post: its files with their checksums, and what they were made from; and whether they still are it.

In:     a post that is complete; later its manifest, and the folder in which it is.
Out:    JSON; and for each file whether it is the one of which the manifest tells.

A manifest names files by their names alone: those of the post are beside it. Checking opens these and those that the
caller names, and no others.
"""

import hashlib
import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, TypeAlias

from trunnion.errors import InputError, Problem, Severity, unusable_file
from trunnion.files import file_on_disk
from trunnion.jobs.inputs.arguments import check_path, check_paths
from trunnion.jobs.inputs.input_files import definition_files
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.post.papers import MADE_BY
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.result import PostResult
from trunnion.messages import Wording, phrase
from trunnion.model.clamping import clamping_data
from trunnion.output.program import Program
from trunnion.records import dataclass
from trunnion.reporting.text import clean
from trunnion.results import FIRST, Figure, as_json, to_data
from trunnion.verification import Check, State, Verification, durations

if TYPE_CHECKING:
    from trunnion.jobs.result_output import Target

#: Version of the schema. It rises when programs that read older files would be misled.
SCHEMA: Final = 2

#: That of earlier versions, which is still read.
_FIRST_SCHEMA: Final = 1

#: A longer manifest is none.
_MOST_BYTES: Final = 64 << 20

#: What files of a post are, but for the manifest itself.
_WHATS: Final = ("program", "subprogram", "report", "sheet", "listing")

#: What a manifest says of a check.
_OF_CHECK: Final = ("key", "state", "missing", "summary", "worst", "limit", "unit")

#: Bytes of a name that file systems take.
_LONGEST_NAME: Final = 255


@dataclass(frozen=True, slots=True)
class ManifestEntry:
    """What a manifest says of a file: of one that was read without ``what``, and without checksum where it is none on
    the disk, as what came from stdin.
    """

    name: str
    what: Annotated[str, Figure(none="", is_optional=True)] = ""
    size: Annotated[int | None, Figure("bytes", is_optional=True)] = None
    sha256: Annotated[str | None, Figure(is_optional=True)] = None

    @staticmethod
    def of(name: str, path: Path, what: str = "") -> "ManifestEntry":
        """Return the entry of a file that is on the disk."""
        return ManifestEntry(name, what, path.stat().st_size, checksum(path))


#: What was read for a post, by what it is.
PostInputs: TypeAlias = dict[str, list[ManifestEntry]]


@dataclass(frozen=True, slots=True)
class _Operation:
    """An operation with its tool and the seconds that it takes."""

    name: str
    tool: str
    seconds: float


@dataclass(frozen=True, slots=True)
class ManifestFile:
    """A file of which a manifest tells.

    name   without its folder
    what   program, subprogram, report, sheet, listing, or cl
    fault  what is wrong with it; empty: it is the same
    """

    name: str
    what: str
    fault: str

    def __str__(self) -> str:
        """Return the line that the command prints."""
        return f"{self.name}: {self.fault or 'the same'} ({self.what})"


@dataclass(frozen=True, slots=True)
class ManifestCheck:
    """Whether the files of a post are those of which its manifest tells.

    proven        the post passed its proof
    not_compared  names of CL files from which the program was made, and that nobody gave to compare
    """

    SCHEMA: ClassVar[int] = 1

    files: Annotated[tuple[ManifestFile, ...], Figure(after="proven")]
    proven: bool
    not_compared: tuple[str, ...] = ()

    @property
    @Figure(after=FIRST)
    def passed(self) -> bool:
        """Whether all are the same, and were proven."""
        return self.proven and not any(file.fault for file in self.files)


def checksum(path: FilePath) -> str:
    """Return the SHA-256 of a file in hexadecimal digits."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


# Writing


def post_inputs(job: PostJob, result: PostResult) -> PostInputs:
    """Return what a post has read, by what it is, each file as it is now."""
    return {
        "cl": inputs_of(file_on_disk(toolpath.file) for toolpath in result.toolpaths),
        "definitions": inputs_of(definition_files(job.machine, job.machine)),
        "subprograms": inputs_of(job.beside),
        "simulation": inputs_of(job.simulation_files),
    }


def manifest_bytes(target: "Target", program: Program, job: PostJob, result: PostResult, inputs: PostInputs) -> bytes:
    """Return the manifest of a post whose other files are complete and flushed; ``inputs`` as ``post_inputs``."""
    main = target.path.name if target.path is not None else target.name
    files = [ManifestEntry.of(main, target.files.path, "program")]
    files += [ManifestEntry.of(path.name, path, "subprogram") for path in target.files.other_paths]
    folder = target.papers["manifest"].path.parent
    names = {place.entry: name for name, place in target.papers.items()}
    for path, place in target.files.papers:
        if place.path.parent == folder and not place.is_stream:
            files.append(ManifestEntry.of(place.path.name, path, names[place.entry]))
    data = {
        "schema": SCHEMA,
        "made_by": MADE_BY,
        "program": clean(main),
        "machine": {"key": clean(job.machine.key), "name": clean(job.machine.name)},
        "control": clean(program.control.name),
        **clamping_data(job.clamping),
        "may_run": result.passed,
        "simulation_passed": None if result.simulation is None else result.simulation.passed,
        "files": files,
        "inputs": inputs,
        "settings": dict(sorted(job.settings.items())),
        "settings_of_operations": {name: dict(sorted(own.items())) for name, own in sorted(job.own_settings.items())},
        "settings_in_force": dict(sorted(program.effective_settings().items())),
        "overruled": [clean(each.what) for each in result.problems if each.severity is Severity.ERROR],
        "warnings": [clean(each.what) for each in result.problems if each.severity is Severity.WARNING],
        "standing": result.standing,
        **_proof(result.verification),
    }
    return (as_json(to_data(data)) + "\n").encode("utf-8", "replace")


def inputs_of(files: Iterable[FilePath]) -> list[ManifestEntry]:
    """Return the entries of files that were read, each once."""
    found: dict[str, ManifestEntry] = {}
    for path in map(Path, files):
        name = clean(path.name)
        entry = ManifestEntry.of(name, path) if path.is_file() else ManifestEntry(name)
        found.setdefault(os.path.realpath(path), entry)
    return list(found.values())


def _clean(check: Check) -> Check:
    return replace(check, answer=check.answer and check.answer.changed(clean))


def _proof(verification: Verification | None) -> dict[str, object]:
    """Return the result of the proof, and the times that it found."""
    if verification is None:
        return {"checks": [], "seconds": None, "operations": []}
    seconds, _ = durations(verification)
    return {
        "checks": [to_data(_clean(check), only=_OF_CHECK) for check in verification.checks],
        "seconds": float(seconds.sum()),
        "operations": [
            _Operation(clean(own.name), clean(own.tool), float(seconds[own.first : own.end].sum()))
            for own in verification.operations
        ],
    }


# Checking


def verify_manifest(manifest: FilePath, *, cl: Sequence[FilePath] = ()) -> ManifestCheck:
    """Tell whether the files of a post are still those of which its manifest tells.

    Parameters
    ----------
    manifest
        Its file; the files of the post are beside it.
    cl
        CL files that are compared with those from which the program was made. Others are not opened.

    Returns
    -------
    ManifestCheck
        ``passed``; ``files``, each with its ``fault``.

    Raises
    ------
    InputError
        When it is no manifest, or a file cannot be read.

    Examples
    --------
    >>> import trunnion
    >>> from pathlib import Path
    >>> Path("build").mkdir(exist_ok=True)
    >>> posted = trunnion.post(
    ...     "tests/golden/yl569/2_hub_rough.cls", machine="yl569", output="build/hub.mpf", manifest="build/hub.json"
    ... )
    >>> trunnion.verify_manifest("build/hub.json").passed
    True
    """
    path = check_path("manifest", manifest)
    data = _read(path)
    found = [_checked(path, entry) for entry in _entries(path, data, "files")]
    if not found:
        raise _fault(path, Wording("FIL330", "no_files"))
    _check_whole(path, data, found)
    inputs = data.get("inputs")
    stated = _entries(path, inputs if isinstance(inputs, dict) else {}, "cl")
    if not stated:
        raise _fault(path, Wording("FIL330", "no_cl_files"))
    sums = {entry.get("sha256"): clean(str(entry.get("name"))) for entry in stated}
    given = set[str]()
    for file in check_paths("cl", cl):
        _check_file(file, phrase("file_of_cl"))
        given.add(own := _sum_of(file))
        fault = "" if own in sums else "is not what the program was made from"
        found.append(ManifestFile(clean(file.name), "cl", fault))
    others = tuple(name for known, name in sums.items() if known not in given)
    return ManifestCheck(tuple(found), data.get("may_run") is True, others)


def files_of_manifest(manifest: FilePath) -> list[Path]:
    """Return the files beside a manifest that it lists, and those that have the names of its CL files; none if it is
    no manifest, which whoever reads it says.
    """
    path = check_path("manifest", manifest)
    try:
        data = _read(path)
        inputs = data.get("inputs")
        stated = _entries(path, inputs if isinstance(inputs, dict) else {}, "cl")
        names = [entry.get("name") for entry in (*_entries(path, data, "files"), *stated)]
    except InputError:
        return []
    return [path.with_name(name) for name in names if isinstance(name, str) and _is_plain(name)]


def _check_whole(path: Path, data: dict[str, Any], files: Sequence[ManifestFile]) -> None:
    """Raise ``InputError`` for a manifest from which something was taken, or that contradicts itself."""
    programs = [file.name for file in files if file.what == "program"]
    if programs != [data.get("program")]:
        raise _fault(path, Wording("FIL330", "other_program"))
    names = [file.name.casefold() for file in files]
    if twice := next((file.name for k, file in enumerate(files) if names[k] in names[:k]), ""):
        raise _fault(path, Wording("FIL330", "file_twice", name=twice))
    checks = _entries(path, data, "checks")
    sound = bool(checks) and all(map(_is_sound, checks)) and data.get("overruled") == []
    if data.get("may_run") is True and not sound:
        raise _fault(path, Wording("FIL330", "checks_contradict"))


def _is_sound(check: dict[str, Any]) -> bool:
    """Whether a check of a manifest has found nothing; those of the first schema say it otherwise."""
    if "passed" in check:
        return check["passed"] is True
    return check.get("state") in (State.OK, State.NOT_CHECKED)


def _read(path: Path) -> dict[str, Any]:
    _check_file(path, phrase("file_of_manifest"))
    try:
        with path.open("rb") as file:
            text = file.read(_MOST_BYTES + 1)
        data = json.loads(text) if len(text) <= _MOST_BYTES else None
    except OSError as error:
        raise _fault(path, Wording("FIL330", "cannot_be_read", reason=error.strerror)) from None
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict) or "files" not in data or "made_by" not in data:
        raise _fault(path, Wording("FIL330", "no_list_of_files"))
    if data.get("schema") not in (_FIRST_SCHEMA, SCHEMA):
        shown = f"{data.get('schema')!r:.40}"
        raise _fault(path, Wording("FIL330", "other_schema", schema=shown, known=SCHEMA))
    return data


def _entries(path: Path, data: dict[str, Any], key: str) -> list[dict[str, Any]]:
    entries = data.get(key, [])
    if not isinstance(entries, list) or not all(isinstance(each, dict) for each in entries):
        raise _fault(path, Wording("FIL330", "no_such_list", key=key))
    return entries


def _checked(manifest: Path, entry: dict[str, Any]) -> ManifestFile:
    """One file of the post, which is beside the manifest."""
    name, what, size = entry.get("name"), entry.get("what"), entry.get("bytes")
    if not isinstance(name, str) or not _is_plain(name):
        raise _fault(manifest, Wording("FIL330", "no_name_beside", name=f"{name!r:.80}"))
    if what not in _WHATS:
        raise _fault(manifest, Wording("FIL330", "nothing_of_a_post", kind=f"{what!r:.80}"))
    file = manifest.with_name(name)
    if not file.is_file():
        fault = "is missing"
    elif file.stat().st_size != size or _sum_of(file) != entry.get("sha256"):
        fault = "differs"
    else:
        fault = ""
    return ManifestFile(clean(name), clean(what), fault)


def _is_plain(name: str) -> bool:
    """Whether a name leads to no other folder, on no system."""
    if name in ("", ".", "..") or any(letter in "/\\:\0" or ord(letter) < 32 for letter in name):
        return False
    try:
        return len(name.encode("utf-8")) <= _LONGEST_NAME
    except UnicodeEncodeError:
        return False


def _check_file(path: Path, what: Wording) -> None:
    """Raise ``InputError`` for what is no file on the disk; a pipe would let the caller wait."""
    if problem := unusable_file(path, what):
        raise InputError(problem)


def _sum_of(file: Path) -> str:
    try:
        return checksum(file)
    except OSError as error:
        raise InputError(
            Problem(str(file), 0, Wording("FIL120", "program_unreadable", reason=error.strerror))
        ) from None


def _fault(path: Path, wording: Wording) -> InputError:
    return InputError(Problem(str(path), 0, wording))
