"""Programs for LinuxCNC, Fanuc and Fidia for the fuzz tests: pieces to build them from, and valid ones to mangle."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tests.support.fuzz import oracle, pieces
from tests.support.locations import GOLDEN
from trunnion.machines import Machine
from trunnion.model.run import Run

_NUMBERS: Final = (
    "1", "0", "-1", "12.5", "-.25", "+7.", "90.", "-360", "1000", "99999", "9999999", "123456789012345678", ".",
    "-", "",
    *("2.", "3.5", "-4.", "10.") * 4,
)  # fmt: skip

_SHARED: Final = (
    "<g> X<n> Y<n>", "N<u> G1 X<n> Y<n> Z<n> F<n>", "G0 <x><n> <x><n>", "<x><n>", "<g> <g> <x><n>",
    "G2 X<n> Y<n> I<n> J<n>",
    "G3 X<n> Y<n> R<n>", "G2 I<n> J<n>", "G18 G3 X<n> Z<n> I<n> K<n>", "G1 <x><n> F<n>", "G93 G1 X<n> F<n>",
    "G94 F<n>",
    "G4 P<n>", "G20", "G21", "G90", "G91", "T<u> M6", "S<n> M3", "M8", "M5 M9", "M0", "M<u>", "G<u>", "G<u>.<u>",
    "<x><e>",
    "/G0 X<n>", "(<x>)", "X<n> ;c", "%", "G80", "<l><n> <l><n>", "G53 G0 <x><n>", "", "X<n> X<n>", "M30", "O<u>",
)  # fmt: skip


@dataclass(frozen=True)
class Language:
    """The pieces of a language's programs, and the machines they run on."""

    family: str
    machines: tuple[str, ...]
    pieces: Mapping[str, Sequence[str]]
    sound: tuple[bytes, ...]

    def judge(self, data: bytes, folder: Path, key: str | Machine = "", limit: int = oracle.LIMIT) -> Run | None:
        """Run bytes as a program; None if it is refused."""
        return oracle.judge_program(data, folder, key or self.machines[0], limit, self.family)

    def program(self, lines: int, pick: Callable[[Sequence[str]], str]) -> bytes:
        """A program of valid pieces, put together at random."""
        return "\n".join(pieces.fill("<line>", self.pieces, pick) for _ in range(lines)).encode()


_TABLE: Final[dict[str, Sequence[str]]] = {
    "n": _NUMBERS,
    "u": ("1", "0", "5", "10", "28", "43", "54", "68", "83", "99", "9010", "65536"),
    "x": ("X", "Y", "Z", "A", "B", "C", "U"),
    "l": tuple("ABCDEFHIJKLPQRSTUVW"),
    "g": ("G0", "G1", "G2", "G3", "G17", "G18", "G19", "G40", "G90", "G91", "G54", "G55", "G98", "G99"),
}

