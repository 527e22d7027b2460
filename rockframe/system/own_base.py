"""Bases of a user's own: what a class declares that is to join in."""

from collections.abc import Mapping
from typing import ClassVar

from rockframe.components import Component
from rockframe.system.load import Load
from rockframe.system.own_answers import OwnAnswers
from rockframe.system.support import Support


class OwnBase(OwnAnswers, Component):
    """A component that carries a body, from a user's own file.

    A subclass declares its parameters as all components do, says in ``slot`` whose place it
    takes (``"pads"`` or ``"soil"``), and how it carries a body. :func:`rockframe.register`
    makes it known; from then on it stands in scenes wherever pads, or soil, do.
    """

    noun: ClassVar[str] = "base"
    slot: ClassVar[str] = ""

    def support(self, load: Load) -> Support:
        """Give the base as it is under a body.

        Parameters
        ----------
        load : Load
            The body, and how it is held.

        Returns
        -------
        Support
        """
        raise NotImplementedError

    def simpler(self) -> tuple[Component, ...]:
        """Give simpler bases to compare it with, the simplest first.

        Returns
        -------
        tuple of Component
            For the same slot; none unless overridden.
        """
        return ()

    def misfits(self, parts: Mapping[str, Component]) -> list[str]:
        """Give the faults of the parts that it is with.

        Parameters
        ----------
        parts : mapping
            Components by their slots.

        Returns
        -------
        list of str
            Each names the parts, and what would mend the combination; none unless overridden.
        """
        return []
