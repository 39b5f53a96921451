"""A job of two tools for a machine of each family: a tap on a slope, and a ball mill that swings."""

#: Two tapped holes on a slope, and a ball mill that swings; the second for a control that taps along Z only.
JOB = """TOOL PATH/HOLES,TOOL,D10
TLDATA/DRILL,10.0,0.0,75.0,0.0,0.0
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,500,CLW
RAPID
GOTO/0.0,0.0,80.0,{axis}
RAPID
GOTO/{above},{axis}
CYCLE/TAP,RAPTO,5,FEDTO,-12,MMPR,1.5,RTRCTO,5
GOTO/10.0,5.0,10.0,{axis}
GOTO/30.0,5.0,10.0,{axis}
CYCLE/OFF
RAPID
GOTO/{back},{axis}
END-OF-PATH
TOOL PATH/SWARF,TOOL,D6
TLDATA/MILL,6.0,3.0,75.0,0.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,2,ADJUST,2
SPINDL/RPM,4000,CLW
RAPID
GOTO/0.0,0.0,60.0,0.0,0.5,0.8660254
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,10.0
GOTO/10.0,0.0,10.0,0.0,0.6,0.8
GOTO/20.0,3.0,10.0,0.1,0.6,0.79372539
GOTO/20.0,33.0,60.0
END-OF-PATH
"""
TILTED = JOB.format(axis="0.0,0.6,0.8", above="10.0,5.0,30.0", back="30.0,41.0,58.0")
UPRIGHT = JOB.format(axis="0.0,0.0,1.0", above="10.0,5.0,30.0", back="30.0,5.0,58.0")

JOBS = {
    "yl569": TILTED,
    "dmu65": TILTED,
    "matsuura_mx330": TILTED,
    "hs664rt": TILTED,
    "haas_umc750": TILTED,
    "xyzac_trt": UPRIGHT,
}
