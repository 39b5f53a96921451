"""Trunnion: cutter-location files to proven NC programs for five-axis machine tools.

    >>> import trunnion
    >>> result = trunnion.post("tests/golden/yl569/3_blade_finish.cls", machine="yl569", settings={"title": "BLADE"})
    >>> result.passed
    True
    >>> result.run.tip.shape
    (154, 3)

Functions

    read_cl        CL file -> Toolpath
    describe_cl    CL files -> ClDescription: what they hold
    load_machine   definition -> Machine
    plan           CL files -> Plan: motions on the machine
    post           CL files -> NC program with its proof
    post_project   project -> all NC programs of its set-ups with their proofs, together or not at all
    read_program   NC program -> Run: what the control does with it
    verify         NC program against its CL files, and against a recording of the machine -> Verification
    convert        NC program -> CL file, or program for another machine
    diff           two NC programs -> Comparison
    explain        code of a message, or name of a check -> Explanation
    simulate       NC programs and stock -> SimulationResult: what is cut, and what is hit
    read_points    table of measured points -> PointTable of each curve
    fit_curve      points -> CurveFit: a B-spline curve, and how far it is off
    cut_impeller   definition, machine -> CL files and one proven program of all operations
    load_impeller  definition and measured points -> Impeller: blades, hub and shroud as surfaces
    model_impeller Impeller -> ImpellerModel: a closed mesh
    write_impeller_step  Impeller -> STEP file of a solid, and ImpellerSolid: how good it is
    write_report   Verification -> page or data
    write_plot     ClDescription -> page with the path in space
    verify_manifest  manifest of a post -> ManifestCheck: are its files still the same
    write_view     NC program -> page that shows it on its machine, block by block

They print nothing and raise ``TrunnionError``. Names are imported when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from trunnion.api.comparing import diff as diff
    from trunnion.api.converting import ConvertResult as ConvertResult
    from trunnion.api.converting import convert as convert
    from trunnion.api.curves import fit_curve as fit_curve
    from trunnion.api.curves import read_points as read_points
    from trunnion.api.curves import write_curve_picture as write_curve_picture
    from trunnion.api.describing import ControlDescription as ControlDescription
    from trunnion.api.describing import describe_control as describe_control
    from trunnion.api.describing import describe_controls as describe_controls
    from trunnion.api.describing_cl import ClDescription as ClDescription
    from trunnion.api.describing_cl import describe_cl as describe_cl
    from trunnion.api.describing_machine import MachineDescription as MachineDescription
    from trunnion.api.describing_machine import describe_machine as describe_machine
    from trunnion.api.explaining import explain as explain
    from trunnion.api.impeller_cutting import ImpellerCut as ImpellerCut
    from trunnion.api.impeller_cutting import cut_impeller as cut_impeller
    from trunnion.api.impellers import load_impeller as load_impeller
    from trunnion.api.impellers import model_impeller as model_impeller
    from trunnion.api.impellers import write_impeller_step as write_impeller_step
    from trunnion.api.manifests import ManifestCheck as ManifestCheck
    from trunnion.api.manifests import verify_manifest as verify_manifest
    from trunnion.api.observer import Observer as Observer
    from trunnion.api.planning import plan as plan
    from trunnion.api.plotting import write_plot as write_plot
    from trunnion.api.post_result import PostResult as PostResult
    from trunnion.api.post_result import ProofFailedError as ProofFailedError
    from trunnion.api.posting import post as post
    from trunnion.api.project_posting import ProjectResult as ProjectResult
    from trunnion.api.project_posting import post_project as post_project
    from trunnion.api.reading import load_machine as load_machine
    from trunnion.api.reading import read_cl as read_cl
    from trunnion.api.reading import read_program as read_program
    from trunnion.api.reports import write_report as write_report
    from trunnion.api.simulating import simulate as simulate
    from trunnion.api.simulation_result import SimulationResult as SimulationResult
    from trunnion.api.verifying import verify as verify
    from trunnion.api.viewing import write_view as write_view
    from trunnion.errors import InputError as InputError
    from trunnion.errors import Problem as Problem
    from trunnion.errors import RefusedError as RefusedError
    from trunnion.errors import Severity as Severity
    from trunnion.errors import TrunnionError as TrunnionError
    from trunnion.explanations import Explanation as Explanation
    from trunnion.geometry.curves import BSplineCurve as BSplineCurve
    from trunnion.geometry.fitting import CurveFit as CurveFit
    from trunnion.geometry.point_tables import PointTable as PointTable
    from trunnion.geometry.spans import Span as Span
    from trunnion.impeller.impeller import Impeller as Impeller
    from trunnion.impeller.model import ImpellerModel as ImpellerModel
    from trunnion.impeller.solid.making import ImpellerSolid as ImpellerSolid
    from trunnion.machines.machine import Axis as Axis
    from trunnion.machines.machine import Machine as Machine
    from trunnion.model.motion import Decision as Decision
    from trunnion.model.motion import Motion as Motion
    from trunnion.model.motion import Plan as Plan
    from trunnion.model.run import Run as Run
    from trunnion.model.toolpath import Operation as Operation
    from trunnion.model.toolpath import Toolpath as Toolpath
    from trunnion.verification.comparison.result import Comparison as Comparison
    from trunnion.verification.results import Check as Check
    from trunnion.verification.results import Place as Place
    from trunnion.verification.results import Verification as Verification

__version__ = "0.1.0"

#: Public name -> its module.
_MODULES: Final = {
    "Axis": "machines.machine",
    "BSplineCurve": "geometry.curves",
    "Check": "verification.results",
    "ClDescription": "api.describing_cl",
    "Comparison": "verification.comparison.result",
    "ControlDescription": "api.describing",
    "ConvertResult": "api.converting",
    "CurveFit": "geometry.fitting",
    "Decision": "model.motion",
    "Explanation": "explanations",
    "Impeller": "impeller.impeller",
    "ImpellerCut": "api.impeller_cutting",
    "ImpellerModel": "impeller.model",
    "ImpellerSolid": "impeller.solid.making",
    "InputError": "errors",
    "Machine": "machines.machine",
    "MachineDescription": "api.describing_machine",
    "ManifestCheck": "api.manifests",
    "Motion": "model.motion",
    "Observer": "api.observer",
    "Operation": "model.toolpath",
    "Place": "verification.results",
    "Plan": "model.motion",
    "PointTable": "geometry.point_tables",
    "PostResult": "api.post_result",
    "Problem": "errors",
    "ProjectResult": "api.project_posting",
    "ProofFailedError": "api.post_result",
    "RefusedError": "errors",
    "Run": "model.run",
    "Severity": "errors",
    "SimulationResult": "api.simulation_result",
    "Span": "geometry.spans",
    "Toolpath": "model.toolpath",
    "TrunnionError": "errors",
    "Verification": "verification.results",
    "convert": "api.converting",
    "cut_impeller": "api.impeller_cutting",
    "describe_cl": "api.describing_cl",
    "describe_control": "api.describing",
    "describe_controls": "api.describing",
    "describe_machine": "api.describing_machine",
    "diff": "api.comparing",
    "explain": "api.explaining",
    "fit_curve": "api.curves",
    "load_impeller": "api.impellers",
    "load_machine": "api.reading",
    "model_impeller": "api.impellers",
    "plan": "api.planning",
    "post": "api.posting",
    "post_project": "api.project_posting",
    "read_cl": "api.reading",
    "read_points": "api.curves",
    "read_program": "api.reading",
    "simulate": "api.simulating",
    "verify": "api.verifying",
    "verify_manifest": "api.manifests",
    "write_curve_picture": "api.curves",
    "write_impeller_step": "api.impellers",
    "write_plot": "api.plotting",
    "write_report": "api.reports",
    "write_view": "api.viewing",
}

__all__ = [
    "Axis",
    "BSplineCurve",
    "Check",
    "ClDescription",
    "Comparison",
    "ControlDescription",
    "ConvertResult",
    "CurveFit",
    "Decision",
    "Explanation",
    "Impeller",
    "ImpellerCut",
    "ImpellerModel",
    "ImpellerSolid",
    "InputError",
    "Machine",
    "MachineDescription",
    "ManifestCheck",
    "Motion",
    "Observer",
    "Operation",
    "Place",
    "Plan",
    "PointTable",
    "PostResult",
    "Problem",
    "ProjectResult",
    "ProofFailedError",
    "RefusedError",
    "Run",
    "Severity",
    "SimulationResult",
    "Span",
    "Toolpath",
    "TrunnionError",
    "Verification",
    "__version__",
    "convert",
    "cut_impeller",
    "describe_cl",
    "describe_control",
    "describe_controls",
    "describe_machine",
    "diff",
    "explain",
    "fit_curve",
    "load_impeller",
    "load_machine",
    "model_impeller",
    "plan",
    "post",
    "post_project",
    "read_cl",
    "read_points",
    "read_program",
    "simulate",
    "verify",
    "verify_manifest",
    "write_curve_picture",
    "write_impeller_step",
    "write_plot",
    "write_report",
    "write_view",
]


if not TYPE_CHECKING:  # type checkers would take any name for known

    def __getattr__(name: str) -> Any:
        """Import a public name when it is first used, so that ``import trunnion`` is quick."""
        if name not in _MODULES:
            raise AttributeError(f"module 'trunnion' has no attribute {name!r}")
        value = getattr(import_module(f"trunnion.{_MODULES[name]}"), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return __all__
