"""Impellers: from a definition and measured points to surfaces and a closed mesh."""

import math

from trunnion.api.arguments import check_path, wrong_argument
from trunnion.api.reading import FilePath
from trunnion.extras import import_extra
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller
from trunnion.impeller.model import ImpellerModel, impeller_model


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
    if not (isinstance(tolerance, int | float) and math.isfinite(tolerance) and 1e-4 <= tolerance <= 1.0):
        raise wrong_argument("tolerance", tolerance, "give a number from 0.0001 to 1")
    return impeller_model(impeller if isinstance(impeller, Impeller) else load_impeller(impeller), float(tolerance))
