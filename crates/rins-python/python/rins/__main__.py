"""`python -m rins`: the command itself."""

import sys

from ._main import main

sys.exit(main())
