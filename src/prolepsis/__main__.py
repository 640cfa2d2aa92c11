"""``python -m prolepsis`` is the command line."""

import sys

from prolepsis.cli import main

sys.exit(main())
