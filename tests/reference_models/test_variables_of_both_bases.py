"""A stack whose two bases both have their own states and variables.

They have no effect here: each variable grows at its own rate, and no end changes its state. All
other results are as without them, although modes exceed sixteen bits. The example of a user's base
tests that stacks on bases with variables give the same numbers when compiled.
"""

from typing import NamedTuple

import numpy as np
import pytest
from plain_python import plain_python

from rockframe.dynamics.base_numbers import BaseNumbers, pads_numbers, pads_over
from rockframe.dynamics.body import LEADING_CORNER
from rockframe.dynamics.coupled.model import coupled
from rockframe.dynamics.point_law import Viscoelastic, point_law
from rockframe.dynamics.protocol import Column, Start
from rockframe.dynamics.single_body import rigid_body
from rockframe.dynamics.starting import UPRIGHT
from rockframe.dynamics.vibrations import ChainBody
from rockframe.signals import Motion
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.solve.observe import memory_at_outputs, observe_states

RATES = (3.0, 5.0)
"""Growth rates of the variables of the upper and the lower base [s^-1]."""
CAP_MASS = 0.4


@point_law
class AgeingPad(NamedTuple):
    """An elastic pad with its age as a variable, in a unit of its own."""

    stiffness: float
    damping: float
    rate: float

    def elastic(self):
        return Viscoelastic(self.stiffness, self.damping)

    def states(self):
        return 3

    def guard(self, state, point, own):
        return 1.0, 0.0

    def variables(self):
        return 1

    def rates(self, state, point, own):
        return (self.rate,)

    def spring(self, point, own):
        return self.elastic().spring(point, ())

    def force(self, state, point, own):
        return self.elastic().force(state, point, ())

    def force_rate(self, state, point, own):
        return self.elastic().force_rate(state, point, ())

    def energy(self, point, own):
        return self.elastic().energy(point, ())

    def energies(self, point, at_rest, own):
        return self.elastic().energies(point, at_rest, ())

    def power(self, state, point, own):
        return self.elastic().power(state, point, ())

    def return_rate(self):
        return self.elastic().return_rate()

    def seen(self, state, point, own):
        return (own[0],)


def aged(base: BaseNumbers, name: str, rate: float) -> BaseNumbers:
    """Return pads with age."""
    law = AgeingPad(*base.law.law, rate)
    columns = [Column(f"{side}_{name}") for side in ("left", "right")]
    return pads_over(law, base, columns=columns, variable_scales=[1.0])


def stack(above, below):
    """Return the model of a block on a cap; `above` and `below` make bases of pads."""
    block, cap = (
        rigid_body(
            left=half_width,
            right=half_width,
            height=height,
            inertia=mass * (half_width**2 + height**2) / 3.0,
            restraint=LEADING_CORNER,
            small_rotation=False,
            gravity=9.81,
        )
        for half_width, height, mass in ((0.5, 2.0, 1.0), (0.5, 0.25, CAP_MASS))
    )
    pads = pads_numbers(block, stiffness=4e3, damping=20.0, restitution=(0.9, 0.9))
    soil = pads_numbers(cap, stiffness=2e3, damping=30.0, restitution=(1.0, 1.0))
    return coupled(
        ChainBody(block, above(pads), 1.0, 0.0, 0.0),
        ChainBody(cap, below(soil), CAP_MASS, cap.height, 0.0),
        1e4,
        [UPRIGHT, UPRIGHT],
    )


def shaken(model):
    samples = 6.0 * np.sin(2.0 * np.pi * np.arange(101) / 100.0)
    motion = Motion.of_samples(0.01, samples, np.zeros(101))
    return integrate(
        model, Start(), motion, accuracy_of("reference"), duration=0.8, output_step=0.01
    )


def observed(model, run):
    ground = np.zeros((len(run.time), 2))
    return observe_states(model, run.mode, run.state, *memory_at_outputs(run), ground)


@pytest.mark.long
@pytest.mark.reference_models
def test_each_base_of_stack_has_own_variables_and_states():
    plain = stack(lambda pads: pads, lambda pads: pads)
    model = stack(
        lambda pads: aged(pads, "age_above", RATES[0]),
        lambda pads: aged(pads, "age_below", RATES[1]),
    )
    with plain_python():
        expected, run = shaken(plain), shaken(model)
        plain_histories, histories = observed(plain, expected), observed(model, run)
    assert len(expected.events.time) > 4
    np.testing.assert_allclose(run.events.time, expected.events.time, atol=1e-9)
    for name, history in plain_histories.items():
        np.testing.assert_allclose(
            histories[name], history, atol=1e-7 * (1e-9 + np.abs(history).max()), err_msg=name
        )
    for name, rate in zip(("age_above", "age_below"), RATES, strict=True):
        for side in ("left", "right"):
            np.testing.assert_allclose(histories[f"{side}_{name}"], rate * run.time, rtol=1e-12)
    assert run.mode.max() > np.iinfo(np.int16).max
    for body in range(2):
        np.testing.assert_array_equal(
            model.contact_states(run.mode, body), plain.contact_states(expected.mode, body)
        )
