"""User-defined bases: their base class, and further results that they may return."""

from collections.abc import Mapping
from typing import Any, ClassVar

from rockframe.components import Component
from rockframe.system.bodies import BaseLoad
from rockframe.system.support import Support


class OwnAnswers:
    """Further results of a user-defined base or scene for a run with histories."""

    __slots__ = ()

    def answers(
        self, histories: Mapping[str, Any], before: Mapping[str, Any], after: Mapping[str, Any]
    ) -> dict[str, Any]:
        """Return the registered columns that are not among those of the equations.

        Parameters
        ----------
        histories : mapping of str to ndarray
            All histories over ``time``, by names of the schema, in SI units.
        before, after : mapping of str to ndarray
            Columns of the system just before and just after each event, and its ``time``.

        Returns
        -------
        dict of str to array or float
            Values by the names of the columns; none unless overridden.
        """
        return {}


class OwnBase(OwnAnswers, Component):
    """A user-defined component that carries a body.

    A subclass declares its parameters like all components, the slot that it fills (``"pads"`` or
    ``"soil"``), and a method that returns its support under a body. After registration by
    :func:`rockframe.register` it can replace pads, or soil, under a single body without links.

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
        """Return the base as it is under a body.

        Parameters
        ----------
        load : BaseLoad
            The body on the base, with the options of its system.

        Returns
        -------
        Support
        """
        raise NotImplementedError

    def simpler(self) -> tuple[Component, ...]:
        """Return simpler bases to compare it with, the simplest first.

        Returns
        -------
        tuple of Component
            Bases for the same slot; none unless overridden.
        """
        return ()

    def misfits(self, parts: Mapping[str, Component]) -> list[str]:
        """Return the faults of its combination with other parts.

        Parameters
        ----------
        parts : mapping
            All components of the scene by their slots.

        Returns
        -------
        list of str
            Each names the parts and a remedy; none unless overridden.
        """
        return []
