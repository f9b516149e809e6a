"""`python -m modeproof`: the same as the command `modeproof`."""

import sys

if sys.version_info < (3, 11):  # noqa: UP036  before any import that an older Python cannot read
    sys.exit("modeproof: Python 3.11 or newer is needed, this is " + sys.version.split()[0])

from modeproof.cli import main

sys.exit(main())
