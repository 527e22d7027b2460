"""Results and scenes for other programs: pelicun, OpenQuake and OpenSees."""

from rockframe.export._fragility import to_openquake, to_pelicun
from rockframe.export._opensees import to_opensees

__all__ = ["to_openquake", "to_opensees", "to_pelicun"]


def __dir__() -> list[str]:
    return __all__
