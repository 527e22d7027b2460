"""What the models leave out, for a report; the page "Validity" of the manual tells more."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from rockframe.components import FrameEquivalent
from rockframe.system.parts import Parts


@dataclass(frozen=True)
class Limit:
    """Something that models leave out."""

    title: str  # as on the page of the manual
    words: str  # what it means for a result
    # whether a scene with these parts is concerned
    concerns: Callable[[Parts], bool] = lambda _: True


def _on_rigid_ground(parts: Parts) -> bool:
    return parts.pads is None and parts.soil is None and not parts.own


SLIDING: Final = "Sliding"
FLIGHT: Final = "Flight on rigid ground"
LIMITS: Final = (
    Limit(
        SLIDING,
        "The base does not slide while it presses. The verdict holds only where the friction is "
        "at least what it says is needed.",
        lambda parts: not parts.own,
    ),
    Limit(
        "Deformation",
        "The block is rigid: its own vibration neither stores nor dissipates energy.",
    ),
    Limit(
        "Third dimension",
        "Motion stays in a plane: no twisting, and no rolling on an edge.",
    ),
    Limit(
        "Shape",
        "The body touches with its base only; a corner beyond the base that would come down "
        "earlier goes through the ground.",
    ),
    Limit(
        FLIGHT,
        "A block on rigid ground is not followed into the air; where it would leave the ground "
        "the run warns.",
        _on_rigid_ground,
    ),
    Limit(
        "Flight on pads",
        "In flight the block falls freely at a constant rate of rotation.",
        lambda parts: parts.pads is not None,
    ),
    Limit(
        "Soft pads, soft soil",
        "Where pads or soil are so soft that the upright position is unstable, the run warns.",
        lambda parts: parts.pads is not None or parts.soil is not None,
    ),
    Limit(
        "Soil",
        "The springs of the bed are elastic and do not know of one another: no yielding, no "
        "permanent settlement, no strength that limits the pressure, no influence of frequency.",
        lambda parts: parts.soil is not None,
    ),
    Limit(
        "Suction",
        'Unless the option separation is "pressure", dashpots of the bed may pull at the base.',
        lambda parts: parts.soil is not None,
    ),
    Limit(
        "Cap",
        "The cap is rigid and does not slide.",
        lambda parts: parts.cap is not None,
    ),
    Limit(
        "Frames",
        "The frame is a rigid block with its outline and mass.",
        lambda parts: isinstance(parts.block, FrameEquivalent),
    ),
    Limit(
        "Walls",
        "An impact on a stiff wall lasts no time, and leaves the share of the "
        "speed that its law says.",
        lambda parts: parts.wall is not None,
    ),
    Limit(
        "Rocking frames",
        "Columns and beam are rigid, the columns equal; the beam stays level and on the columns, "
        "and neither it nor they slide.",
        lambda parts: parts.frame is not None,
    ),
    Limit(
        "Floors",
        "A motion of a floor is that of an elastic building which does not feel the object.",
    ),
)
"""In the order of the page."""
GENERAL: Final = (
    "Overturning is the rotation at which the weight no longer brings the body back, the angle "
    "of unstable equilibrium, not a fall to the ground.",
    "Rocking near that angle is sensitive: small differences of the motion or of a parameter "
    "grow, so that a single verdict near a boundary says little. The certificate tells how near.",
)
"""What holds of every verdict."""


def limits_of(parts: Parts | None, *, slides: bool = False) -> list[Limit]:
    """Give the limits that concern a scene; all of them where its parts are not known.

    Equations in which the block slides have it fly, too.
    """
    found = [one for one in LIMITS if parts is None or one.concerns(parts)]
    return [one for one in found if not (slides and one.title in (SLIDING, FLIGHT))]