LINUXCNC: Final = Language(
    "linuxcnc",
    ("xyzac_trt", "xyzbc_trt", "generic_head_head_ca"),
    {
        **_TABLE,
        "e": (
            "1", "#1", "#<A>", "[<e>]", "[<e>+<e>]", "[<e>*<e>]", "[<e>-<e>]", "[<e>/<e>]", "[<e>**<e>]", "SIN<e>",
            "ATAN[<e>]/[<e>]", "SQRT[<e>]", "##1", "[<e> GT <e>]", "[<e> MOD <e>]", "-<e>", "#[<e>]", "#5420", "<n>",
            "[EXISTS[#<A>]]", "LN[<e>]", "EXP[<e>]",
        ),
        "c": ("if", "while", "do", "repeat", "sub", "endif", "endwhile", "endrepeat", "else", "elseif", "endsub",
        "break"),
        "line": (
            *_SHARED, "#1=<e>", "#<A>=<e> #2=<e>", "G92 <x><n>", "G92.1", "G92.3", "G52 <x><n>",
            "G10 L2 P<u> X<n> R<n>",
            "G10 L20 P1 <x><n>", "G28 <x><n>", "G30", "G28.1", "G43 H<u>", "G49", "M428", "M429", "G90.1", "G91.1",
            "G2 X<n> Y<n> I<n> J<n> P<u>", "G81 X<n> Z<n> R<n> L<u>", "G83 Z-9 R<n> Q<n>", "G73 X<n> Z-5 R1 Q2",
            "G87 Z1 R2",
            "G85 X<n> Z-1 R<n>", "o1 <c> [<e>]", "o<A> <c>", "o1 if [<e>]\nX<n>\no1 endif",
            "o2 repeat [<n>]\nX1\no2 endrepeat",
            "o3 while [#1 LT 5]\n#1=[#1+1]\nX#1\no3 endwhile", "o<A> call [<e>]", "o<B> call [<e>] [<e>]",
            "(MSG,<x>)",
            "G43.1 Z<n>", "G64 P<n>", "G61", "G59.3", "G38.2 Z<n> F<n>", "M61 Q<u>", "M66 P0 L0", "M110", "@5^30",
        ),
    },
    (
        b"%\n(all)\nG21 G90 G17 G40 G49 G94 G64 P.01\nT1 M6\nG54 G43 H1 S900 M3 M8\nM428\nG0 X1 Y2 Z3 A-10 C20\nG93\n"
        b"G1 X2 Y3 Z4 A-11 C21 F2.5\nX3 F3\nG94 F100\nG2 X13 Y3 I5 J0\nG3 X3 Y3 R5\nG18 G2 X13 Z4 I5 K0 P2\nG17\n"
        b"M429\n"
        b"G92 X0\nG92.1\nG10 L2 P1 X1 Y2 R10\nG10 L20 P0 Z5\nG55\nG28 Z50\nG53 G0 Z10\nG4 P1\nM5 M9\nM30\n%\n",
        b"o<b> sub\n#3=[#1+#2]\no10 if [#3 GT 5]\nG0 X#3\no10 elseif [#3 EQ 2]\nG0 Y#3\no10 else\nG0 Z#3\no10 endif\n"
        b"o<b> endsub [#3*2]\n#1=0 #<deep>=-2.5\no1 while [#1 LT 4]\n#1=[#1+1]\no<B> call [#1] [2]\no1 endwhile\n"
        b"o2 repeat [3]\nG91 G0 X1\no2 endrepeat\nG90\no3 do\n#1=[#1-1]\no4 if [#1 EQ 2]\no3 continue\no4 endif\n"
        b"G0 X[SIN[30]*#1] Y[ATAN[1]/[2]] Z[ABS[#<deep>]**2 MOD 3]\no3 while [#1 GT 0]\nM2\n",
        b"G21 G0 X0 Y0 Z20 F100\nM3 S500\nG98 G81 X1 Y1 Z-5 R2\nX2\nG99 G83 X3 Z-9 R1 Q3\nY5 L2\nG73 X4 Z-9 R1 Q4\n"
        b"G82 X5 Z-2 R1 P.5\nG84 X6 Z-2 R1\nG85 X7 Z-2 R1\nG86 X8 Z-2 R1 P1\nG89 X9 Z-2 R1 P1\nG80\nM2\n",
    ),
)  # fmt: skip

