"""The golden programs for Fanuc, Haas, LinuxCNC, an iTNC 530 and a TNC 640, and what they are posted from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """What a golden program is posted from; the CL file and a machine's file are in ``GOLDEN``.

    ``warned``: text in every line of stderr other than those of the checks.
    """

    cl: str
    machine: str
    settings: tuple[str, ...] = ()
    warned: str = ""


_BLADE = "yl569/3_blade_finish.cls"
_ROLLER, _FLATS = "four_axis/roller.cls", "four_axis/flats.cls"
_ON_A = ("zero=-450,-203,-400", "tool_length=60")
_BESIDE_A = ("zero=-450,-198,-395", "tool_length=60")
_ON_DESK = ("zero=-200,-90,-120", "tool_length=60")
_CAP = "mikron_600u/cap.cls"
_PLACE = ("zero=0,0,100", "tool_length=100")
_NO_TOLERANCE = " has no INTOL and OUTTOL"
CASES = {
    "fanuc/flange.expected.nc": Case(
        "fanuc/flange.cls", "matsuura_mx330", ("program=7118", "title=Flange 7-1182 Rev B", "work_offset=G54.1 P3")
    ),
    "fanuc/flange_by_increments.expected.nc": Case("fanuc/flange.cls", "matsuura_mx330", ("distances=incremental",)),
    "fanuc/blade.expected.nc": Case(_BLADE, "matsuura_mx330", ("contour=G05",)),
    "fanuc/blade_by_vectors.expected.nc": Case(_BLADE, "matsuura_mx330", ("orientation=vector",)),
    "fanuc/blade_without_options.expected.nc": Case(
        _BLADE, "fanuc/without_options.toml", ("zero=0,0,120", "tool_length=120", "numbers=off")
    ),
    "four_axis/flats.expected.h": Case(_FLATS, "four_axis/klartext.toml", _ON_A),
    "four_axis/flats.expected.mpf": Case(_FLATS, "four_axis/sinumerik.toml", _ON_A),
    "four_axis/flats.expected.nc": Case(_FLATS, "haas_vf2_a", _BESIDE_A),  # on the axis G254 would change nothing
    "four_axis/flats.expected.ngc": Case(_FLATS, "desk_mill_a", _ON_DESK, warned=" tilted "),
    "four_axis/flats_g68.expected.nc": Case(_FLATS, "four_axis/fanuc.toml", _ON_A),
    "four_axis/roller.expected.h": Case(_ROLLER, "four_axis/klartext.toml", _ON_A),
    "four_axis/roller.expected.nc": Case(_ROLLER, "haas_vf2_a", _ON_A),
    "four_axis/roller.expected.ngc": Case(_ROLLER, "desk_mill_a", _ON_DESK),
    "haas/blade.expected.nc": Case(_BLADE, "haas_umc750", ("smoothing=G187 P3",)),
    "haas/flange.expected.nc": Case(
        "fanuc/flange.cls",
        "haas_umc750",
        ("program=07118", "title=Flange 7-1182 Rev B", "work_offset=G154 P3", "smoothing=G187 P3"),
    ),
    "linuxcnc/blade.expected.ngc": Case(_BLADE, "xyzac_trt"),
    "linuxcnc/blade_without_tcp.expected.ngc": Case(_BLADE, "xyzac_trt", ("tcp=off", "zero=0,0,0")),
    "linuxcnc/contour.expected.ngc": Case("yl569/1_contour_rough.cls", "xyzac_trt"),
    "linuxcnc/plate.expected.ngc": Case(
        "linuxcnc/plate.cls", "xyzac_trt", ("title=plate",), warned=" expanded to rapids"
    ),
    "mikron_600u/cap.expected.h": Case(_CAP, "mikron_600u", ("tcp=on", *_PLACE)),
    "mikron_600u/cap_m114.expected.h": Case(_CAP, "mikron_600u", ("tcp=m114", *_PLACE)),
    "mikron_600u/cap_without_tcp.expected.h": Case(
        _CAP, "mikron_600u", ("tcp=off", *_PLACE), warned="so short that F would be above"
    ),
    "mikron_600u/flange_by_increments.expected.h": Case(
        "fanuc/flange.cls", "mikron_600u", ("distances=incremental", "blank=extents"), warned=_NO_TOLERANCE
    ),
    **{
        f"dmu65/bevel_{form}.expected.h": Case(
            "dmu65/bevel.cls", "dmu65", (f"plane={form}", "blank=extents"), warned=_NO_TOLERANCE
        )
        for form in ("spatial", "vector", "euler", "points", "relativ", "axial")
    },
}
