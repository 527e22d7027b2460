"""Proof of the verdict of a block on pads: its numbers in balls, its start, and the result."""

import math
from typing import Final

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.body import PIVOT_CENTRE
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.pads import corner_contact
from rockframe.dynamics.single_body import SingleBody
from rockframe.proof.balls import ball
from rockframe.proof.pads.flow import single_state
from rockframe.proof.pads.law import Contacts, PadBalls
from rockframe.proof.pads.prover import Callback, PadProver
from rockframe.proof.problem import Deviations, PiecewiseGround
from rockframe.proof.sets import prove_for_set, prove_verdict
from rockframe.proof.verdict import Proof, Tolerances
from rockframe.signals import Motion
from rockframe.signals.motion import Incline
from rockframe.system.bodies import OverturningAngles

LAW: Final = "the law of two pads"
_REACH: Final = 1.6
"""Length of a step, over the inverse of the fastest angular frequency."""


def pad_numbers(part: BodyOnBase, limits: OverturningAngles, inputs: Deviations) -> PadBalls:
    """Return a block on elastic pads in balls."""
    body, base = part.body, part.base
    return PadBalls(
        ball(body.height), ball(body.left), ball(body.right), ball(body.inertia),
        ball(body.pin(PIVOT_CENTRE)), ball(base.law.stiffness), ball(base.law.damping),
        (ball(base.left_restitution) + inputs.left_restitution,
         ball(base.right_restitution) + inputs.right_restitution),
        ball(base.rest), body.restraint, body.small, (ball(limits.left), ball(limits.right)),
        ball(body.gravity),
    )  # fmt: skip


def pad_prover(
    law: SingleBody,
    mode: int,
    state: Vector,
    motion: Motion,
    slope: Incline,
    limits: OverturningAngles,
    *,
    scale: float = 1.0,
    inputs: Deviations | None = None,
    callback: Callback | None = None,
) -> PadProver:
    """Return the prover of a block on pads, with the block at its start."""
    part, body = law.part, law.state_of(0, state)
    pads = pad_numbers(part, limits, inputs or Deviations())
    contact = part.mode_of(mode).contact
    contacts = Contacts(corner_contact(contact, True), corner_contact(contact, False))
    vertical = math.sqrt(2.0 * float(pads.stiffness))
    arm = math.sqrt(float(pads.inertia) + float(pads.height) ** 2)
    width = float(pads.left) ** 2 + float(pads.right) ** 2
    fastest = max(vertical, math.sqrt(float(pads.stiffness) * width) / arm)
    weights = np.array([1.0, fastest, arm, arm * fastest, arm * fastest])
    weights = 2.0 ** np.round(np.log2(weights))
    step_length = _REACH / fastest
    ground = PiecewiseGround(motion, ball(scale), slope, step_length)
    begin = [
        body.rotation, body.angular_velocity, body.vertical, body.vertical_velocity,
        body.horizontal_velocity if contacts.in_flight else 0.0,
    ]  # fmt: skip
    return PadProver(
        pads, ground, contacts, single_state(begin), weights, step_length, callback=callback
    )


def prove_pads(
    law: SingleBody,
    mode: int,
    state: Vector,
    motion: Motion,
    slope: Incline,
    limits: OverturningAngles,
    *,
    scale: float,
    within: Tolerances,
) -> Proof:
    """Prove the verdict of a block on pads, from its mode and its state at the start.

    The pads must be elastic, the ground level, and the restraint not that of the leading corner.
    """

    def attempt(inputs: Deviations) -> tuple[Proof, list[float]]:
        prover = pad_prover(law, mode, state, motion, slope, limits, scale=scale, inputs=inputs)
        return prove_verdict(prover, scale, LAW), []

    return prove_for_set(attempt, within)
