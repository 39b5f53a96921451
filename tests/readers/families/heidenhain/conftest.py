"""Klartext programs as texts, run on a machine."""

from tests.support.klartext_reading import dmu65 as dmu65
from tests.support.klartext_reading import run as run
