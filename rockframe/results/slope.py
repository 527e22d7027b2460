"""What an inclined base changes in the results of a run, :eq:`eq-incline-energy`."""

from collections.abc import Mapping

import numpy as np

from rockframe.dynamics.protocol import ContactModel
from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array
from rockframe.signals.slope import Slope
from rockframe.solve.observe import memory_at_outputs
from rockframe.solve.trajectory import Trajectory
from rockframe.system.words import angle_words
from rockframe.units import ANGLE

OF_WHAT_IT_STANDS_ON = ("cap_acceleration",)
"""Accelerations along the base that a model shows with the part of gravity in them."""


def slope_attributes(slope: Slope) -> dict[str, str]:
    """Say in which axes a result is; said of every run."""
    axes = "horizontal and vertical"
    if not slope.level:
        side = "right" if slope.inclination > 0.0 else "left"
        axes = (
            f"along and normal to the base, which is inclined by "
            f"{angle_words(abs(slope.inclination))} and higher on the {side}; rotations are "
            "relative to it; ground accelerations are horizontal and vertical"
        )
    return {"inclination": f"{slope.inclination!r} {ANGLE.unit}", "axes": axes}


def ground_on_slope(ground: Array, slope: Slope) -> tuple[Array, Array]:
    """Give the ground's acceleration along and normal to the base."""
    if slope.level:
        return ground, ground
    moved = np.column_stack(slope.turned(ground[:, 0], ground[:, 1]))
    return moved, moved + np.array([slope.along_gravity, 0.0])


def without_gravity(shown: Mapping[str, Generic], slope: Slope) -> dict[str, Generic]:
    """Take gravity out of the absolute accelerations that a model shows."""
    return {
        name: values - slope.along_gravity if name in OF_WHAT_IT_STANDS_ON else values
        for name, values in shown.items()
    }


def energies_on_slope(
    energies: Mapping[str, Array],
    model: ContactModel,
    run: Trajectory,
    displacement: Array,
    slope: Slope,
) -> dict[str, Generic]:
    """Count the work of gravity along the base as gravity energy, and not as input.

    By :eq:`eq-incline-energy`.
    """
    found = dict(energies)
    raised = model.mass * slope.along_gravity * (displacement + _of_carrier(model, run))
    found["potential_energy"] = energies["potential_energy"] + raised
    found["input_energy"] = energies["input_energy"] + (raised - raised[0])
    return found


def _of_carrier(model: ContactModel, run: Trajectory) -> Array | float:
    """Give what the body under another one adds to the displacement, by the ratio of masses."""
    from rockframe.dynamics.cascade.system import Cascade
    from rockframe.dynamics.coupled.system import Coupled
    from rockframe.dynamics.stacked import LOWER

    system = model.system
    if not isinstance(system, Cascade | Coupled):
        return 0.0
    memory, rows = memory_at_outputs(run)
    places = np.array(
        [
            system.place(LOWER, int(mode), state, memory[row])
            for mode, state, row in zip(run.mode, run.state, rows, strict=True)
        ]
    )
    # in a cascade both stages have their own body, and the displacement is the sum of theirs
    ratio = system.mass_ratio - 1.0 if isinstance(system, Cascade) else system.cap_mass
    return ratio * places
