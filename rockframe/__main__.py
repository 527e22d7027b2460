"""``python -m rockframe``: the command line."""

import sys

from rockframe.command.main import main

sys.exit(main())
