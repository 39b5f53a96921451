"""Cures of messages about NC programs, verified alone."""

from typing import Final

from tests.support.cures.cure import Change, Cure, verify
from tests.support.program_heads import HEADS


def _said(code: str, variant: str, text: str, *changes: Change, on: str = "yl569", **settings: str) -> Cure:
    return Cure(code, variant, verify(on), text, changes, settings)


def _line(code: str, variant: str, line: str, cured: str, on: str = "yl569") -> Cure:
    """A line within a program, and what stands in its place."""
    return _said(code, variant, HEADS[on].format(lines=line), (f"{line}\n", cured and f"{cured}\n"), on=on)


_SINUMERIK: Final = HEADS["yl569"].format(lines="G1 X10 F100")
_FANUC: Final = HEADS["matsuura_mx330"].format(lines="G1 X10. F100.")
_KLARTEXT: Final = HEADS["mikron_600u"].format(lines="L X+10 F100")
_DRILLING: Final = (
    "CYCL DEF 200 DRILLING Q200=+2 Q201=-5 Q206=+100 Q202=+5 Q210=+0 Q203=+0 Q204=+20 Q211=+0\nL X+5 FMAX M99"
)
_PECKING: Final = (
    "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 DIST +2\nCYCL DEF 1.2 DEPTH -5\nCYCL DEF 1.3 PLNGNG +5\nCYCL DEF 1.4 DWELL +0\n"
    "CYCL DEF 1.5 F100\nL X+5 FMAX M99"
)
_LINUXCNC: Final = HEADS["xyzac_trt"].format(lines="G1 X10 F100")

