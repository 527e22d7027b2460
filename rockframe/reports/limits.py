"""What the models neglect, for a report; the page "Validity" of the manual explains it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from rockframe.components import FrameEquivalent
from rockframe.system.parts import Parts


@dataclass(frozen=True)
class Limit:
    """A limit of the models."""

    title: str  # as on the page of the manual
    meaning: str  # for a result
    # whether it concerns a scene with these parts
    applies_to: Callable[[Parts], bool] = lambda _: True
    study_meaning: str = ""  # for the results of a study, where that differs


SLIDING: Final = "Sliding"
FLIGHT: Final = "Flight on rigid ground"
LIMITS: Final = (
    Limit(
        SLIDING,
        "The base does not slide while it is in contact. The verdict holds only if the coefficient "
        "of friction is at least the one that it states as needed.",
        lambda parts: not parts.own,
        "The base does not slide while it is in contact. The verdict on a case holds only if the "
        "coefficient of friction is at least the peak friction demand of its run.",
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
        "The body makes contact only with its base; a corner outside the base that would reach the "
        "ground earlier passes through it.",
    ),
    Limit(
        FLIGHT,
        "Free flight of a block on rigid ground is not modelled; the run warns where the block "
        "would leave the ground.",
        lambda parts: parts.pads is None and parts.soil is None and not parts.own,
    ),
    Limit(
        "Flight on pads",
        "In flight the block falls freely at a constant angular velocity.",
        lambda parts: parts.pads is not None,
    ),
    Limit(
        "Soft pads, soft soil",
        "Where pads or soil are so soft that the upright position is unstable, the run warns.",
        lambda parts: parts.pads is not None or parts.soil is not None,
    ),
    Limit(
        "Soil",
        "The springs of the bed are elastic and independent of one another: no yielding, no "
        "permanent settlement, no strength that limits the pressure, no influence of frequency.",
        lambda parts: parts.soil is not None,
    ),
    Limit(
        "Suction",
        'Unless the option separation is "pressure", dashpots of the bed may pull the base '
        "downwards.",
        lambda parts: parts.soil is not None,
    ),
    Limit(
        "Cap",
        "The cap is rigid, and slides only if the soil has a coefficient of friction.",
        lambda parts: parts.cap is not None,
    ),
    Limit(
        "Frames",
        "The frame is a rigid block with its outline and mass.",
        lambda parts: isinstance(parts.block, FrameEquivalent),
    ),
    Limit(
        "Walls",
        "An impact on a stiff wall is instantaneous, and leaves the share of the speed that its "
        "law of restitution gives.",
        lambda parts: parts.rigid_wall is not None,
    ),
    Limit(
        "Rocking frames",
        "Columns and beam are rigid, the columns equal; the beam stays level and on the columns, "
        "and neither it nor they slide.",
        lambda parts: parts.frame is not None,
    ),
    Limit(
        "Floors",
        "The motion of a floor is that of an elastic building, without the effect of the object "
        "on the building.",
    ),
)
"""In the order of the page."""
GENERAL: Final = (
    "Overturning means that the rotation reaches the angle of unstable equilibrium, at which the "
    "weight no longer restores the body, not that the body falls to the ground.",
    "Rocking near that angle is sensitive: small differences of the motion or of a parameter "
    "grow, so that a single verdict near a boundary means little.",
)
"""Limits of every verdict."""
WITH_CERTIFICATE: Final = "The certificate shows how near the boundary is."
WITHOUT_CERTIFICATE: Final = (
    "The certificate of a run, which this page does not have, shows how near the boundary is."
)
STUDY_WITHOUT_CERTIFICATE: Final = (
    "Studies have no certificates: that of one case, run by itself, shows how near the boundary is."
)
"""What follows the last of them."""


def model_limits(parts: Parts | None, *, slides: bool = False) -> list[Limit]:
    """Return the limits that concern a scene; all of them if its parts are not known."""
    # equations in which the block slides include its flight, too
    limits = [limit for limit in LIMITS if parts is None or limit.applies_to(parts)]
    return [limit for limit in limits if not (slides and limit.title in (SLIDING, FLIGHT))]
