"""``python -m trunnion``."""

from trunnion.cli import run_and_exit

run_and_exit()
