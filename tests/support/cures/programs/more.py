"""Cures of messages about NC programs, verified alone: more of them, by the lines that go out and come in."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial, define, marked, verify
from tests.support.program_heads import HEADS
from trunnion.errors import Problem, TrunnionError

_HEADS: Final = {
    **HEADS,
    "dmu65": HEADS["mikron_600u"],
    "haas_umc750": "%\nO00001\nG21 G90 G94\nT5 M6\nG54\nS500 M3\nG43 H5 G0 X0. Y0. Z50.\n{lines}\n"
    "G1 Z5. F100.\nM30\n%\n",
}
_FANUC: Final = "matsuura_mx330"
_LINUXCNC: Final = "xyzac_trt"
_TNC: Final = "mikron_600u"
_FIDIA: Final = "hs664rt"


def _in(message: str, *lines: str, on: str = "yl569", **settings: str) -> Cure:
    """Lines within a program."""
    head, _, foot = _HEADS[on].partition("{lines}\n")
    return marked(message, verify(on), *lines, head=head, foot=foot, **settings)


def _file(message: str, *lines: str, on: str = "yl569", **settings: str) -> Cure:
    """All lines of a program."""
    return marked(message, verify(on), *lines, **settings)


def _defined(program: str, on: str) -> Trial:
    """Return what verifies a program on a machine with more lines in its definition."""

    def verified(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        machine = folder / "ours.toml"
        machine.write_text(f'schema = 1\nname = "Ours"\nextends = "{on}"\n{definition}', encoding="utf-8")
        return verify(str(machine))(program, settings, folder)

    return verified


def _known(message: str, line: str, *lines: str, on: str = "yl569") -> Cure:
    """Lines of the definition, for a line of a program."""
    return marked(message, _defined(_HEADS[on].format(lines=line), on), *lines)


def _definition(message: str, *lines: str, on: str = "yl569") -> Cure:
    """Lines of a definition."""
    return marked(message, define, 'schema = 1\nname = "Ours"', f'extends = "{on}"', *lines)


def _with_files(*names: str) -> Trial:
    """Return what verifies a program with subprograms, each of one motion."""

    def verified(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        files = [folder / name for name in (settings["files"].split(",") if settings else names)]
        for file in files:
            file.parent.mkdir(exist_ok=True)
            file.write_text("G0 X1\nM17\n", encoding="utf-8")
        program = folder / "part.mpf"
        program.write_text(text, encoding="utf-8")
        try:
            found = trunnion.verify(program, machine="yl569", subprograms=files)
        except TrunnionError as error:
            return Outcome(tuple(error.problems), False)
        noted = [Problem(str(program), each.line, each.wording, each.severity) for each in found.run.diagnostics]
        return Outcome(tuple(noted), found.passed)

    return verified


_SOUND: Final = HEADS["yl569"].format(lines="G1 X10 F100")

CURES: Final = (
    _file("NC110 long_line", "- " + "X" * 5_000_000, "+ " + _SOUND.rstrip()),
    _file("NC114 is_subprogram", *_SOUND.splitlines()[:-1], "- M17", "+ M30"),
    Cure("NC130", "not_a_subprogram_name", _with_files("notes.txt"), _SOUND, (), cured_by=_with_files("notes.spf")),
    Cure("NC130", "same_name", _with_files("ONE.SPF", "a/one.spf"), _SOUND, (), cured_by=_with_files("ONE.SPF")),
    Cure("NC132", "", _with_files(), _SOUND.replace("G1 X10", "FOO\nG1 X10"), (), cured_by=_with_files("FOO.SPF")),
    _in("NC113 is_for_other_control", *(f"- G{k}" for k in range(700, 720)), "G1 X10 F100"),
    _file("NC113 is_kind", "- $TEST.MIN%", "- O1", "- G15 H1", "- G56 H1", "- M6 T1", "- G0 X0 Y0", "- G1 Z-2 F200",
          "- M2",
          *(f"+ {line}" for line in HEADS[_FANUC].format(lines="G1 X10. F100.").splitlines()), on=_FANUC),
    _in("NC140 jumps_without_choice", "- AGAIN:", "- GOTOB AGAIN", "G1 X10 F100"),
    _in("NC140", "- AGAIN:", "- GOTOB AGAIN", "G1 X10 F100"),
    _in("NC141 labels_too_deep", "LBL 1", "- CALL LBL 1", "LBL 0", "- CALL LBL 1", on=_TNC),
    _in("NC141", "LBL 1", "- CALL LBL 1", "LBL 0", "- CALL LBL 1", on=_TNC),
    _in("NC160 proc_not_first", "- PROC A SAVE", "G1 X10 F100"),
    _in("NC160", "- ENDPROC", "G1 X10 F100"),
    _in("NC162", "- M99", "G1 X10. F100.", on=_FANUC),
    _in("NC163", "GOTO5", "N5 G1 X1. F100.", "N6 X2.", "- N5 X3.", "+ N7 X3.", on=_FANUC),
    _in("NC163 doubled_subprogram", "O100 SUB", "G0 X1", "O100 ENDSUB", "- O0100 SUB", "+ O101 SUB", "G0 X1",
        "- O0100 ENDSUB", "+ O101 ENDSUB",
        "O100 CALL", on=_LINUXCNC),
    _file("NC169 ends_with_ctrl_z", HEADS[_LINUXCNC].format(lines="G1 X10 F100"), "- \x1a", on=_LINUXCNC),
    _known("NC190 no_effect", "G1 X10 F100", "[control.known]", '- M60 = "jumps"', '+ M60 = "no effect"'),
    _known("NC190 no_variable", "G1 X10 F100", "[control.reading.variables]", '- "r1" = 1', '+ "R1" = 1'),
    _known("NC190 own_word", "G1 X10 F100", "[control.known]", '- M30 = "no effect"'),
    _known("NC190 begins_code_leading_zeros", "G1 X10. F100.", "[control.known]", '- "G065 P9810" = "no effect"',
           '+ "G65 P9810" = "moves nothing"', on=_FANUC),
    _known("NC190 no_word_program", "G1 X10 F100", "[control.known]", '- "?" = "no effect"', '+ M60 = "no effect"'),
    _known("NC190 table_word_point", "G1 X10 F100", "[control.known]", '- G12.5 = "no effect"',
           '+ "G12.5" = "no effect"', on=_FANUC),
    _known("NC190 no_word_could_mean_another", "G1 X10. F100.", "[control.reading.words]", '- G1 = "G0"', on=_FIDIA),
    _known("NC190 meaning_family_lacks", "G1 X10. F100.", "[control.reading.words]", '- M60 = "G54"', '+ M60 = "M3"',
           on=_FIDIA),
    _known("NC190 unknown_meaning", "G1 X10. F100.", "[control.reading.words]", "- G234 = 4", '+ G234 = "G1"',
           on=_FIDIA),
    _in("NC211", "- G777", "G1 X10 F100"),
    _in("NC211 unknown_own_word", "- M39", "G1 X10. F100.", on="haas_umc750"),
    _in("NC212", "- G1 X10 X20 F100", "+ G1 X20 F100"),
    _in("NC213", "- G1 X10 I1 F100", "+ G1 X10 F100"),
    _in("NC214", "- G1 " + "X1 " * 3000, "G1 X10 F100"),
    _in("NC215", "- G1 X10 F-1", "+ G1 X10 F100"),
    _in("NC215 cycle800_other_plane", '- CYCLE800(0,"",0,57,0,0,0,0,0,0,0,0,0,0,0,2)', "G1 X10 F100"),
    _in("NC215 orientation_tolerance_too_great", "- CYCLE832(.02,1,5)", "+ CYCLE832(.02,1,.02)", "G1 X10 F100"),
    _in("NC216", "- G2 X10 I5 CR=5 F100", "+ G2 X10 I5 J0 F100"),
    _in("NC217", "- G98 G82 X1. Z-5. R2. P500 F100.", "+ G98 G82 X1. Z-5. R2. P0.5 F100.", "G80", on="haas_umc750"),
    _in("NC220", "- G74 X1=0", "G1 X10 F100"),
    _in("NC221", "G41 G1 X10 Y0 F100", "X20", "G40 X30 Y9"),
    _in("NC222 jump_to_on_input", "N10 G1 X1. F100.", "- M96 P10 Q27", on="haas_umc750"),
    _in("NC222 jump_to_on_some_input", "N10 G1 X1. F100.", "- M96 P10", on="haas_umc750"),
    _in("NC222 jump_on_some_input", "N10 G1 X1. F100.", "- M96", on="haas_umc750"),
    _file("NC223 no_definition", "+ DEF REAL _T", "_T=5", _SOUND.replace("X10", "X=_T").rstrip()),
    _in("NC224", "- M41", "G1 X10 F100"),
    _in("NC224 corner_feed", "G1 X40 F100", "- Y40 RND=5", "+ Y40 RND=5 FRC=100", "X9 F200"),
    _in("NC224 corner_feed_in_no_manual", "G1 X40. F100.", "X40. Y40. ,R5.", "- X90. F50.", "+ X90. F100.", on=_FANUC),
    _in("NC224 cycle800_direct_axes_unknown", '- CYCLE800(0,"",0,192,0,0,0,20,40,0,0,0,0,1)', "G1 X10 F100"),
    _in("NC224 number_without_point", "- G1 X10 F100.", "+ G1 X10. F100.", on=_FANUC),
    _in("NC224 smooths_path", "- G5.1 Q3 X0 Y0", "+ G5.1 Q1", "G1 X10. F100.", "+ G5.1 Q0", on=_FANUC),
    _in("NC224 traori_only_machine_knows_what", "- TRAORI(3)", "+ TRAORI", "G54", "G1 X10 F100", "TRAFOOF", "G54"),
    _in("NC224 traori_turns_basic_position", "- TRAORI(,0,1,0)", "+ TRAORI", "G54", "G1 X10 F100", "TRAFOOF", "G54"),
    _known("NC225", "M61\nG1 X10 F100", '+ [control.known]\nM61 = "no effect: chip conveyor on"'),
    _known("NC225 noted", "M61\nG1 X10 F100", '+ [control.known]\nM61 = "no effect: chip conveyor on"'),
    _in("NC225 more_noted", *(f"M{k}" for k in range(700, 760)), "G1 X10. F100.", on=_FANUC),
    _in("NC226", "G4 F300", "G1 X10 F100"),
    _in("NC226 noted", "- G4 F300", "G1 X10 F100"),
    _in("NC226 more_noted", *["G4 F300"] * 60, "G1 X10 F100"),
    _known("NC227", "G1 X=R55 F100", '[control.reading.variables]\n"R55" = 2.5'),
    _in("NC241", "- G70", "G1 X1. F100", on=_FIDIA),
    _in("NC310", "- G1 X99999999999 F100", "+ G1 X10 F100"),
    _in("NC321", "- G2 X10 I5 J0 B5 F100", "+ G2 X10 I5 J0 F100"),
    _in("NC322", "- POLY X4 I2 F100", "+ G1 X4 F100"),
    _in("NC322 runs_as_arcs", "F100", "- G5.1 X8 Y0 I4 J-16", "+ G5.1 X4 Y-8 I2 J-8", "+ G5.1 X8 Y0 I2 J0", "G1 X9",
        on=_LINUXCNC),
    _in("NC322 order_below_three", "F100", "- G5.2 P1 L2", "+ G5.2 P1 L3", "X1 Y1 P1", "X2 Y1 P1", "G5.3", "G1 X9",
        on=_LINUXCNC),
    _in("NC323 end_beside_start", "G1 X10 Y0 F90", "- G3 X10 Y0.001 Z-1 I-10 J0", "+ G3 X10 Y0 Z-1 I-10 J0",
        on=_LINUXCNC),
    _in("NC324", "- DEP LT LEN5", "L X+5 F100", on=_TNC),
    _in("NC220 m114_position", "- M114 C+0", "+ M114", "L C+0 FMAX", "L X+10 F100", "M115", on=_TNC),
    _in("NC210 skip_within_block", "CYCL DEF 9.0 DWELL TIME", "- /CYCL DEF 9.1 DWELL 1", "+ CYCL DEF 9.1 DWELL 1",
        "L X+10 F100", on=_TNC),
    _in("NC222 tabread_only_control", '- FN 28: TABREAD Q10 = 6/"X"', "+ FN 0: Q10 = +10", "L X+Q10 F100", on=_TNC),
    _in("NC220 m114_unknown", "- M114", "+ M128", "L X+10 F100", "- M115", "+ M129", on="dmu65"),
    _in("NC340 m114_with", "M114", "L X+10 F100", "- M128", "+ M115", on=_TNC),
    _in("NC340 m114_with_tcp", "M128", "L X+10 F100", "+ M129", "M114", "L X+20 F100", "M115", on=_TNC),
    _in("NC340 m114_in_plane", "PLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY", "+ PLANE RESET STAY", "M114", "L X+10 F100",
        "M115", on=_TNC),
    _in("NC340 compensation_with_m114", "M114", "- L X+5 RL F100", "+ L X+5 R0 F100", "L X+10", "M115", on=_TNC),
    _in("NC330", "- SCALE X0", "G1 X10 F100"),
    _in("NC331", "G1 X10. F100.", "G0 Z50.", "G55", "X0. Y0.", on=_FANUC),
    _in("NC340", "- TOROT", "G1 X10 F100"),
    _in("NC341 g28_tcp_whether_ends_tcp", "G234 H5 Z60.", "+ G49", "G91 G28 Z0.", "G90", "G43 H5 Z50.",
        on="haas_umc750"),
    _in("NC343 refused", "G41 G1 X10 Y0 F100", "X20", "- M6", "X30", "G40 X40 Y9", "+ G0 Z50", "+ M5", "+ M6",
        "+ G0 X0 Y0 Z50 D1", "+ M3 S500"),
    _in("NC343 suspends", "G1 Z0. F100.", "G41 D1 X10. Y0.", "X20.", "- G52 X0 Y0", "X30.", "G40 X40. Y9.",
        "+ G52 X0 Y0", on=_FANUC),
    _in("NC343 drills", "G1 Z0. F100.", "G41 D1 X10. Y0.", "X20.", "- G99 G81 X25. Z-5. R2.", "- G80", "- G1 X30.",
        "G40 X40. Y9.", "+ G99 G81 X25. Z-5. R2.", "+ G80", on=_FANUC),
    _in("NC210 plane_needs_positioning", "L Z+450 R0 FMAX M91",
        "- PLANE SPATIAL SPA+0 SPB-30 SPC+0 FMAX", "+ PLANE SPATIAL SPA+0 SPB-30 SPC+0 TURN FMAX",
        "PLANE RESET TURN FMAX", on="mikron_600u"),
    _in("NC351 plane_axial_leaves_out", "L Z+450 R0 FMAX M91", "L B-30 C+20 FMAX",
        "- PLANE AXIAL B-30 STAY", "+ PLANE AXIAL B-30 C+20 STAY",
        "PLANE RESET STAY", "L B+0 C+0 FMAX", on="mikron_600u"),
    _in("NC220 amode_digit_unknown", "G0 Z50", "F100",
        "- MCALL CYCLE83(10,0,3,-15,,,5,90,0,0,1,0,3,0,1,0,0,0,1,211112)",
        "+ MCALL CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,1)", "X10 Y0", "MCALL"),
    _known("NC220 projected_angles_unknown", "PLANE PROJECTED PROPR+5 PROMIN+0 ROT+0 STAY", "[control]",
           '+ projected_angles = "turning"', on="mikron_600u"),
    _in("NC210 radius_of_holes", "G98 G81 Z-5. R2. F100. L0", "- G70 I-5. J0. L2", "+ G70 I5. J180. L2", "G80",
        on="haas_umc750"),
    _in("NC210 holes_in_one_place", "G98 G81 Z-5. R2. F100. L0", "- G71 I5. J0. K0. L2", "+ G71 I5. J0. K90. L2",
        "G80", on="haas_umc750"),
    _in("NC343 unconfirmed", "Z0. F100", "G41", "X10. Y0.", "X20.", "- G18", "X30.", "G40", "X40. Y9.", on=_FIDIA),
    _file("NC351", "G21 G90 G94 G54", "T5 M6", "S500 M3", "G0 X1 Y1 Z5", "G1 X2 F100", "- G20", "M2", on=_LINUXCNC),
    _file("NC351 noted", "G21 G90 G94 G54", "T5 M6", "S500 M3", "G0 X1 Y1 Z5", "- G10 L2 P2 X5", "G1 X2 F100", "M2",
          on=_LINUXCNC),
    _in("NC360", "TOFFL=-5", "G1 X10 F100", "TOFFL=0"),
    _file("NC361", "BEGIN PGM A MM", "- TOOL CALL 5 X S500", "+ TOOL CALL 5 Z S500", "L X+0 Y+0 Z+50 R0 FMAX M3",
          "L X+10 F100", "M30", "END PGM A MM", on=_TNC),
    _in("NC362", "T3", "G1 X10. F100.", on=_FIDIA),
    _in("NC380", "G1 F100", "- CYCLE81()", "+ CYCLE81(10,0,3,-6)", "G1 X10"),
    _in("NC380 two_pitches", "- CYCLE84(9.,0.,1.,-9.,,,3,8,1.,0.,500,500)",
        "+ CYCLE84(9.,0.,1.,-9.,,,3,,1.,0.,500,500)", "M3 S500", "G1 X10 F100"),
    _in("NC382", "TRAORI", "G54", "- ROT Y90", "G1 F100", "CYCLE81(10,0,3,-6)", "G1 X10", "TRAFOOF", "G54"),
)  # fmt: skip
