"""What bases and scenes of users' own tell of a run beside what their equations show."""

from collections.abc import Mapping
from typing import Any


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
