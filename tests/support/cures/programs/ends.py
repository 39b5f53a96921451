"""Cures of messages about NC programs whose files, calls, modes and ends are not as they should be."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, marked, verify
from tests.support.program_heads import HEADS
from trunnion.errors import Problem, TrunnionError
from trunnion.readers.program.limits import StepCounter

_HEADS: Final = {
    **HEADS,
    "haas_umc750": "%\nO00001\nG21 G90 G94\nT5 M6\nG54\nS500 M3\nG43 H5 G0 X0. Y0. Z50.\n{lines}\n"
    "G1 Z5. F100.\nM30\n%\n",
}
_FANUC: Final = "matsuura_mx330"
_LENGTHS: Final = {"5": 80.0, "6": 90.0}
_LINUXCNC: Final = "xyzac_trt"
_TNC: Final = "mikron_600u"
_FIDIA: Final = "hs664rt"
_SOUND: Final = HEADS["yl569"].format(lines="G1 X10 F100")


def _in(message: str, *lines: str, on: str = "yl569", trial: Trial | None = None, **settings: str) -> Cure:
    """Lines within a program."""
    head, _, foot = _HEADS[on].partition("{lines}\n")
    return marked(message, trial or verify(on), *lines, head=head, foot=foot, **settings)


def _on_fork(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program of a Fidia with both rotary axes in its head."""
    file = folder / "fork.toml"
    file.write_text(
        'extends = "generic_head_head_ca"\nname = "Fork"\n[control]\nextends = "fidia_nc15"\n'
        '[control.settings]\ntcp_on = "G96"\ntcp_off = "G97"\n',
        encoding="utf-8",
    )
    return verify(str(file))(text, settings, folder)