CURES: Final = (
    _line("NC210", "word_in_title", _DRILLING.replace("DRILLING", "DRILLING M8"), f"M8\n{_DRILLING}", on="mikron_600u"),
    _line(
        "NC220", "arc_at_rapid", "CC X+5 Y+0\nC X+10 Y+0 DR+ FMAX", "CC X+5 Y+0\nC X+10 Y+0 DR+ F100", on="mikron_600u"
    ),
    _line(
        "NC221",
        "cycle_19_turns",
        "CYCL DEF 19.0 TILT\nCYCL DEF 19.1 A+0 B+0 C+0 F900",
        "L C+0 F900\nCYCL DEF 19.0 TILT\nCYCL DEF 19.1 A+0 B+0 C+0",
        on="mikron_600u",
    ),
    _said(
        "NC160",
        "end_pgm_in_other_unit",
        _KLARTEXT.replace("END PGM A MM", "END PGM A INCH"),
        ("END PGM A INCH", "END PGM A MM"),
        on="mikron_600u",
    ),
    _line("NC222", "", "IF $A_IN[1]==1 GOTOF ON\nG1 X10 F100\nON:", "G1 X10 F100"),
    _line("NC143", "", "IF R9==1\nENDIF", "R9=2\nIF R9==1\nENDIF"),
    _line("NC215", "speed_below_zero", "S-500", "S500"),
    _line("NC215", "beyond_turn", "G1 C=DC(440.5) F100", "G1 C=DC(80.5) F100"),
    _line(
        "NC215",
        "cycle800_retracts_into_part",
        'CYCLE800(5,"",0,57,0,0,0,0,0,0,0,0,0,1,-50)',
        'CYCLE800(5,"",0,57,0,0,0,0,0,0,0,0,0,1,50)',
    ),
    _line("NC216", "two_times", "G4 F1 S5", "G4 F1"),
    _line(
        "NC351",
        "ends_other_mode",
        "G5 P10000\nG1 X10. F100.\nG5.1 Q0",
        "G5 P10000\nG1 X10. F100.\nG5 P0",
        on="matsuura_mx330",
    ),
    _line(
        "NC341", "ended_by_other", "M128\nL X+10 F100\nFUNCTION RESET TCPM", "M128\nL X+10 F100\nM129", on="mikron_600u"
    ),
    _line("NC160", "endproc_without_proc", "ENDPROC", ""),
    _line("NC212", "behind_statement", "R1=1\nIF R1==1\nENDIF M8", "R1=1\nIF R1==1\nENDIF\nM8"),
    _line("NC212", "alone_in_block", "G4 F0.5 M8", "G4 F0.5\nM8"),
    Cure("NC113", "is_kind_by_one", verify("yl569"), _KLARTEXT, (), cured_by=verify("mikron_600u")),
    _said("modal", "", _SINUMERIK.replace(" F100", ""), ("G1 X10", "G1 X10 F100")),
    _said("modal", "", _SINUMERIK.replace(" M3", ""), ("S500", "S500 M3")),
    _said("modal", "", _SINUMERIK.replace("M30\n", ""), ("G1 Z5 F100\n", "G1 Z5 F100\nM30\n")),
    _said(
        "modal",
        "",
        _SINUMERIK.replace("G1 Z5 F100\n", "G0 Z50\nT6 M6\nG0 X0 Y0 Z50 D1\nM3 S500\nG1 Z5 F100\n"),
        ("T6 M6", "M5\nT6 M6"),
    ),
    _said("modal", "", _LINUXCNC.replace("G21 ", ""), ("G90 G94", "G21 G90 G94"), on="xyzac_trt"),
    _said("modal", "", _FANUC.replace("G21 ", ""), ("G90 G94", "G21 G90 G94"), on="matsuura_mx330"),
    _said("modal", "", _FANUC.replace(" F100.", ""), ("G1 X10.", "G1 X10. F100."), on="matsuura_mx330"),
    _said("modal", "", _FANUC.replace(" M3", ""), ("S500", "S500 M3"), on="matsuura_mx330"),
    _said("modal", "", _KLARTEXT.replace(" M3", ""), ("FMAX", "FMAX M3"), on="mikron_600u"),
    _said("modal", "", _SINUMERIK.replace("G1 Z5", "G93\nG1 X11 F2\nG1 X12\nG94\nG1 Z5"), ("G1 X12\n", "G1 X12 F2\n")),
    _said("rpm", "", _SINUMERIK.replace("S500", "S90000"), ("S90000", "S5000")),
    _said("travel", "", _SINUMERIK.replace("X10 F100", "X10 F100\nG0 G153 Z900 D0\nG0 Z50 D1"), ("Z900", "Z100")),
    _line("NC352", "offset_over_unknown_zero", "G10 L2 P1 X9. Y-5. Z-60.\nG54", "G54", on="matsuura_mx330"),
    _said("NC132", "unknown_or_missing", _SINUMERIK.replace("G1 X10", "MCALL HOLES\nG1 X10"), ("MCALL HOLES\n", "")),
    _said(
        "NC170",
        "",
        f"MADE ON MONDAY\n{_FANUC}",
        ("MADE ON MONDAY\n", "(MADE ON MONDAY)\n"),
        on="matsuura_mx330",
    ),
    _said(
        "NC168",
        "program_begins_without_number",
        _FANUC.replace("O0001", "(PART)"),
        ("(PART)", "O0001 (PART)"),
        on="matsuura_mx330",
    ),
    _line("NC210", "", "G1 X1..5 F100", "G1 X1.5 F100"),
    _line("NC380", "depth_above_surface", _DRILLING.replace("Q201=-", "Q201=+"), _DRILLING, on="mikron_600u"),
    _line("NC380", "depth_above_surface", _PECKING.replace("DEPTH -", "DEPTH +"), _PECKING, on="mikron_600u"),
    _line("NC221", "foreign_parameters", _DRILLING.replace("+0\nL", "+0 Q258=+1\nL"), _DRILLING, on="mikron_600u"),
    _line(
        "NC343",
        "side_without_r0",
        "L X+9 RL F100\nL X+8 RR\nL X+7 R0",
        "L X+9 RL F100\nL X+8 R0\nL X+7 RR\nL X+6 R0",
        on="mikron_600u",
    ),
    _line(
        "NC221",
        "q_without_sign",
        "G98 G73 X1. Z-10. R2. Q-2. F100.\nG80",
        "G98 G73 X1. Z-10. R2. Q2. F100.\nG80",
        on="matsuura_mx330",
    ),
    _line(
        "NC221",
        "bore_without_shift",
        "G98 G76 X1. Z-10. R2. F100.\nG80",
        "G98 G76 X1. Z-10. R2. Q.5 F100.\nG80",
        on="matsuura_mx330",
    ),
    _line("NC380", "clearance_below_zero", _DRILLING.replace("Q200=+", "Q200=-"), _DRILLING, on="mikron_600u"),
    _line(
        "NC210", "parameter_of_cycle_twice", _DRILLING.replace("+0\nL", "+0 Q201=-6\nL"), _DRILLING, on="mikron_600u"
    ),
    _line("NC211", "unknown_g_word", "G777", ""),
    _line("NC212", "twice_in_block", "G1 X10 X20 F100", "G1 X20 F100"),
    _line("NC223", "", "G1 X=R7 F100", "R7=10\nG1 X=R7 F100"),
    _line("NC223", "no_value_in_program", "G1 X=R7 F100", "R7=10\nG1 X=R7 F100"),
    _line("NC230", "", "G1 A5 F100", "G1 B5 F100"),
    _line("NC320", "", "G2 X10 Y10 F100", "G2 X10 Y10 CR=8 F100"),
    _line("NC320", "", "G2 X10. Y10. F100.", "G2 X10. Y10. R8. F100.", on="matsuura_mx330"),
    _line("NC133", "", "GOTOF NOWHERE", "GOTOF NOWHERE\nNOWHERE:"),
    _line("NC142", "", "IF 1==2", "IF 1==2\nENDIF"),
    _line("NC142", "skip_of_part", "IF 1==2\n/ENDIF", "IF 1==2\nENDIF"),
    _line("NC218", "", "G4", "G4 F1"),
    _said("NC161", "", _SINUMERIK + "G0 X0\n", ("M30\nG0 X0\n", "M30\n")),
    _said("NC161", "another_program", _SINUMERIK.replace("G1 Z5", "M30\nG1 Z5"), ("M30\nG1 Z5", "G1 Z5")),
    _said(
        "NC163",
        "doubled_label",
        _KLARTEXT.replace("L Z+5 F100", "LBL 1\nLBL 0\nLBL 1\nLBL 0\nL Z+5 F100"),
        ("LBL 0\nLBL 1\n", "LBL 0\nLBL 2\n"),
        on="mikron_600u",
    ),
    _said("NC112", "file_empty", "", ("", _SINUMERIK)),
    _said("NC185", "nothing_moves", "G54\nM30\n", ("G54\nM30\n", _SINUMERIK)),
    _said(
        "NC112",
        "cl_file_for_program",
        "TOOL PATH/A,TOOL,D\nGOTO/0,0,0\nEND-OF-PATH\n",
        ("TOOL PATH/A,TOOL,D\nGOTO/0,0,0\nEND-OF-PATH\n", _SINUMERIK),
    ),
    _said("NC110", "line_ends_of_cr", _SINUMERIK.replace("\n", "\r"), ("\r", "\n")),
)
