"""The command line: ``rockframe``, or ``python -m rockframe``."""
