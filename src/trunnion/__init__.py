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
    place          CL files or NC programs -> Placement: where on the table the part may sit
    post_placed    Placement -> NC program with its proof, the part where it sits best
    read_program   NC program -> Run: what the control does with it
    verify         NC program against its CL files, and against a recording of the machine -> Verification
    fit            CL files or NC program -> MachineFit of each machine: which can run it
    reach          machine -> Reach: which tool axes and points it reaches
    kinematics     machine -> Kinematics: its formulas, forward and inverse
    sensitivity    NC program -> Sensitivity: which number of the machine's geometry it depends on
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
    write_report   Verification or SimulationResult -> page or data
    write_plot     ClDescription -> page with the path in space
    verify_manifest  manifest of a post -> ManifestCheck: are its files still the same
    write_view     NC program -> page that shows it on its machine, block by block

They print nothing and raise ``TrunnionError``. Names are imported when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from trunnion.version import __version__

if TYPE_CHECKING:
    from trunnion.capability.reach import Reach as Reach
    from trunnion.capability.sensitivity import Sensitivity as Sensitivity
    from trunnion.errors import InputError as InputError
    from trunnion.errors import Problem as Problem
    from trunnion.errors import RefusedError as RefusedError
    from trunnion.errors import Severity as Severity
    from trunnion.errors import TrunnionError as TrunnionError
    from trunnion.explanations import Explanation as Explanation
    from trunnion.formulas.description import Kinematics as Kinematics
    from trunnion.geometry.curves import BSplineCurve as BSplineCurve
    from trunnion.geometry.fitting import CurveFit as CurveFit
    from trunnion.geometry.point_tables import PointTable as PointTable
    from trunnion.geometry.spans import Span as Span
    from trunnion.impeller.impeller import Impeller as Impeller
    from trunnion.impeller.model import ImpellerModel as ImpellerModel
    from trunnion.impeller.solid.making import ImpellerSolid as ImpellerSolid
    from trunnion.jobs.capability.fitting import MachineFit as MachineFit
    from trunnion.jobs.capability.fitting import fit as fit
    from trunnion.jobs.capability.reaching import reach as reach
    from trunnion.jobs.capability.sensitivity import sensitivity as sensitivity
    from trunnion.jobs.convert.converting import convert as convert
    from trunnion.jobs.convert.result import ConvertResult as ConvertResult
    from trunnion.jobs.describe.cl_files import ClDescription as ClDescription
    from trunnion.jobs.describe.cl_files import describe_cl as describe_cl
    from trunnion.jobs.describe.codes import explain as explain
    from trunnion.jobs.describe.controls import ControlDescription as ControlDescription
    from trunnion.jobs.describe.controls import describe_control as describe_control
    from trunnion.jobs.describe.controls import describe_controls as describe_controls
    from trunnion.jobs.describe.kinematics import kinematics as kinematics
    from trunnion.jobs.describe.machines import MachineDescription as MachineDescription
    from trunnion.jobs.describe.machines import describe_machine as describe_machine
    from trunnion.jobs.describe.plot import write_plot as write_plot
    from trunnion.jobs.impeller.curves import fit_curve as fit_curve
    from trunnion.jobs.impeller.curves import read_points as read_points
    from trunnion.jobs.impeller.curves import write_curve_picture as write_curve_picture
    from trunnion.jobs.impeller.cut import ImpellerCut as ImpellerCut
    from trunnion.jobs.impeller.cutting import cut_impeller as cut_impeller
    from trunnion.jobs.impeller.models import load_impeller as load_impeller
    from trunnion.jobs.impeller.models import model_impeller as model_impeller
    from trunnion.jobs.impeller.models import write_impeller_step as write_impeller_step
    from trunnion.jobs.inputs.reading import load_machine as load_machine
    from trunnion.jobs.inputs.reading import read_cl as read_cl
    from trunnion.jobs.inputs.reading import read_program as read_program
    from trunnion.jobs.observer import Observer as Observer
    from trunnion.jobs.place.placing import place as place
    from trunnion.jobs.place.plot import write_placing_plot as write_placing_plot
    from trunnion.jobs.place.posting import post_placed as post_placed
    from trunnion.jobs.post.papers.manifests import ManifestCheck as ManifestCheck
    from trunnion.jobs.post.papers.manifests import verify_manifest as verify_manifest
    from trunnion.jobs.post.planning import plan as plan
    from trunnion.jobs.post.posting import post as post
    from trunnion.jobs.post.result import PostResult as PostResult
    from trunnion.jobs.post.result import ProofFailedError as ProofFailedError
    from trunnion.jobs.post_project.posting import ProjectResult as ProjectResult
    from trunnion.jobs.post_project.posting import post_project as post_project
    from trunnion.jobs.simulate.result import SimulationResult as SimulationResult
    from trunnion.jobs.simulate.simulating import simulate as simulate
    from trunnion.jobs.verify.comparing import diff as diff
    from trunnion.jobs.verify.reports import write_report as write_report
    from trunnion.jobs.verify.verifying import verify as verify
    from trunnion.jobs.view.viewing import write_view as write_view
    from trunnion.machines.machine import Axis as Axis
    from trunnion.machines.machine import Machine as Machine
    from trunnion.model.motion import Decision as Decision
    from trunnion.model.motion import Motion as Motion
    from trunnion.model.motion import Plan as Plan
    from trunnion.model.run import Run as Run
    from trunnion.model.toolpath import Operation as Operation
    from trunnion.model.toolpath import Toolpath as Toolpath
    from trunnion.placing.placement import Placement as Placement
    from trunnion.verification.comparison.result import Comparison as Comparison
    from trunnion.verification.results import Check as Check
    from trunnion.verification.results import Place as Place
    from trunnion.verification.results import Verification as Verification

