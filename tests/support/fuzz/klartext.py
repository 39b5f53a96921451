"""Klartext programs for the fuzz tests: pieces to build them from, and valid ones to mangle."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from tests.support.fuzz import oracle, pieces
from trunnion.readers.families.heidenhain import words
from trunnion.readers.families.heidenhain.parameters import FUNCTIONS

#: Machines that the programs run on: two tables, two heads, a head at 45 degrees.
MACHINES: Final = ("dmu65", "mikron_600u", "generic_head_head_ca", "generic_nutated_b45_c")

judge = partial(oracle.judge_program, family="heidenhain_tnc640")

SUBPROGRAMS: Final[Mapping[str, str]] = {
    "SUB.H": "0 BEGIN PGM SUB MM\n1 L IX+1 FMAX\n2 QL1 = 5\n3 QL1 = QL1 + 1\n4 END PGM SUB MM\n",
    "SELF.H": "0 BEGIN PGM SELF MM\n1 CALL PGM SELF.H\n2 END PGM SELF MM\n",
    "INCH.H": "BEGIN PGM INCH INCH\nL X+1 F100\nEND PGM INCH INCH\n",
}

PIECES: Final[Mapping[str, Sequence[str]]] = {
    "n": (
        "+1", "0", "-1", "12.5", "-.25", "+7,5", "90", "-360", "1000", "99999", "9999999", "123456789012345678", "+Q1",
        "-Q2", "Q3", "QL1", "QR5", "+Q99", "",
    ),
    "u": ("1", "0", "5", "99", "200", "Q1", "65536"),
    "x": ("X", "Y", "Z", "A", "B", "C", "U", "IX", "IY", "IZ", "IC", "IB", "PR", "PA", "IPA", "IPR"),
    "f": ("FMAX", "F<n>", "F AUTO", "F500", "R0", "RL", "RR", ""),
    "m": (
        "M3", "M5", "M8", "M9", "M13", "M30", "M99", "M89", "M91", "M92", "M126", "M127", "M128", "M128 F3000", "M129",
        "M140 MB MAX", "M140 MB<n>", "M116", "M136", "M137", "M138 A C", "M118 X1 Y1", "M0", "M1", "M2", "M<u>", "",
    ),
    "d": ("DR+", "DR-", ""),
    "e": (
        "1", "Q1", "QL2", "<e> + <e>", "<e> * <e>", "(<e> - <e>)", "<e> / <e>", "<e> ^ <e>", "<w> <e>", "- <e>", "PI",
        "<n>", "<e> % <e>", "Q120", "QS1",
    ),
    "w": tuple(sorted(FUNCTIONS)),
    "l": ("1", "2", "7", '"MARK"', "0", "Q1", "99"),
    "o": ("EQU", "NE", "GT", "LT"),
    "p": (
        "TURN FMAX", "TURN F<n> SEQ-", "STAY", "MOVE ABST<n> FMAX SEQ+", "MOVE DIST0 F500", "TURN MB MAX FMAX SEQ-",
        "TURN MB<n> FMAX SYM+", "STAY TABLE ROT", "TURN COORD ROT", "",
    ),
    "q": ("200", "201", "202", "203", "204", "205", "206", "207", "208", "209", "240", "241", "256", "999"),
    "b": (*sorted(words.BLOCKS_NOT_SIMULATED), "SUPER", "LT", "BLK FORM 0.1 Z X<n>", "FUNCTION FEED"),
    "line": (
        "L X<n> Y<n> <f>", "L X<n> Y<n> Z<n> <f> <m>", "<u> L Z<n> <f>", "L <x><n> <x><n> <f> <m>", "L <x><n>",
        "L A<n> C<n> <f>", "LN X<n> Y<n> Z<n> TX<n> TY<n> TZ<n> <f> <m>", "LN X<n> NX<n> NY<n> NZ<n>", "CC X<n> Y<n>",
        "CC IX<n>", "CC", "C X<n> Y<n> <d> <f>", "C <d>", "CR X<n> Y<n> R<n> <d> <f>", "CT X<n> Y<n>", "CTP PA<n>",
        "CP IPA<n> IZ<n> <d>", "CP PA<n> <d>", "LP PR<n> PA<n> <f>", "LP <x><n>", "L <m>", "<m> <m>", "STOP <m>",
        "TOOL CALL <u> Z S<n> F<n> DL<n> DR<n>", 'TOOL CALL "MILL" Y', "TOOL CALL Z S<n>", "TOOL DEF <u> L<n> R<n>",
        "CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X<n> Y<n>", "CYCL DEF 7.0\nCYCL DEF 7.1 X<n>\nCYCL DEF 7.2 IZ<n>",
        "CYCL DEF 7.0\nCYCL DEF 7.1 #<u>", "CYCL DEF 8.0\nCYCL DEF 8.1 X Y", "CYCL DEF 8.0\nCYCL DEF 8.1",
        "CYCL DEF 10.0\nCYCL DEF 10.1 ROT<n>", "CYCL DEF 11.0\nCYCL DEF 11.1 SCL<n>", "CYCL DEF 11.1 SCL0.5",
        "CYCL DEF 26.0\nCYCL DEF 26.1 X<n> Y<n> CCX<n>", "CYCL DEF 19.0\nCYCL DEF 19.1 A<n> B<n> C<n>",
        "CYCL DEF 19.0\nCYCL DEF 19.1", "CYCL DEF 9.0\nCYCL DEF 9.1 DWELL<n>",
        "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.02", "CYCL DEF 13.0\nCYCL DEF 13.1 ANGLE<n>",
        "CYCL DEF 247 DATUM ~\nQ339=<u>", "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 DIST2\nCYCL DEF 1.2 DEPTH<n>\n"
        "CYCL DEF 1.3 PLNGNG<n>\nCYCL DEF 1.4 DWELL0\nCYCL DEF 1.5 F<n>",
        "CYCL DEF <u>.<u> <n>", "CYCL DEF <q> NAME ~\nQ200=<n> ;C ~\nQ201=<n> ~\nQ206=<n> ~\nQ202=<n> ~\nQ203=<n>",
        "CYCL DEF <q> Q200=2 Q201=-20 Q206=150 Q202=5 Q203=0 Q204=50 Q239=1 Q257=3 Q256=.2 Q212=.5 Q205=1 Q258=1 "
        "Q259=<n> Q379=<n> Q249=5 Q250=20 Q251=15 Q252=3.5 Q253=750 Q254=200 Q255=0 Q214=<n> Q208=<n> Q213=<n>",
        "CYCL CALL", "CYCL CALL POS X<n> Y<n> Z<n> FMAX", "CYCL CALL PAT", "CYCL CALL M3",
        "PLANE SPATIAL SPA<n> SPB<n> SPC<n> <p>", "PLANE SPATIAL SPA-30 SPB0 SPC45 <p>", "PLANE RESET <p>",
        "PLANE VECTOR BX1 BY0 BZ0 NX<n> NY<n> NZ1 <p>", "PLANE EULER EULPR<n> EULNU<n> EULROT<n> <p>",
        "PLANE POINTS P1X0 P1Y0 P1Z<n> P2X<n> P2Y1 P2Z0 P3X0 P3Y<n> P3Z1 <p>", "PLANE RELATIV SPB<n> <p>",
        "PLANE AXIAL A<n> C<n> <p>", "PLANE PROJECTED PROPR1 PROMIN2 ROT3 <p>", "PLANE", "FUNCTION TCPM F TCP AXIS POS",
        "FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR", "FUNCTION RESET TCPM", "L A<n> B<n> C<n> <f>", "Q1 = <e>",
        "QL2 = <e>", "Q<u> = <e>", "FN 0: Q1 = <n>", "FN 1: Q1 = <n> + <n>", "FN 4: Q2 = <n> DIV <n>",
        "FN 8: Q5 = <n> LEN <n>", "FN 13: Q5 = <n> ANG <n>", "FN 5: Q1 = SQRT <n>", "FN 9: IF <n> <o> <n> GOTO LBL <l>",
        "FN <u>: IF <n> EQU <n> GOTO LBL <l>", "FN 18: SYSREAD Q3 = ID270 NR1 IDX1", "FN 15: PRINT Q1", "LBL <l>",
        "LBL <l>", "LBL 0", "CALL LBL <l>", "CALL LBL <l> REP <u>", "CALL LBL 1 REP 3/3", "CALL PGM SUB.H",
        "CALL PGM TNC:\\A\\INCH", "CALL PGM SELF", "CALL PGM ../SECRET", "CALL PGM", "END PGM X MM", "BEGIN PGM X INCH",
        "BLK FORM 0.2 X<n> Y<n> Z<n>", "/ L X<n>", "* - structure", "; comment ~", "L X<n> ; c", "L X<n> ~", "<b>",
        "<b> X<n>", "", "L", "Q200=<n> ~", "RND R<n>",
    ),
}  # fmt: skip

SOUND: Final[tuple[bytes, ...]] = (
    b"""0 BEGIN PGM PLATE MM
