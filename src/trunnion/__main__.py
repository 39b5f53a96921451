"""``python -m trunnion``."""

from trunnion.cli import run

run()
