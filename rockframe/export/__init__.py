"""Results and scenes for other programs: pelicun, OpenQuake and OpenSees."""

from typing import TYPE_CHECKING

from rockframe.export._fragility import to_openquake, to_pelicun
from rockframe.export._opensees import to_opensees
from rockframe.suggestions import public_names

__all__ = ["to_openquake", "to_opensees", "to_pelicun"]

if not TYPE_CHECKING:  # otherwise type checkers would accept any name
    __getattr__, __dir__ = public_names(__name__, __all__)