1 BLK FORM 0.1 Z X+0 Y+0 Z-30
2 BLK FORM 0.2 X+100 Y+80 Z+0
3 TOOL CALL 5 Z S3500 F800 DL+0.1
4 L Z+100 R0 FMAX M3
5 L X+10 Y-5,5 R0 FMAX M8 ; hello
6 L Z-1 F AUTO
7 CC X+50 Y+0
8 C X+90 Y+5.5 DR+ F500
9 CP IPA+720 IZ-4 DR+
10 CYCL DEF 200 DRILLING ~
   Q200=2 ;SET-UP CLEARANCE ~
   Q201=-15 ;DEPTH ~
   Q206=150 ~
   Q202=5 ~
   Q210=0 ~
   Q203=+0 ~
   Q204=50 ~
   Q211=0.5
11 L X+1 Y+2 R0 FMAX M99
12 LBL 1
13 L IX+1 FMAX M99
14 CALL LBL 1 REP 3
15 CALL LBL "END"
16 CALL PGM SUB.H
17 M30
18 LBL "END"
19 Q1 = 3 + SQ 2 - SIN 30
20 FN 12: IF +Q1 LT +100 GOTO LBL 9
21 LBL 9
22 LBL 0
23 END PGM PLATE MM
""",
    b"""0 BEGIN PGM TILT MM
