"""`python -m modeproof`: the same as the command `modeproof`."""

import sys

from modeproof.cli import main

sys.exit(main())
