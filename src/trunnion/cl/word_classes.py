"""Which statements that the reader does not follow may have changed the machine.

An unknown word is left out of a program with a warning. A word that is known to move the machine, to turn an axis, to
change a tool or to switch something is refused: without it the program would be another one. So is a word that looks
like a damaged one of these.
"""

import re
from collections.abc import Collection
from typing import Final, NamedTuple

from trunnion.cl.dialect import Dialect
from trunnion.cl.dialects import DIALECTS
from trunnion.cl.statements.apt_refused import part_program

#: Words of APT systems and post-processors (ISO 4343 and later ones) that act on the machine, and which no dialect here
#: follows.
_MACHINE_WORDS: Final = frozenset({
    "ABSOL", "ADJUST", "ARCDAT", "ARCMOD", "ARCSLP", "AUXFUN", "BARFED", "CALL", "CALSUB", "CATMAT", "CHUCK", "CLAMP",
    "CLEARP", "CLRSRF", "COLLET", "COPY", "COUPLE", "CSYS", "DEFSUB", "DITTO", "DRESS", "DWELL", "ENDSUB", "FEDMOD",
    "FEEDMOD", "FIXTUR", "GCODE", "GEAR", "HEAD", "HEADNO", "INCR", "INDEX", "LATHE", "LINEAR", "LINTOL", "LOCK",
    "MAGAZN", "MAXIPM", "MAXRPM", "MCHTOL", "MCODE", "MIRROR", "MOVETO", "OFFSET", "OFSTNO", "ORIENT", "ORIGIN",
    "PALLET", "PITCH", "PIVOTZ", "POD", "POSITN", "PPFUN", "PREFUN", "PROBE", "RANGE", "RESET", "RETRCT", "ROTABL",
    "ROTATE", "ROTAXS", "ROTHED", "ROTREF", "SADDLE", "SAFPOS", "SCALE", "SLIDE", "SLOWDN", "SMOOTH", "STDYRST",
    "STEADY", "SYNC", "SYNCTL", "TABLE", "TAILST", "THREAD", "TILT", "TILTTB", "TLAXIS", "TLCOMP", "TLVEC", "TOOLCHG",
    "TOOLNO", "TRACUT", "TRANS", "TURRET", "UNCLAMP", "UNLDTL", "UNLOAD", "UNLOCK", "UNLODTL", "VTLAXS", "WAIT", "WCS",
    "WPLANE", "ZERO", "ZEROPT",
})  # fmt: skip

#: Words of the dialects that say nothing about the machine: texts, names, listings.
_SAY_NOTHING: Final = frozenset({
    "AUTOPS", "BOX", "CLPRNT", "DISPLAY", "DISPLY", "END", "FINI", "LEADER", "MACHIN", "OPFEATEND", "OPFEATSTART",
    "PAINT", "PARTNO", "PPRINT", "PPWORD", "PSIS", "REMARK", "REWIND", "SETUP", "TPRINT",
})  # fmt: skip

#: Words of motion: a statement that begins or ends with one has lost its slash or its line end.
_MOTION_WORDS: Final = ("GOTO", "GODLTA", "GOHOME", "RAPID", "CIRCLE", "FEDRAT", "SPINDL", "LOADTL", "CYCLE")

#: Statements that may stand without a slash: one behind which the line end is lost begins with it.
_BARE_WORDS: Final = (
    "END-OF-PATH", "RAPID", "STOP", "OPSTOP", "COOLNT", "AUTOPS", "MULTAX", "FINI", "GOHOME", "RETRCT", "TLON", "NURBS",
    "REWIND",
)  # fmt: skip

#: Words that stand behind the slash of a statement: one that has lost it begins with its word and one of these.
_VALUE_WORDS: Final = frozenset({
    "ABSOL", "AIR", "AUTO", "BARREL", "CCLW", "CLW", "DRILL", "FLOOD", "IN", "INCH", "INCHES", "INCR", "INVERS", "IPM",
    "IPR", "LEFT", "MILL", "MIST", "MM", "MMPM", "MMPR", "MODE", "OFF", "ON", "PERMIN", "PERREV", "RIGHT", "RPM", "SFM",
    "SMM", "TAP", "TCUTTER", "THRU", "TOOL", "TURN", "WORLD", "XYPLAN",
})  # fmt: skip