1 TOOL CALL "BALL_6" Z S9000
2 CYCL DEF 7.0 DATUM SHIFT
3 CYCL DEF 7.1 X+10
4 CYCL DEF 7.2 Z-5
5 PLANE SPATIAL SPA-45. SPB+0.0 SPC-90. TURN FMAX SEQ-
6 L X+0 Y+0 Z+10 R0 FMAX
7 CR X+10 Y+0 R+8 DR- F300
8 PLANE RELATIV SPA-5 MOVE DIST10 FMAX
9 L X+1 Y+2 Z+3
10 PLANE RESET STAY
11 CYCL DEF 32.0 TOLERANCE
12 CYCL DEF 32.1 T0.02
13 M126
14 M128 F1000
15 L X+1 Y+2 Z+30 A-30 C+45 F500
16 LN X+1 Y+3 Z+30 TX+0.1 TY-0.2 TZ+0.97
17 M129
18 M127
19 L Z+0 R0 FMAX M91
20 L A+0 C+0 FMAX
21 FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR
22 L X+0 Y+0 Z+50 A-20 B+10 C+0
23 FUNCTION RESET TCPM
24 L M140 MB MAX
25 END PGM TILT MM
""",
)


def prepare(folder: Path) -> None:
    """Put the subprograms into a folder."""
    for name, text in SUBPROGRAMS.items():
        (folder / name).write_text(text)


def program(lines: int, pick: pieces.Pick) -> str:
    """Return a program of about this many blocks."""
    return "\n".join(pieces.fill("<line>", PIECES, pick) for _ in range(lines)) + "\n"
