"""``python -m rockframe``: the command line."""

import sys

from rockframe.command.main import main

if __name__ == "__main__":
    sys.exit(main())
