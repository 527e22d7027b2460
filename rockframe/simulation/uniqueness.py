"""Impacts on rigid bases after which motion is not unique, :eq:`eq-admissible`, and the telling."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.dynamics.chain.rigid import KEPT, RigidChain
from rockframe.dynamics.events import OVERTURNING, SEPARATION, SILENT, TOPPLED, UPLIFT
from rockframe.dynamics.protocol import ContactModel
from rockframe.solve.trajectory import Trajectory

_STANDS: Final = ("flies", "on its left corner", "on its right corner", "in full contact")
_ONE_OF: Final = "what follows is one of several motions"


@dataclass(frozen=True)
class Uniqueness:
    """How often the motion of a run was not unique."""

    several: int  # impacts with several admissible modes, and with none
    none: int
    held: int  # corners that were held for a while though they did not press
    cautions: tuple[str, ...]  # the same in words

    def attributes(self) -> dict[str, int]:
        """Give the numbers by their names among a run's attributes."""
        return {
            "impacts_of_several_modes": self.several,
            "impacts_of_no_mode": self.none,
            "corners_held_without_pressing": self.held,
        }


NOT_LOOKED_AT: Final = Uniqueness(0, 0, 0, ())
"""Of scenes in which motion is always unique."""


def uniqueness_of(model: ContactModel, run: Trajectory) -> Uniqueness | None:
    """Look for changes of contact after which motion is not unique; None where it always is."""
    if not isinstance(model.system, RigidChain):
        return None
    events = run.events
    sets, taken, other = (events.memory[:, model.memory.index(name)] for name in KEPT)
    by_force = np.isin(events.kind, (UPLIFT, SEPARATION, SILENT))
    impacts = ~by_force & ~np.isin(events.kind, (OVERTURNING, TOPPLED))
    several, none = impacts & (sets > 1.0), impacts & (sets == 0.0)
    held = events.kind == SILENT
    held &= sets == 0.0
    rigid = [k for k in range(model.system.bodies()) if model.system.is_rigid(k)]
    cautions = list[str]()
    if several.any():
        i = int(np.argmax(several))
        cautions.append(
            f"at {events.time[i]:.6g} s an impact has {int(sets[i])} modes: taken is that which "
            f"loses the least energy, {_named(int(taken[i]), rigid)}; the next is "
            f"{_named(int(other[i]), rigid)}; of such impacts there are {several.sum()}: {_ONE_OF}"
        )
    if none.any():
        i = int(np.argmax(none))
        cautions.append(
            f"at {events.time[i]:.6g} s an impact has no mode, and is computed with every closed "
            f"contact held along itself: {_named(int(taken[i]), rigid)}; of such impacts there are "
            f"{none.sum()}: {_ONE_OF}"
        )
    if held.any():
        i = int(np.argmax(held))
        cautions.append(
            f"at {events.time[i]:.6g} s a corner is held though it does not press, since it would "
            f"come back at once if it were let go; this happens {held.sum()} times"
        )
    return Uniqueness(int(several.sum()), int(none.sum()), int(held.sum()), tuple(cautions))


def _named(corners: int, rigid: Sequence[int]) -> str:
    """Tell which corners of bodies on rigid bases bear, from the top down."""
    return ", ".join(f"body {k + 1} {_STANDS[corners >> 2 * k & 3]}" for k in rigid)
