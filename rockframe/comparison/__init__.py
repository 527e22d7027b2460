"""Computing time against accuracy: comparison of models and tolerances for a scene."""

from rockframe.comparison.models import model_ladder
from rockframe.comparison.tradeoff import Recommendation, recommend, tradeoff

__all__ = ["Recommendation", "model_ladder", "recommend", "tradeoff"]


def __dir__() -> list[str]:
    return __all__
