"""What the words do that no path shows, by modes: comparisons of programs see them by this table alone.

Every word that ``words`` calls without effect on the path is here, once: it sets a mode, acts once where it stands, or
does nothing at the machine.
"""

from typing import Final

from trunnion.model.mode_words import (
    BOTTLENECKS,
    CONSTANT_FEED,
    CORNERS,
    DIMENSIONS,
    FEED_ALONG,
    WAY_TO_CONTOUR,
)
from trunnion.readers.control.event_recorder import EventRecorder


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


def _modes(**words: str) -> dict[str, str]:
    """Return the mode of each word."""
    return {word: mode.replace("_", " ") for mode, some in words.items() for word in some.split()}


#: Modes of G words and of others: one word of a mode takes the place of the one before.
MODES: Final = {
    **_modes(
        path_control="G60 G64 G641 G642 G643 G644 G645",
        exact_stop="G601 G602 G603",
        acceleration="SOFT BRISK DRIVE",
        acceleration_of_axes="SOFTA BRISKA DRIVEA",
        feed_forward="FFWON FFWOF",
        compressor="COMPOF COMPON COMPCURV COMPCAD COMPSURF",
        dynamics="DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH DYNPREC",
        path_parameter="UPATH SPATH",
        smoothing_of_the_tool_axis="ORISON ORISOF",
        course_of_the_feed="FNORM",
        position_control_of_the_spindle="SPCON SPCOF",
        limits_of_the_working_area="WALIMON WALIMOF",
        precision_of_the_contour="CPRECON CPRECOF",
        rapids="RTLION",
        diameters="DIAMOF DIAMCYCOF",
        rotation_of_the_part="PAROTOF",
        tool_carrier="TCOFR TCABS",
        ends_of_positioning="IPOBRKA IPOENDA FINEA COARSEA",
        online_correction_of_the_tool="TOFFOF",
    ),
    **dict.fromkeys(("G140", "G141", "G142", "G143"), WAY_TO_CONTOUR),
    **dict.fromkeys(("G340", "G341", "NORM", "KONT", "KONTC", "KONTT"), WAY_TO_CONTOUR),
    **dict.fromkeys(("G450", "G451", "DISC", "FENDNORM"), CORNERS),
    **dict.fromkeys(("G460", "G461", "G462", "CDON", "CDOF", "CDOF2"), BOTTLENECKS),
    **dict.fromkeys(("CFC", "CFTCP", "CFIN", "CFCIN"), FEED_ALONG),
    **dict.fromkeys(("CUTCONON", "CUTCONOF"), CONSTANT_FEED),
    **dict.fromkeys(("CUT2D", "CUT2DF", "CUT3DC", "CUT3DF", "CUT3DFS", "CUT3DFF"), DIMENSIONS),
}

#: Words with a value, each a mode of its own, for each axis that it names.
VALUES: Final = _words("""
    ADISPOS STOL OTOLG CTOLG FGREF OVR VELOLIM OVRA OVRRAP ACC JERKLIM ACCLIM SCC DISCL DISR DISRP FA DITS DITE
    """)

#: Those that change how fast, or how hard, the axes run: no CL file asks for them. At 100 percent they change nothing.
ALTERING: Final = _words("OVRA OVRRAP ACC JERKLIM ACCLIM")
_NEUTRAL: Final = 100.0

#: Where the spindle stands, and what others do: each a mode of its own.
OF_SPINDLES: Final = _words("SPOS M S")

#: Words that act where they stand: the control reads no further ahead, or waits for another channel.
ONCE: Final = _words("""
    STOPRE STARTFIFO STOPFIFO FIFOCTRL GETD GET RELEASE WAITM SETM CLEARM WAITP WAITS
    """)

#: Words that do nothing at the machine: of displays, single blocks, names and graphics. What others do shows in
#: positions, tolerances, feeds and tools, or they are errors.
NOTHING: Final = _words("""
    SBLON SBLOF DISPLOF DISPLON ACTBLOCNO EXTERN WORKPIECE GROUP_BEGIN GROUP_END GROUP_ADDEND G290
    G110 G111 G112
    """)


def say(control: EventRecorder, word: str, value: str = "") -> None:
    """Record what a word does that no path shows.

    value  what is written behind it: the axis, arguments, or a value
    """
    if word in VALUES or word in OF_SPINDLES:
        axis, _, number = value.partition("=")
        control.say_mode(word + axis, number)
        if word in ALTERING and (percent := _percent(number)) != _NEUTRAL:
            said = number if percent is None else f"{percent:g}"
            control.add_event("unasked", f"{word}{axis}={said}")
    elif word in ONCE:
        control.say_once(f"{word}{value}")
    elif word in MODES:
        control.say_mode(MODES[word], f"{word}{value}")


def _percent(text: str) -> float | None:
    """Return a value; None: it is no number, and may change anything."""
    try:
        return float(text)
    except ValueError:
        return None