#: Words that a damaged one is compared with in all dialects: those that most files have.
_COMMON_WORDS: Final = (
    *_MOTION_WORDS, "AUXFUN", "CLRSRF", "COOLNT", "CUTCOM", "CUTTER", "DELAY", "END-OF-PATH", "FROM", "GOFWD", "INDIRV",
    "INSERT", "LOAD", "MOVARC", "MSYS", "MULTAX", "OPSTOP", "PREFUN", "RETRCT", "ROTABL", "ROTATE", "SELECT", "STOP",
    "TLAXIS", "TLDATA", "TOOLPATH", "UNITS",
)  # fmt: skip

#: Shorter words of a dialect are not compared: too many others are one letter off.
_SHORTEST_COMPARED: Final = 4

#: Words that drive the tool along geometry: a statement with one of them among its words is motion.
_DRIVE_WORDS: Final = frozenset({
    "GO", "GOBACK", "GODOWN", "GOFWD", "GOLFT", "GORGT", "GOUP", "INDIRP", "INDIRV", "TLLFT", "TLOFPS", "TLON",
    "TLONPS", "TLRGT",
})  # fmt: skip

_LETTERS: Final = re.compile(r"[A-Z]+")

ACTING_WORDS: Final = _MACHINE_WORDS | {
    word
    for dialect in DIALECTS.values()
    for word in dialect.handlers
    if _LETTERS.fullmatch(word.replace("-", "").replace(",", "")) and word not in _SAY_NOTHING
}


def drives_tool(major: str) -> bool:
    """Whether a statement is motion along geometry, by the words between the commas of its major word."""
    return not _DRIVE_WORDS.isdisjoint(major.split(","))


def words_that_count(dialect: Dialect) -> frozenset[str]:
    """Return the words of a dialect that a damaged one is compared with, in all files and in those of this dialect."""
    return frozenset(_COMMON_WORDS) | {
        word
        for word, handler in dialect.handlers.items()
        if len(word.removeprefix("->")) >= _SHORTEST_COMPARED
        and word.removeprefix("->") not in _SAY_NOTHING
        and handler is not part_program
    }


class Suspicion(NamedTuple):
    """Why a statement may have changed the machine.

    damaged  the word that it may be, damaged; empty: it has one that acts
    meant    the words that it may be, if any
    """

    damaged: str = ""
    meant: tuple[str, ...] = ()


def acts_on_machine(major: str, words: Collection[str]) -> Suspicion | None:
    """Why a statement may have changed the machine, by its major word; None if nothing suggests it.

    ``words``: those of its dialect (``words_that_count``), one of which may be damaged. A statement without a slash is
    all major word: each word between its commas counts.
    """
    parts = major.split(",")
    if not ACTING_WORDS.isdisjoint((major, *parts)):
        return Suspicion(meant=tuple(part for part in parts if part in ACTING_WORDS) if parts[1:] else ())
    meant = _damaged_word(major, words)
    return Suspicion(meant, (meant,)) if meant else None


def _damaged_word(major: str, words: Collection[str]) -> str:
    """Return the word that a major word may be, damaged; empty if it looks like none."""
    if motion := next((word for word in _MOTION_WORDS if major.startswith(word) or major.endswith(word)), ""):
        return motion
    letters = _LETTERS.match(major)
    if letters and letters[0] != major and letters[0] in words:
        return letters[0]
    if meant := next((word for word in sorted(words) if _is_one_letter_off(major, word)), ""):
        return meant.removeprefix("->")
    lettered = major.replace("0", "O").replace("1", "I")
    if lettered != major and _is_known(lettered, words):
        return lettered
    if glued := next(
        (word for word in _BARE_WORDS if major.startswith(word) and _is_known(major[len(word) :], words)), ""
    ):
        return glued
    first = major.partition(",")[0]
    return next((word for word in sorted(words) if first.startswith(word) and first[len(word) :] in _VALUE_WORDS), "")


def _is_known(major: str, words: Collection[str]) -> bool:
    """Whether a word is that of some statement."""
    return major in ACTING_WORDS or major in _SAY_NOTHING or major in words


def _is_one_letter_off(one: str, other: str) -> bool:
    """Whether a letter is wrong, missing or too many, or two neighbours are exchanged."""
    if abs(len(one) - len(other)) > 1 or one == other:
        return False
    begin = 0
    while begin < min(len(one), len(other)) and one[begin] == other[begin]:
        begin += 1
    a, b = one[begin:], other[begin:]
    return a[1:] == b[1:] or a[1:] == b or a == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:])