FANUC: Final = Language(
    "fanuc_30i",
    ("yl569", "dmu65", "generic_nutated_b45_c"),
    {
        **_TABLE,
        "e": (
            "1", "#1", "#0", "[<e>]", "[<e>+<e>]", "[<e>*<e>]", "[<e>/<e>]", "[<e>AND<e>]", "SIN[<e>]",
            "ATAN[<e>]/[<e>]",
            "ATAN[<e>,<e>]", "POW[<e>,<e>]", "##1", "[<e>GT<e>]", "[<e>MOD<e>]", "-<e>", "#[<e>]", "#5041", "#100",
            "<n>",
        ),
        "line": (
            *_SHARED, "#1=<e>", "#100=<e>+<e>", "G43.4 H1", "G43.5 H1", "G1 X<n> I<n> J<n> K<n>", "G49",
            "G68 X<n> Y<n> R<n>",
            "G68 X0 Y0 Z0 I<n> J<n> K<n> R<n>", "G69", "G68.2 X<n> Y<n> Z<n> I<n> J<n> K<n>", "G53.1",
            "G52 X<n> Y<n>",
            "G92 <x><n>", "G10 L2 P1 X<n> Y<n>", "G91 G28 Z0", "G28 <x><n>", "G30 P2 Z<n>", "G54.1 P<u>", "G5.1 Q1",
            "G05 P10000", "G98 G81 X<n> Z<n> R<n> F<n>", "G99 G83 Z-9. R<n> Q<n> F9", "G73 X<n> Z-5. R1. Q2. F9",
            "K<u>",
            "G76 Z-5. R1. Q1. F9", "G98 G87 Z-5. R-9. Q1. F9", "G84 Z-1. R1. F9", "IF[<e>]GOTO<u>", "GOTO<u>", "N<u>",
            "IF[<e>]THEN#1=<e>", "WHILE[#1LT5]DO1\n#1=#1+1\nX#1\nEND1", "WHILE[<e>]DO1", "END1", "DO2", "M98 P2 L<u>",
            "M98 P<u>", "M99", "M99 P<u>", "G65 P2 A<n> X<n>", "G66 P2 A1.", "G67", "G65 P9010 L<u>",
        ),
    },
    (
        b"%\nO0001 (ALL)\nN10 G90 G21 G17 G40 G49 G80 G94\nT5 M6\nG54 G43.4 H5 S9000 M3 M8\n"
        b"G0 X1. Y2. Z3. B10. C20.\n"
        b"G05.1 Q1\nG1 X2. Y3. Z4. B11. C21. F1200.\nG93 X3. F2.5\nG94 F100.\nG49\nG0 X3. Y3. Z4.\n"
        b"G2 X13. Y3. I5. J0\n"
        b"G3 X3. Y3. R5.\n"
        b"G68.2 X1. Y0. Z-5. I0. J30. K45.\nG53.1\nG0 X0 Y0 Z10.\nG69\nG52 X1. Y1. Z1.\nX0\nG52 X0 Y0 Z0\n"
        b"G91 G28 Z0.\n"
        b"G90 G53 G0 Z0.\nG54.1 P2\nG4 P500\nG43.5 H5\nG1 X1. I.5 J0. K.866 F500.\nG49\nM5\nM9\nM30\n%\n",
        b"O1\n#1=0\nWHILE[#1LT3]DO1\n#1=#1+1\nIF[#1EQ2]GOTO5\nG0 X#1\nN5\nEND1\nIF[#9 EQ #0] THEN #2=7\n"
        b"G65 P2 L2 A3.5 X1.\n"
        b"M98 P3 L2\nG66 P2 A1. X2.\nX4.\nG67\nG0 X[ROUND[2.5]+FIX[-1.5]] Y[10MOD4]\nM30\nO2\nG0 Z#1 X#24\nM99\n"
        b"O3\nG91\nX1.\n"
        b"G90\nM99\n",
        b"G90 G0 X0 Y0 Z20. F100.\nG98 G81 X1. Z-5. R2.\nX2.\nG99 G83 X3. Z-9. R1. Q3.\nG73 X4. Z-9. R1. Q4.\n"
        b"G76 X1. Z-5. R1.\n"
        b"G82 X5. Z-2. R1. P500\nG84 X6. Z-2. R1.\nG85 X7.\nG86 X8.\nG88 X9.\nG89 X9. P100\n"
        b"G98 G87 Z-1. R-9. Q1.\nG80\nM30\n",
    ),
)  # fmt: skip

FIDIA: Final = Language(
    "fidia_nc15",
    ("hs664rt", "generic_head_table_bc"),
    {
        **_TABLE,
        "e": ("#1", "[1+1]", "<n>"),
        "line": (
            *_SHARED, "G154", "G69", "G196", "G197", "G96", "G97", "M306 T.<u>", "M242", "G55 O<u>", "G71", "G70",
            "G290 Z<n>",
            "G1 A<n> C<n> F3000", "G83 X<n> Y<n> Z<n> E<n> R<n> D<n> H<n> F<n>", "G83 X<n> Z20. E-9. R2. D1. F70",
            "G81 Z9. E-1. R3.", "G84 X<n> Z9. E-1. R3.", "G4 HD<n>", "G21 RX0 RY<n> RZ0", "G20", "G17 Q1", "M02",
            "M10",
        ),
    },
    (
        (GOLDEN / "hs664rt" / "radial_holes.expected.txt").read_bytes(),
        b"N1 G90\nN2 G17 Q1\nN3 G71\nN4 M6 T12\nG55 O1\nN5 S9000 M3\nN6 G196\nN7 G1 X10 Y5 Z20 A12.5 C30 F1500\n"
        b"N8 G197\nG1 X10. Y5. Z20.\n"
        b"N9 G2 X20. Y5. I15. J5.\nN10 G81 X1. Z30. R5. E-5.\nX2.\nN11 G80\nN12 G4 HD2.5\nN13 G290 Z0\nN14 M5\n"
        b"N15 M2\n",
    ),
)  # fmt: skip

LANGUAGES: Final = (LINUXCNC, FANUC, FIDIA)
