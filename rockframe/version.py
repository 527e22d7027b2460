"""The version number; it is written here only."""

__version__ = "0.1.0"
