"""``python -m trunnion``."""

import sys

from trunnion.cli import main

sys.exit(main())
