"""CL text with hole-making cycles."""

from hypothesis import strategies as st

HEIGHTS = "RAPTO,3.0,FEDTO,-20.0,"
MODES = st.sampled_from(
    [
        "DRILL,{h}MMPM,{f}",
        "DRILL,{h}DWELL,{d},MMPM,{f}",
        "DRILL,DEEP,{h}STEP,{s},MMPM,{f}",
        "DRILL,DEEP,{h}STEP,{s},0.5,1.0,DWELL,{d},MMPM,{f}",
        "DRILL,BRKCHP,{h}STEP,{s},MMPM,{f}",
        "TAP,{h}MMPR,1.5",
        "TAP,{h}MMPR,1.5,OPTION",
        "TAP,BRKCHP,{h}STEP,{s},MMPR,1.5",
        "TAP,DEEP,{h}STEP,{s},DWELL,{d},MMPR,1.5",
        "BORE,{h}MMPM,{f}",
        "BORE,DRAG,{h}MMPM,{f}",
        "BORE,MANUAL,{h}DWELL,REV,5,MMPM,{f}",
    ]
)


@st.composite
def statements(draw: st.DrawFn) -> str:
    """The statement of a cycle with random heights."""
    above, depth = draw(st.floats(0.5, 10.0)), draw(st.floats(1.0, 40.0))
    retract = draw(st.sampled_from(["", "RTRCTO,12.5,", "RTRCTO,AUTO,"]))
    heights = f"RAPTO,{above:.3f},FEDTO,-{depth:.3f},{retract}"
    numbers = {"d": f"{draw(st.floats(0.1, 5.0)):.2f}", "f": f"{draw(st.integers(20, 900))}"}
    return draw(MODES).format(h=heights, s=f"{draw(st.floats(1.0, 9.0)):.2f}", **numbers)