#: Public name -> its module.
_MODULES: Final = {
    "Axis": "machines.machine",
    "BSplineCurve": "geometry.curves",
    "Check": "verification.results",
    "ClDescription": "jobs.describe.cl_files",
    "Comparison": "verification.comparison.result",
    "ControlDescription": "jobs.describe.controls",
    "ConvertResult": "jobs.convert.result",
    "CurveFit": "geometry.fitting",
    "Decision": "model.motion",
    "Explanation": "explanations",
    "Impeller": "impeller.impeller",
    "ImpellerCut": "jobs.impeller.cut",
    "ImpellerModel": "impeller.model",
    "ImpellerSolid": "impeller.solid.making",
    "InputError": "errors",
    "Kinematics": "formulas.description",
    "Machine": "machines.machine",
    "MachineDescription": "jobs.describe.machines",
    "MachineFit": "jobs.capability.fitting",
    "ManifestCheck": "jobs.post.papers.manifests",
    "Motion": "model.motion",
    "Observer": "jobs.observer",
    "Operation": "model.toolpath",
    "Place": "verification.results",
    "Placement": "placing.placement",
    "Plan": "model.motion",
    "PointTable": "geometry.point_tables",
    "PostResult": "jobs.post.result",
    "Problem": "errors",
    "ProjectResult": "jobs.post_project.posting",
    "ProofFailedError": "jobs.post.result",
    "Reach": "capability.reach",
    "RefusedError": "errors",
    "Run": "model.run",
    "Sensitivity": "capability.sensitivity",
    "Severity": "errors",
    "SimulationResult": "jobs.simulate.result",
    "Span": "geometry.spans",
    "Toolpath": "model.toolpath",
    "TrunnionError": "errors",
    "Verification": "verification.results",
    "convert": "jobs.convert.converting",
    "cut_impeller": "jobs.impeller.cutting",
    "describe_cl": "jobs.describe.cl_files",
    "describe_control": "jobs.describe.controls",
    "describe_controls": "jobs.describe.controls",
    "describe_machine": "jobs.describe.machines",
    "diff": "jobs.verify.comparing",
    "explain": "jobs.describe.codes",
    "fit": "jobs.capability.fitting",
    "fit_curve": "jobs.impeller.curves",
    "kinematics": "jobs.describe.kinematics",
    "load_impeller": "jobs.impeller.models",
    "load_machine": "jobs.inputs.reading",
    "model_impeller": "jobs.impeller.models",
    "place": "jobs.place.placing",
    "plan": "jobs.post.planning",
    "post": "jobs.post.posting",
    "post_placed": "jobs.place.posting",
    "post_project": "jobs.post_project.posting",
    "reach": "jobs.capability.reaching",
    "read_cl": "jobs.inputs.reading",
    "read_points": "jobs.impeller.curves",
    "read_program": "jobs.inputs.reading",
    "sensitivity": "jobs.capability.sensitivity",
    "simulate": "jobs.simulate.simulating",
    "verify": "jobs.verify.verifying",
    "verify_manifest": "jobs.post.papers.manifests",
    "write_curve_picture": "jobs.impeller.curves",
    "write_impeller_step": "jobs.impeller.models",
    "write_placing_plot": "jobs.place.plot",
    "write_plot": "jobs.describe.plot",
    "write_report": "jobs.verify.reports",
    "write_view": "jobs.view.viewing",
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
    "Kinematics",
    "Machine",
    "MachineDescription",
    "MachineFit",
    "ManifestCheck",
    "Motion",
    "Observer",
    "Operation",
    "Place",
    "Placement",
    "Plan",
    "PointTable",
    "PostResult",
    "Problem",
    "ProjectResult",
    "ProofFailedError",
    "Reach",
    "RefusedError",
    "Run",
    "Sensitivity",
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
    "fit",
    "fit_curve",
    "kinematics",
    "load_impeller",
    "load_machine",
    "model_impeller",
    "place",
    "plan",
    "post",
    "post_placed",
    "post_project",
    "reach",
    "read_cl",
    "read_points",
    "read_program",
    "sensitivity",
    "simulate",
    "verify",
    "verify_manifest",
    "write_curve_picture",
    "write_impeller_step",
    "write_placing_plot",
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
