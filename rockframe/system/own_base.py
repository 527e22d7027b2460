"""Bases of a user's own: what a class declares that is to join in, and what it tells of a run."""

from collections.abc import Mapping
from typing import Any, ClassVar

from rockframe.components import Component
from rockframe.system.bodies import BaseLoad
from rockframe.system.support import Support


class OwnAnswers:
    """What a user's own base or scene tells of a run with histories."""

    __slots__ = ()

    def answers(
        self, histories: Mapping[str, Any], before: Mapping[str, Any], after: Mapping[str, Any]
    ) -> dict[str, Any]:
        """Give the registered columns that the system does not show at each time.

        Parameters
        ----------
        histories : mapping of str to ndarray
            Everything over ``time``, by names of the schema, in SI units.
        before, after : mapping of str to ndarray
            What the system shows just before and just after each event, and its ``time``.

        Returns
        -------
        dict of str to array or float
            By their names; none unless overridden.
        """
        return {}


class OwnBase(OwnAnswers, Component):
    """A component that carries a body, from a user's own file.

    A subclass declares its parameters as all components do, says in ``slot`` whose place it
    takes (``"pads"`` or ``"soil"``), and how it carries a body. :func:`rockframe.register`
    makes it known; from then on it stands in scenes wherever pads, or soil, do.

    Examples
    --------
    >>> import rockframe as rf
    >>> from rockframe import extension as ext
    >>> class Rubber(ext.OwnBase):
    ...     slot = "pads"
    ...     damping = ext.DampingRatio(doc="Vertical damping ratio.")
    ...
    ...     def simpler(self):
    ...         return (rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=self.si.damping),)
    ...
    ...     def support(self, load):
    ...         return ext.pads_under(*self.simpler(), load)
    >>> rubber = Rubber(damping=0.1)
    >>> rubber.misfits({"pads": rubber}), rubber.answers({}, {}, {})
    ([], {})
    """

    noun: ClassVar[str] = "base"
    slot: ClassVar[str] = ""

    def support(self, load: BaseLoad) -> Support:
        """Give the base as it is under a body.

        Parameters
        ----------
        load : BaseLoad
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