def _limited(on: str, **limits: int) -> Trial:
    """Return what verifies a program where less is followed, so that its end comes soon."""

    def limited(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        counter = partial(_counter, limits.get("steps", 30))
        named: dict[str, Any] = {name: value for name, value in limits.items() if name != "steps"}
        with (
            patch("trunnion.readers.program.interpreter.StepCounter", counter),
            patch.multiple("trunnion.readers.program.limits", **named),
        ):
            return verify(on)(text, settings, folder)

    return limited


def _counter(limit: int, _: int, *rest: object) -> StepCounter:
    return StepCounter(limit, *rest)  # type: ignore[arg-type]


def _defined(program: str, on: str) -> Trial:
    """Return what verifies a program on a machine with more lines in its definition."""

    def verified(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        machine = folder / "ours.toml"
        machine.write_text(f'schema = 1\nname = "Ours"\nextends = "{on}"\n{definition}', encoding="utf-8")
        return verify(str(machine))(program, settings, folder)

    return verified


def _with_lengths(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program for a Fanuc whose tools have lengths."""
    file = folder / "part.nc"
    file.write_text(text, encoding="utf-8")
    found = trunnion.verify(file, machine=_FANUC, tool_length=_LENGTHS)
    return Outcome(tuple(Problem(each.file, each.line, each.wording) for each in found.run.diagnostics), found.passed)


def _with_files(on: str, files: Mapping[str, str]) -> Trial:
    """Return what verifies a program with subprograms."""

    def verified(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        for name, lines in files.items():
            (folder / name).write_text(lines, encoding="utf-8")
        program = folder / "part.mpf"
        program.write_text(text, encoding="utf-8")
        try:
            found = trunnion.verify(program, machine=on, subprograms=[folder / name for name in files])
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        noted = [Problem(str(program), each.line, each.wording, each.severity) for each in found.run.diagnostics]
        return Outcome(tuple(noted), found.passed)

    return verified


def _called(message: str, call: str, on: str, **files: str) -> Cure:
    """A call in a program, and the file that it calls, which is named then."""
    code, _, variant = message.partition(" ")
    head, _, foot = _HEADS[on].partition("{lines}\n")
    named = {name.replace("_", "."): text for name, text in files.items()}
    text = f"{head}{call}\n{foot}"
    return Cure(code, variant, _with_files(on, {}), text, (), cured_by=_with_files(on, named))


def _numbered(variant: str, given: Mapping[str, int], own: str = "") -> Cure:
    """A call of O0077 with files of other numbers, or of too many; the cure leaves one of the right number."""
    head, _, foot = _HEADS[_FANUC].partition("{lines}\n")
    text = f"{head}M98 P77\n{foot}{own}"
    files = {name: f"O{number:04d}\nG1 X3. F100.\nM99\n" for name, number in given.items()}
    right = {} if own else {"O0077.nc": "O0077\nG1 X3. F100.\nM99\n"}
    return Cure("NC132", variant, _with_files(_FANUC, files), text, (), cured_by=_with_files(_FANUC, right))


def _utf_16(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program that is saved as UTF-16."""
    file = folder / "part.mpf"
    file.write_text(text, encoding="utf-16")
    try:
        return Outcome((), trunnion.verify(file, machine="yl569").passed)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)


def _assuming(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program with what a word does that is not in it."""
    file = folder / "part.mpf"
    file.write_text(text, encoding="utf-8")
    found = trunnion.verify(file, machine="yl569", assume={"M999": "no effect"})
    return Outcome(tuple(found.remarks), found.passed and found.standing.warnings == 0)


def _strange(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Verify a program on a machine with a control of which nothing is known."""
    return _defined(text, "yl569")('[control]\nfamily = "strange"\n', settings, folder)


_TILT: Final = "PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY"
_ROT: Final = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT{}"

CURES: Final = (
    Cure("NC110", "no_text", _utf_16, _SOUND, (), cured_by=verify()),
    marked("NC113 is_text", verify(), *["- Please call the tool room about the part"] * 5,
           *(f"+ {line}" for line in _SOUND.splitlines())),
    _called("NC132 missing_called_program", "CALL PGM SUB.H", _TNC,
            SUB_H="BEGIN PGM SUB MM\nL X+3 F100\nEND PGM SUB MM\n"),
    _called("NC132 missing_program", 'CALL PGM "SUB.H"', _TNC, SUB_H="BEGIN PGM SUB MM\nL X+3 F100\nEND PGM SUB MM\n"),
    _called("NC132 missing_subprogram", "O<sub> CALL", _LINUXCNC,
            sub_ngc="O<sub> SUB\nG1 X3 F100\nO<sub> ENDSUB\nM2\n"),
    _called("NC132 missing_called_number", "M98 P77", _FANUC, O0077_nc="%\nO0077\nG1 X3. F100.\nM99\n%\n"),
    _called("NC132 missing_subprogram_number", "M98 L1 P77", _FANUC, O0077_nc="%\nO0077\nG1 X3. F100.\nM99\n%\n"),
    _numbered("files_of_one_number", {"O0077.nc": 77, "0077.nc": 77}),
    _numbered("number_in_both", {"O0077.nc": 77}, "O0077\nG1 X3. F100.\nM99\n"),
    _numbered("other_number_in_file", {"O0077.nc": 78}),
    _in("NC140 goes_in_circles", "R1=1", "WHILE R1<9", "G1 X10 F100", "+ R1=R1+1", "ENDWHILE",
        trial=_limited("yl569", steps=10**6, MOST_BLOCKS_IN_CIRCLES=40, _LOOKED_AT_AFTER=20)),
    _in("NC140 too_many_blocks", "R1=1", "WHILE R1<9", "G1 X=R1 F100", "+ R1=R1+1", "- R1=R1+.0001", "ENDWHILE",
        trial=_limited("yl569", BLOCKS_PER_LINE=2)),
    _in("NC140 too_many_motions", "R1=1", "- WHILE R1>0", "+ WHILE R1<3", "G1 F100", "CYCLE81(10,0,3,-6)", "G0 X=R1",
        "R1=R1+1", "ENDWHILE", trial=_limited("yl569", MOTIONS_PER_LINE=1)),
    _in("NC140 too_many_records", "R1=1", "- WHILE R1>0", "+ WHILE R1<3", "G1 X=R1 F100 ; cut", "R1=R1+1", "ENDWHILE",
        trial=_limited("yl569", BLOCKS_PER_LINE=1000)),
    _in("NC140 too_many_resolutions", "R1=1", "- WHILE R1>0", "+ WHILE R1<3", "TRAORI", "G54", "G1 X=R1 F100",
        "TRAFOOF", "G54", "R1=R1+1", "ENDWHILE", trial=_limited("yl569", BLOCKS_PER_LINE=1000, RESOLUTIONS_PER_LINE=1)),
    _in("NC140 too_many_turns", "G1 X10 Y0 F100", "- G3 X10 Y0 Z-90 I-10 J0 TURN=900",
        "+ G3 X10 Y0 Z-90 I-10 J0 TURN=9",
        trial=_limited("yl569", TURNS_PER_LINE=1)),
    _in("NC224 machine_position_with_length", "- SUPA G0 Z200", "+ SUPA G0 Z200 D0", "X0 Y0 Z50 D1"),
    marked("NC190 word_without_letters", _defined(_SOUND, "yl569"), "[control.known]", '- "" = "no effect"',
           '+ "M60" = "no effect"'),
    marked("NC364 length_changes_under_tcp", verify(_LINUXCNC), "G21 G90 G94 G54", "T5 M6", "S500 M3", "G53 G0 Z0",
           "G0 A30", "G43 H5", "+ G43 H6", "M428", "- G43 H6", "G0 X0 Y0 Z50", "G1 Z5 F100", "M429", "G53 G0 Z0",
           "G49", "M2"),
    marked("NC364 length_ends_under_tcp", verify(_LINUXCNC), "G21 G90 G94 G54", "T5 M6", "S500 M3", "G53 G0 Z0",
           "G0 A30", "G43 H5", "M428", "G0 X0 Y0 Z50", "G1 Z5 F100", "- G49", "M429", "G53 G0 Z0", "+ G49", "M2"),
    _in("NC361 length_of_other_tool", "- G43 H6 Z50.", "+ G43 H5 Z50.", "G1 X9. F100.", "G0 Z90.", "G49", "G53 Z0.",
        "G43 H5 Z50.", on=_FANUC, trial=_with_lengths),
    _in("NC240", "- G98 G81 X1. Z-5. R2.", "+ G98 G81 X1. Z-5. R2. F100.", "G80", on=_FANUC),
    _in("NC341", "M428", "- G53 G0 Z10", "+ M429", "+ G53 G0 Z10", "+ M428", "M429", on=_LINUXCNC),
    _in("NC341 m242_while_tcp", "G196", "- M242", "G197", "+ M242", on=_FIDIA),
    _in("NC341 tcp_of_heads", "- G96", "+ G196", "- G97", "+ G197", on=_FIDIA),
    _in("NC341 tcp_of_tables", "- G196", "+ G96", "- G197", "+ G97", on=_FIDIA, trial=_on_fork),
    _in("NC342", "G196", "G1 X1. C350. F100", "X2. C10.", "G197", on=_FIDIA),
    _in("NC342 noted", "G196", "G1 X1. C350. F100", "X2. C10.", "G197", on=_FIDIA),
    _in("NC342 more_noted", "G196", "G1 X1. C350. F100", *["X2. C10.", "X1. C350."] * 12, "G197", on=_FIDIA),
    _in("NC350", "TRAORI", "G54", "ORIWKS", "ORIVECT", "- G0 A3=0 B3=0 C3=-1", "+ G0 A3=0 B3=0 C3=1", "TRAFOOF", "G54"),
    _in("NC363", "M126", "L C+5 F100", "L C+0", "M127", "M126", "+ M127", on=_TNC),
    _in("NC370", "G98 G84 X1. Z-5. R2. F500.", "G80", "+ S500 M3", "G1 X5. F100.", on="haas_umc750"),
    _in("NC150 too_many_errors", *(f"- {word}" for word in ["FOO"] * 10_000), "G1 X10 F100"),
    _in("NC150", *(f"- {word}" for word in ["FOO"] * 10_000), "G1 X10 F100"),
    _in("NC351 datum_behind_plane_unconfirmed", _TILT, _ROT.format("+5"), "+ " + _ROT.format("+0"),
        "PLANE RESET STAY", "L X+1 F100", on=_TNC),
    _in("NC351 datum_in_plane_unconfirmed", "- " + _ROT.format("+5"), _TILT, _ROT.format("+5"), "L X+1 F100",
        _ROT.format("+0"), "PLANE RESET STAY", on=_TNC),
    Cure("NC228", "never_needed", _assuming, _SOUND, (), cured_by=verify()),
    Cure("NC120", "no_reader", _strange, _SOUND, (), cured_by=verify()),
    Cure("NC141", "subprograms_too_deep", _with_files("yl569", {"FOO.SPF": "FOO\nM17\n"}),
         _SOUND.replace("G1 X10", "FOO\nG1 X10"), (), cured_by=_with_files("yl569", {"FOO.SPF": "G1 X1 F100\nM17\n"})),
)  # fmt: skip
