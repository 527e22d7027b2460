"""The component of a ground motion that is looked at."""

from enum import StrEnum

from rockframe.arguments import one_of_words
from rockframe.errors import ComponentError, shown
from rockframe.motion import GroundMotion
from rockframe.signals import Signal


class GroundComponent(StrEnum):
    """Which acceleration of a motion is looked at."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


def signal_of(motion: object, component: object, *, owner: str) -> Signal:
    """Take one component of a motion.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    component : {"horizontal", "vertical"}
        Which acceleration.
    owner : str
        Function, for the message.

    Returns
    -------
    Signal

    Raises
    ------
    ComponentError
        Not a motion, not a component, or the motion lacks it.
    """
    if not isinstance(motion, GroundMotion):
        msg = f"{owner}: motion needs a GroundMotion, got {shown(motion)}"
        raise ComponentError(msg)
    if component_of(component, owner=owner) is GroundComponent.HORIZONTAL:
        return motion.si.horizontal
    if motion.si.vertical is None:
        msg = f"{owner}: component='vertical', but {motion.name!r} has no vertical acceleration"
        raise ComponentError(msg)
    return motion.si.vertical


def component_of(given: object, *, owner: str) -> GroundComponent:
    """Read the argument `component`.

    Parameters
    ----------
    given : {"horizontal", "vertical"}
        What the user gave.
    owner : str
        Function, for the message.

    Returns
    -------
    GroundComponent

    Raises
    ------
    ComponentError
        None of the two.
    """
    return one_of_words(GroundComponent, given, owner=owner, name="component")
