"""A scene in words."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """What a scene is said to be.

    Parameters
    ----------
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    restraint : str
        Which point of the base is held horizontally.
    uplift : list of (str, str)
        Each uplift angle, with its name and where it comes from.
    numbers : list of (str, str)
        The numbers that a reader wants to see, with their names.
    left_out : list of str
        What the model does not have.
    """

    equations: list[tuple[str, str]]
    restraint: str
    uplift: list[tuple[str, str]]
    numbers: list[tuple[str, str]]
    left_out: list[str]
