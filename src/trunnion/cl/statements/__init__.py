"""What each statement of an NX CLSF means: one small function for each, and the table of all.

In:     a statement, and the state of the reader with its line and row.
Out:    the state with what the statement says, in units of the file.
"""

from trunnion.cl.dialect import Handler
from trunnion.cl.statements import apt_motion, apt_refused, apt_tools, cycles, events, motion, operations, splines

__all__ = ["HANDLERS"]

#: Every statement of an NX CLSF, by its major word. Those of other dialects are in ``trunnion.cl.dialects``.
HANDLERS: dict[str, Handler] = {
    "TOOLPATH": operations.tool_path,
    "END-OF-PATH": operations.end_of_path,
    "TLDATA": operations.tldata,
    "MSYS": operations.msys,
    "PARTNO": operations.partno,
    "UNITS": operations.units,
    "INTOL": operations.intol,
    "OUTTOL": operations.outtol,
    "PAINT": operations.paint,
    "MACHIN": operations.ignore,
    "REMARK": operations.ignore,
    "LEADER": operations.ignore,
    "CLPRNT": operations.ignore,
    "CUTTER": apt_tools.cutter_in_section,
    "END": operations.end_of_file,
    "FINI": operations.end_of_file,
    "RAPID": motion.rapid,
    "GOTO": motion.goto,
    "GODLTA": motion.godlta,
    "GOHOME": motion.gohome,
    "FROM": motion.from_,
    "CIRCLE": motion.circle,
    "NURBS": splines.nurbs,
    "KNOT": splines.knot,
    "CNTRL": splines.cntrl,
    "TLON": motion.driven,
    "INDIRV": motion.driven,
    "COPY": apt_refused.refuse,
    "TRACUT": apt_refused.refuse,
    "TRANS": apt_motion.no_shift,
    "FEDRAT": events.fedrat,
    "SPINDL": events.spindl,
    "LOAD": events.load,
    "LOADTL": events.loadtl,
    "SELECT": events.load,
    "COOLNT": events.coolnt,
    "CUTCOM": events.cutcom,
    "CYCLE": cycles.cycle,
    "DELAY": events.delay,
    "STOP": events.stop,
    "OPSTOP": events.stop,
    "PPRINT": events.message,
    "TPRINT": events.message,
    "DISPLY": events.message,
    "DISPLAY": events.message,
    "INSERT": events.insert,
    "OPSKIP": events.opskip,
    "SET": events.set_mode,
    "MODE": events.set_mode,
    "MULTAX": events.set_mode,
}
