"""Impellers: from a definition and measured points to surfaces, a closed mesh, and a STEP file."""

import math

from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.files import atomic_file
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.model import ImpellerModel, impeller_model
from trunnion.impeller.solid.making import ImpellerSolid, impeller_solid
from trunnion.jobs.inputs.arguments import check_path, wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.messages import Wording, phrase
from trunnion.simulation.meshes import STEP_ENDINGS


def load_impeller(impeller: FilePath) -> Impeller:
    """Read the definition of an impeller, and make its surfaces.

    Parameters
    ----------
    impeller
        A definition (docs/impeller.md); its tables of points are in its folder or below.

    Returns
    -------
    Impeller
        Blades, hub and shroud as exact surfaces, mm, about Z.

    Raises
    ------
    InputError
        If a file cannot be read, or makes no impeller; with every mistake, its line or the rows of its points.

    Examples
    --------
    >>> import trunnion
    >>> impeller = trunnion.load_impeller("examples/impeller/impeller.toml")
    >>> len(list(impeller.blades()))
    6
    """
    path = check_path("impeller", impeller)
    import_extra("scipy", "impeller")  # by the name of this extra: curves, which come first, have one of their own
    return build_impeller(read_impeller(path))


def model_impeller(impeller: Impeller | FilePath, *, tolerance: float = 0.01) -> ImpellerModel:
    """Make a closed mesh of an impeller.

    Parameters
    ----------
    impeller
        Of ``trunnion.load_impeller``, or its definition.
    tolerance
        mm: how far facets may be off the surfaces.

    Returns
    -------
    ImpellerModel
        The mesh, its volume, and how far its facets are off the exact surfaces.

    Raises
    ------
    InputError
        As ``load_impeller``; or if a fillet has no room, or the bodies make no closed solid.

    Notes
    -----
    A blade is the envelope of balls on its mean surface; a fillet is what a ball that touches blade and hub leaves.

    Examples
    --------
    >>> import trunnion
    >>> model = trunnion.model_impeller("examples/impeller/impeller.toml", tolerance=0.5)
    >>> round(model.volume, -3)
    84000.0
    """
    return impeller_model(_loaded(impeller), _checked(tolerance))


def write_impeller_step(impeller: Impeller | FilePath, output: FilePath, *, tolerance: float = 0.005) -> ImpellerSolid:
    """Write an impeller as a STEP file (AP214): one closed solid with exact surfaces.

    Parameters
    ----------
    impeller
        Of ``trunnion.load_impeller``, or its definition.
    output
        The file, whose name ends in .stp or .step.
    tolerance
        mm: how far faces and edges may be off the surfaces.

    Returns
    -------
    ImpellerSolid
        The solid as it was read back from the file's bytes: its volume, its faces, and how far they are off.

    Raises
    ------
    InputError
        As ``load_impeller``; if no valid solid of the mesh's volume is made of it, with the cause; if the extra ``cad``
        is not installed, or the file cannot be written. There is no file then, and an older one stays.
    """
    path = check_path("output", output)
    if path.suffix.lower() not in STEP_ENDINGS:
        raise InputError(Problem(str(path), 0, Wording("IMP411", "no_name_of_step_file")))
    wanted = _checked(tolerance)
    found = _loaded(impeller)
    definition = found.definition
    solid = impeller_solid(found, wanted)
    with atomic_file(path, inputs=definition.files) as stream:
        stream.write(solid.step)
    return solid


def _loaded(impeller: Impeller | FilePath) -> Impeller:
    return impeller if isinstance(impeller, Impeller) else load_impeller(impeller)


def _checked(tolerance: object) -> float:
    if isinstance(tolerance, int | float) and math.isfinite(tolerance) and 1e-4 <= tolerance <= 1.0:
        return float(tolerance)
    raise wrong_argument("tolerance", tolerance, phrase("give_fine_tolerance"))
