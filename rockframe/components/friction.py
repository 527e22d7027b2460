"""The coefficient of friction of a base."""

from rockframe.components.parameters import Ratio
from rockframe.units import NOT_NEGATIVE


class Friction(Ratio[None]):
    """A coefficient of friction that runs are held to; it changes no motion."""

    def __init__(self, *, of: str) -> None:
        words = (
            f"Coefficient of friction under {of}: a run that needs more of it warns; the model "
            "holds the base all the same."
        )
        super().__init__(NOT_NEGATIVE, doc=words, default=None, example="0.5")
