"""Common parts of the checks: the scenes that they accept, the motions, and the runs."""

from collections.abc import Mapping
from typing import Any, NamedTuple, cast

from rockframe.errors import ComponentError, short_repr
from rockframe.measures.common import by_label
from rockframe.motion import GroundMotion
from rockframe.motion.pair import motion_hint
from rockframe.simulation.system import System, system_hint
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.system.stack import RestrainedSetting
from rockframe.units import QuantityLike


def rigid_block_setting(
    system: object, owner: str, *, allow_loads: bool = False, allow_sliding: bool = False
) -> RigidGroundSetting | RestrainedSetting:
    """Return the setting of a block that rocks on level rigid ground; refuse any other scene.

    With `allow_loads` it may carry loads that are masses, with `allow_sliding` it may slide.
    """
    if not isinstance(system, System):
        msg = f"{owner}: system needs a System, got {short_repr(system)}{system_hint(system)}"
        raise ComponentError(msg)
    setting = system.setting
    level = system.options.slope.level
    if system.parts.block is not None and level:
        if isinstance(setting, RigidGroundSetting) and (allow_sliding or not setting.slides):
            return setting
        if (
            allow_loads
            and isinstance(setting, RestrainedSetting)
            and not setting.slides
            and not setting.links  # links other than loads that are masses
        ):
            return setting
    carried = ", which may carry loads that are masses," if allow_loads else ","
    names = ", ".join(type(part).__name__ for part in system.parts.structural())
    slope = "" if level else " on a slope"
    hint = ", or with sliding='checked', which holds it" if setting.slides else ""
    msg = (
        f"{owner}: the check is of a block on level rigid ground{carried} got {names}{slope}, "
        f"{setting.model}; check the block alone, rf.System(block){hint}"
    )
    raise ComponentError(msg)


def read_motions(value: object, owner: str) -> dict[str, GroundMotion]:
    """Read one motion, or several by their labels."""
    several = {value.name: value} if isinstance(value, GroundMotion) else value
    if not isinstance(several, Mapping):
        msg = (
            f"{owner}: expected a GroundMotion or several by their labels, got "
            f"{short_repr(value)}{motion_hint(value)}"
        )
        raise ComponentError(msg)
    motions = by_label(cast("Mapping[Any, Any]", several), owner=owner)
    for label, motion in motions.items():
        if not isinstance(motion, GroundMotion):
            found = f"{short_repr(motion)}{motion_hint(motion)}"
            msg = f"{owner}: {label!r} needs a GroundMotion, got {found}"
            raise ComponentError(msg)
    return motions


class PeakResponse(NamedTuple):
    """The largest motion of a block under one ground motion."""

    rotation: float  # [rad]
    overturned: bool
    displacement: float  # of a point, horizontally to either side [m]


def peak_responses(
    system: System,
    motions: Mapping[str, GroundMotion],
    free_vibration: QuantityLike,
    point: tuple[float, float] = (0.0, 0.0),
) -> dict[str, PeakResponse]:
    """Return the largest motion of the block, and of a point of it [m], under each motion."""
    x, y = point
    points = {"point": (f"{x!r} m", f"{y!r} m")}

    def response(motion: GroundMotion) -> PeakResponse:
        run = system.simulate(motion, outputs=None, free_vibration=free_vibration, points=points)
        displacement = float(run.peak_point_horizontal_displacement[0])
        return PeakResponse(float(run.peak_rotation), bool(run.overturned), displacement)

    return {label: response(motion) for label, motion in motions.items()}


def scene_summary(system: System) -> str:
    """Describe the scene that is checked, with its numbers, in one line."""
    return ", ".join(map(repr, system.parts.structural()))
