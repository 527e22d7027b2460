"""Whether screening a sweep costs less than running all of it by tolerance."""

from collections.abc import Iterable

from rockframe.motion import GroundMotion
from rockframe.system.alone import AloneSetting
from rockframe.system.assembly import Assembly


def pays_to_screen(system: Assembly, motions: Iterable[GroundMotion | None]) -> bool:
    """Tell whether two runs by fixed steps cost less than one by tolerance.

    On rigid ground there are no more steps by tolerance. Under pulses in closed form there are
    few of either kind, so that a second run costs what surrounds the steps; those of several
    bodies are dear enough.
    """
    if not system.setting.steps_cost_most:
        return False
    return not isinstance(system.setting, AloneSetting) or any(
        one is None or one.recipe is None for one in motions
    )
