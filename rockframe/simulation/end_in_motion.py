"""Whether a body that stands at the end of a run could still overturn by itself."""

from typing import Final

import numpy as np

from rockframe.dynamics.protocol import Ending, Ground
from rockframe.solve.trajectory import Summary
from rockframe.system.assembly import Assembly
from rockframe.system.overturning_energy import stored_energy

AT_REST: Final = 0.2
"""Share of the overturning angle, and of the typical size of all velocities, up to which a body has
less than the energy to overturn: held at that angle a third of it, 1 - (1 - 0.2)^2."""

STILL_MOVING: Final = (
    "the run ends while the body, which stands, still has the energy to overturn: add "
    "free_vibration='10 s', still ground after the motion, to see whether it comes to rest"
)


def may_overturn_later(system: Assembly, summary: Summary) -> bool:
    """Tell whether a body that stood has as much energy as overturning takes.

    What shakes it is over: its energy is that of its motion and what it takes to hold it at its
    rotation, :eq:`eq-overturning-energy`.

    Parameters
    ----------
    system : Assembly
        The scene.
    summary : Summary
        What became of a run.

    Returns
    -------
    bool
        False of a body that overturned, of a run that was broken off, and where nothing holds
        the body upright.
    """
    if summary.overturned is not False:
        return False
    model, setting, ending = system.model, system.setting, summary.ending
    rotation, size = model.rotation_in(ending.state), model.system.coordinates()
    rates, sizes = ending.state[size : 2 * size], model.scales[size : 2 * size]
    upright = abs(rotation) < AT_REST * setting.overturning_angle
    if upright and bool(np.all(np.abs(rates) < AT_REST * sizes)):
        return False
    kinetic = _kinetic_energy(system, ending)
    needed = setting.overturning_energy
    return 0.0 < needed <= kinetic + stored_energy(setting, rotation)


def _kinetic_energy(system: Assembly, ending: Ending) -> float:
    """Give the kinetic energy of the body relative to the ground [J]."""
    model, body = system.model, system.setting.body
    ground = Ground(system.options.slope.along_gravity, 0.0)
    slope = model.system.accelerate(ending.mode, ending.state, ground)
    seen = model.system.observe(ending.mode, ending.state, slope, ground, ending.memory)
    found = dict(zip((column.name for column in model.columns), seen, strict=True))
    square = found["horizontal_velocity"] ** 2 + found["vertical_velocity"] ** 2
    return 0.5 * (body.mass * square + body.inertia * found["angular_velocity"] ** 2)
