"""Tests, which keep NumPy's linear algebra to one thread, as the command line does: two would spin on both processors.

This is imported before the settings that all tests share, and they before NumPy.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
