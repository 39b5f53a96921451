"""Pieces of the two languages, and programs and CL files built from them.

A template is text with holes, ``<n>`` for a number and so on. The caller chooses what fills them: Hypothesis in the
tests, a seeded random number generator in the campaign.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Final

from trunnion.readers.families.sinumerik import words
from trunnion.readers.families.sinumerik.cycles import CYCLES
from trunnion.readers.families.sinumerik.expressions import FUNCTIONS

#: Chooses one of several texts.
Pick = Callable[[Sequence[str]], str]

_HOLE = re.compile(r"<([a-z]+)>")

#: Holes inside holes are filled with the first choice from this depth on: it never has a hole.
_DEEPEST: Final = 5

_NAMES: Final = tuple(
    sorted(
        words.WITHOUT_PATH_EFFECT | words.WITHOUT_PATH_EFFECT_VALUES | words.WITHOUT_PATH_EFFECT_CALLS |
        words.NOT_SIMULATED | words.ORIENTATION | words.FRAMES | words.FLOW | words.TYPES | words.POSITION_MODES |
        words.ACTIVE | set(words.CONSTANTS) | set(CYCLES) | set(FUNCTIONS)
    )
)  # fmt: skip

NC: Final[Mapping[str, Sequence[str]]] = {
    "n": (
        "1", "0", "-1", "12.5", "-.25", "90", "360", "1000", "99999", "1EX7", "-1EX300", "1EX-320",
        "99999999999999999",
    ),
    "e": (
        "1", "0", "-7.5", "R1", "R[2]", "_I", "_A[1]", "TRUE", "$PI", "R1+1", "-<e>", "(<e>+<e>)", "(<e>)/(<e>)",
        "<e>*1EX200", "<f>(<e>)", "<f>(<e>,<e>)", "<e> MOD <e>", "<e> DIV <e>", "NOT <e>", "B_NOT <e>",
        "<e> B_AND <e>", "AC(<e>)", "IC(<e>)", "DC(<e>)", "ACP(<e>)", "ACN(<e>)", "<t>", "<t><<<e>", "$P_AXN1",
        "'HFF'", "<n>", "_NOBODY", "<e>==<e>", "<e><><e>", "<e> AND <e>", "BOUND(<e>,<e>,<e>)",
    ),
    "f": tuple(sorted(FUNCTIONS)),
    "t": (
        '"A"', '"MARK"', '""', '"SUB"', '"../SUB"', '"/etc/passwd"', '"ENDE', '"轮毂"', '"a;b"',
    ),
    "v": (
        "R1", "R2", "R[<e>]", "_I", "_A[<e>]", "_A[1,<e>]", "_NEW", "_S", "R", "$AC_TIME",
    ),
    "l": (
        "MARK", "ENDE", "N10", "N20", "NOWHERE", "_S", "10", "N",
    ),
    "p": (
        "SUB", "L10", "PAR(<e>,<e>)", "PAR", "MAIN", "MISSING", "EXTCALL(<t>)", 'CALL "SUB"', "L10 P<n>", "SUB P=<e>",
    ),
    "a": (
        "X", "Y", "Z", "B", "C", "A", "U",
    ),
    "g": (
        "G0", "G1", "G2", "G3", "G4", "G17", "G18", "G19", "G40", "G41", "G53", "G54", "G55", "G500", "G64", "G70",
        "G71", "G700", "G710", "G74", "G90", "G91", "G93", "G94", "G95", "G96", "G110", "G<n>",
    ),
    "m": (
        "M3", "M4", "M5", "M6", "M7", "M8", "M9", "M0", "M1", "M17", "M30", "M2=3", "M<n>", "SPOS=<e>",
    ),
    "w": _NAMES,
    "c": (
        "CYCLE81(<n>,<n>,<n>,<n>,<n>)", "CYCLE82(<n>,<n>,<n>,<n>,,<n>)", "CYCLE83(50,0,2,-20,,-5,,2,0,0,1,1)",
        "CYCLE83(<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>)",
        "CYCLE84(50,0,2,-20,,<n>,3,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>)", "CYCLE840(50,0,2,-20,,0,4,3,0,,<n>)",
        "CYCLE85(<e>,0,2,-20,,0,<n>,<n>)", "CYCLE86(50,0,2,-20,,1,3,<n>,<n>,<n>,0)", "CYCLE87(50,0,2,-20,,0,3)",
        "CYCLE89(50,0,2,-20,,1)", "CYCLE832(<n>,_ORI_ROUGH,1)", "CYCLE800()", 'CYCLE800(,"0",<n>)',
        'CYCLE800(0,"T",200000,57,<n>,0,0,<n>,<n>,0,0,0,<n>,-1)',
        'CYCLE800(1,"T",<n>,<n>,<n>,<n>,<n>,<n>,<n>,<n>,0,0,0,<n>)',
        'CYCLE800(0,"T",100001,192,0,0,0,<n>,<n>,0,0,0,0,1)', "CYCLE81(<t>)", "CYCLE83()", "MSG(<t>)", "SETAL(<e>)",
    ),
    "line": (
        "X<n> Y<n>", "N<n> G1 X<n> Y<n> Z<n> F<n>", "<a><n>", "<a>=<e> <a>=<e>", "G1 <a><n> <a>=<e> F=<e>",
        "<g> <a><n>", "<g> <g> X<n>", "X<n> A3=<n> B3=<n> C3=<n>", "A3=<e> C3=1", "B<n> C<n>", "C=DC(<e>) B=IC(<e>)",
        "G2 X<n> Y<n> I<n> J<n>", "G3 X<n> CR=<n>", "G3 X=<e> Y<n> AR=<e> TURN=<n>", "G2 I<n> J=AC(<e>) AR=<n>",
        "CIP X<n> Y<n> I1=<e> J1=<e> K1=<e>", "G2 X<n> Z<n> I<n> K<n> TURN=<n>", "G4 F<n>", "G4 S<n>", "TRAORI",
        "TRAORI(<e>)", "TRAFOOF", "ORIWKS", "ORIMKS", "ORIAXES", "ORIVECT", "<w>", "<w>=<e>", "<w>(<e>,<t>)",
        "<w>[<e>]=<e>", "TRANS X<n> Y<n>", "ATRANS Z<n>", "ROT X<n> Y<n> Z<n>", "AROT RPL=<e>", "SCALE X<n> Y<n>",
        "ASCALE X<n>", "MIRROR X0", "AMIRROR Y0", "ROT", "<m>", "<m> <m> <m>", "S<n> <m>", "S2=<n>", "T<n> D<n>",
        "T=<t>", "T=<e>", "T1 M6", "D<n>", "H<n>", "SUPA G0 Z<n>", "SUPA <a><n> <a><n>", "G0 G53 X<n>", "<v>=<e>",
        "R1=R1+1", "<c>", "MCALL <c>", "MCALL SUB", "MCALL L10", "MCALL", "<p>", "<p>",
        "DEF REAL _A[<n>]=SET(<e>,<e>)", "DEF INT _I=<e>", "DEF STRING[8] _S=<t>", "DEF <w> _B",
        "PROC X(REAL _A, INT _I=<e>)", "EXTERN PAR(REAL)", "GOTOF <l>", "GOTOC <l>", "GOTO <l>", "GOTOB <l>", "GOTOS",
        "IF <e> GOTOF <l>", "IF <e>==<e> GOTO <l>", "CASE <e> OF <e> GOTOF <l> DEFAULT GOTOC <l>", "REPEAT <l> P=<e>",
        "MARK: X<n>", "N10 <c>", "/<g> X<n>", "/3 N20 X1", "%_N_MAIN_MPF", ";<t>", "X<n> ;<t>", "RET", "M17", "",
        "STOPRE", "X<n> X<n>", "I<n>", "P<n>", "UNTIL <e>", "ELSE",
    ),
    "open": (
        "IF <e>", "WHILE <e>", "LOOP", "FOR R1=<e> TO <e>", "FOR _I=<e> TO <e>", "FOR R=<e> TO <e>", "REPEAT",
        "IF R1<3",
    ),
}  # fmt: skip

CL: Final[Mapping[str, Sequence[str]]] = {
    "n": (
        "1.0", "0.0", "-1.0", "0.5", "12.345678", "100.", "1e300", "-1E12", "1.5D3", "nan", "inf", "", "A",
        "999999999999999999999", ".000000000000000000000001", *("1", "2.5", "2", "7.0", "31", "186") * 7,
    ),
    "u": (
        "0.0,0.0,1.0", "1.0,0.0,0.0", "0.0,0.0,0.0", "0.0,0.0,1.02", "<n>,<n>,<n>",
        *("0.6,0.0,0.8", "0.0,-1.0,0.0") * 6,
    ),
    "f": (
        "MMPM", "MMPR", "IPM", "IPR", "RAPID", "X",
    ),
    "x": (
        "T", "", "轮毂", "A,TOOL,B", "$$", "a$",
    ),
    "bad": (
        "END-OF-PATH", "TOOL PATH/<x>,TOOL,<x>", "GOTO/1.0,2.0,$", "$", "NURBS/<n>", "TRANS/<n>", "UNITS/<n>",
        "MSYS/<n>,<n>,<n>,<u>,<u>", "MSYS/0,0,0,1,0,0,0,1,0", "GOTO/<n>,<n>", "CIRCLE/<n>,<n>,<n>,<u>,<n>",
        "SPINDL/ON", "CYCLE/ON", "GOHOME/<x>", "<x>/<n>", "\x1a", "UNITS/INCHES",
    ),
    "line": (
        "<bad>", "GOTO/<n>,<n>,<n>", "GOTO/<n>,<n>,<n>,<u>", "GODLTA/<n>,<n>,<n>", "GOHOME", "GOHOME/<n>,<n>,<n>",
        "FROM/<n>,<n>,<n>", "FROM/<n>,<n>,<n>,<u>", "RAPID", "RAPID/<n>", "FEDRAT/<f>,<n>", "FEDRAT/<n>",
        "CIRCLE/0,0,0,0,0,1,5,<n>,<n>,<n>,<n>\nGOTO/5,0,0", "CIRCLE/0,0,0,<u>,5,TIMES,<n>\nGOTO/5,0,0",
        "SPINDL/RPM,<n>,CLW", "SPINDL/<n>,SFM,CCLW", "SPINDL/OFF", "SPINDL/SMM,<n>,DIAMTR,<n>", "LOAD/TOOL,<n>",
        "LOAD/TOOL,<n>,ADJUST,<n>", "SELECT/TOOL,<n>", "COOLNT/<x>", "COOLNT/ON", "CUTCOM/LEFT,<n>", "CUTCOM/OFF",
        "CYCLE/DRILL,RAPTO,<n>,FEDTO,<n>,<f>,<n>", "CYCLE/DEEP,STEP,<n>,<n>,DWELL,REV,<n>", "CYCLE/OFF",
        "CYCLE/<x>,<n>,<x>", "DELAY/<n>", "DELAY/<n>,REV", "STOP/<x>", "OPSTOP", "PPRINT/<x>", "INSERT/<x>",
        "DISPLY/<x>", "OPSKIP/ON", "SET/<x>,<n>", "MODE/<n>", "MULTAX/ON", "PAINT/COLOR,<n>", "PAINT/PATH",
        "PAINT/COLOR,31", "MACHIN/<x>", "TLDATA/MILL,<n>,<n>,<n>,<n>,<n>", "TLDATA/DRILL,MILL,<n>,<n>,<n>,<n>,<n>",
        "TLDATA/<x>,<n>", "TLDATA/MILL,10,1,50,0,0", "UNITS/MM", "INTOL/<n>", "OUTTOL/<n>", "PARTNO/<x>", "<x>",
        "GOTO/<n>,$\n<n>,<n>", "GOTO/1,2,3 $$ <x>", "g o t o / 1 , 2 , 3", "$", "$$<x>", "FINI", "",
    ),
}  # fmt: skip

_CLOSES: Final = {"IF": "ENDIF", "WHILE": "ENDWHILE", "LOOP": "ENDLOOP", "FOR": "ENDFOR", "REPEAT": "UNTIL <e>"}


def fill(template: str, table: Mapping[str, Sequence[str]], pick: Pick, depth: int = 0) -> str:
    """Fill the holes of a template."""

    def hole(match: re.Match[str]) -> str:
        choices = table[match.group(1)]
        chosen = choices[0] if depth >= _DEEPEST else pick(choices)
        return fill(chosen, table, pick, depth + 1)

    return _HOLE.sub(hole, template)


def program(lines: int, pick: Pick) -> str:
    """Return an NC program of about this many lines, with control structures around some of them."""
    made: list[str] = []
    open_: list[str] = []
    for _ in range(lines):
        what = pick(("line", "line", "line", "line", "line", "line", "open", "close"))
        if what == "line":
            made.append(fill("<line>", NC, pick))
        elif what == "open":
            begin = pick(NC["open"])
            open_.append(_CLOSES[begin.partition(" ")[0]])
            made.append(fill(begin, NC, pick))
        elif open_:
            made.append(fill(open_.pop(), NC, pick))
    made += [fill(end, NC, pick) for end in reversed(open_)]
    return "\n".join(made) + "\n"


def cl_file(lines: int, pick: Pick) -> str:
    """Return a CL file of one operation with about this many statements between valid ones."""
    made = [fill("<line>", CL, pick) for _ in range(lines)]
    return "\n".join(("TOOL PATH/OP,TOOL,T1", "TLDATA/MILL,10,1,50,0,0", "GOTO/0,0,9,0,0,1", *made, "END-OF-PATH", ""))
