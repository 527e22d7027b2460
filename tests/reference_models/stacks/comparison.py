"""Runs a scene by the reference model and by rockframe's chain of bodies."""

import math
from dataclasses import dataclass

import numpy as np
from reference_models.maximal.motions import build_motions

from rockframe.dynamics.base_numbers import bed_numbers, pads_numbers
from rockframe.dynamics.body import BY_CONTACT, CENTRE, LEADING_CORNER
from rockframe.dynamics.chain.link_rows import GROUND, ChainLink
from rockframe.dynamics.chain.model import chain_model
from rockframe.dynamics.links import LinkNumbers
from rockframe.dynamics.links import Tie as LawOfTie
from rockframe.dynamics.protocol import ContactModel, Start, column_of
from rockframe.dynamics.single_body import rigid_body
from rockframe.dynamics.vibrations import ChainBody
from rockframe.signals import Motion
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.solve.observe import memory_at_outputs, observe_states
from rockframe.solve.trajectory import Trajectory

from .scene import GRAVITY, Bed, Scene, apart
from .simulate import History, simulate

RULES = {"contact-state": BY_CONTACT, "leading-corner": LEADING_CORNER, "centre": CENTRE}


@dataclass(frozen=True)
class Compared:
    """Both runs of a scene, the reference's up to its own end."""

    reference: History
    run: Trajectory
    rotation: np.ndarray  # of all bodies, from the package

    @property
    def difference(self) -> float:
        """Greatest difference of a rotation, over the largest one."""
        count = min(len(self.rotation), len(self.reference.time))
        ours, theirs = self.rotation[:count], self.reference.rotation[:count]
        return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


def model_of(scene: Scene) -> ContactModel:
    """Return the package's model of a scene, upright at rest."""
    links, measure, carried = [], scene.bodies[0].mass, 0.0
    below = [*(one.eccentricity for one in scene.bodies[1:]), 0.0]
    for body_data, base, lower in zip(scene.bodies, scene.bases, below, strict=True):
        carried += body_data.mass
        offset = body_data.offset + body_data.eccentricity - lower
        body = rigid_body(
            left=body_data.half_width + body_data.eccentricity,
            right=body_data.half_width - body_data.eccentricity,
            height=body_data.height,
            inertia=body_data.inertia / measure,
            restraint=RULES[scene.rule],
            small_rotation=False,
            gravity=GRAVITY,
        )
        numbers = {
            "stiffness": base.stiffness / measure,
            "damping": base.damping / measure,
            "load": carried / measure,
        }
        if isinstance(base, Bed):
            base_law = bed_numbers(body, by_pressure=False, **numbers)
        else:
            restitution = base.restitution
            eps = restitution if isinstance(restitution, tuple) else (restitution, restitution)
            base_law = pads_numbers(body, restitution=eps, **numbers)
        links.append(ChainBody(body, base_law, body_data.mass / measure, body_data.top, offset))
    ties = []
    for tie in scene.ties:
        stiffness, viscous = tie.stiffness / measure, tie.damping / measure
        law = LawOfTie(
            stiffness, viscous, tie.slack or 0.0, math.inf, 1.0, 1.0 if tie.slack is None else 0.0
        )
        to = GROUND if tie.to is None else tie.to
        to_point = (0.0, 0.0) if tie.to is None else tie.to_point
        numbers = LinkNumbers(law, stiffness, viscous, (1e-3,))
        ties.append(ChainLink(tie.on, tie.on_point, to, to_point, apart(scene, tie), numbers))
    return chain_model(links, measure, ties=ties)


def run_chain(scene: Scene, motion: Motion | None, accuracy: str, step: float) -> Trajectory:
    """Run a scene by the package."""
    shaken = 0.0 if motion is None else motion.duration
    return integrate(
        model_of(scene), Start(scene.rotation, scene.rate), motion, accuracy_of(accuracy),
        duration=shaken + scene.free, output_step=step,
    )  # fmt: skip


def rotations(model: ContactModel, run: Trajectory) -> np.ndarray:
    """Return the rotations of all bodies at the output times, shape (samples, bodies)."""
    memory, row = memory_at_outputs(run)
    still = np.zeros((len(run.time), 2))
    shown = observe_states(model, run.mode, run.state, memory, row, still)
    names = [column_of("rotation", k) for k in range(model.system.bodies())]
    return np.column_stack([shown[name] for name in names])


def compare_scene(scene: Scene, accuracy: str = "reference") -> Compared:
    """Run a scene by both programs; its motion is one for `maximal.motions.build_motions`."""
    motion, excitation = build_motions(scene.motion)
    reference = simulate(scene, excitation)
    step = float(reference.time[1] - reference.time[0])
    run = run_chain(scene, None if motion is None else motion.si, accuracy, step)
    return Compared(reference, run, rotations(model_of(scene), run))
