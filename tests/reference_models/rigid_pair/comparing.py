"""Run a scene of two rigid blocks by the reference model and by the package's chain of bodies."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import rockframe as rf
from rockframe.dynamics.alone_model import rigid_body
from rockframe.dynamics.base_numbers import rigid_numbers
from rockframe.dynamics.chain.model import ChainBody, chain
from rockframe.dynamics.protocol import ContactModel, Start, column_of
from rockframe.signals import Motion
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.solve.layout import Status
from rockframe.solve.observe import memory_at_outputs, observe_states
from rockframe.solve.trajectory import Trajectory

from . import drawing
from .drawing import FREE, Scene
from .pair import Pair
from .simulate import Run, simulate

STEP = 0.01
"""Of the rotations that are compared [s]."""


@dataclass(frozen=True)
class Compared:
    """Both runs, as long as both last; rotations of the upper body, then of the lower one."""

    reference: Run
    run: Trajectory
    rotation: np.ndarray  # by the package

    def difference(self, until: float = math.inf) -> float:
        """Give the greatest difference of a rotation up to a time, over the largest one."""
        count = min(len(self.rotation), len(self.reference.time))
        within = self.reference.time[:count] < min(until, self.reference.end)
        ours = self.reference.place[:count, [5, 2]][within]
        apart = np.abs(self.rotation[:count][within] - ours)
        # rotations below rounding are no motion
        return float(np.max(apart, initial=0.0) / np.max(np.abs(ours), initial=1e-9))

    @property
    def lasts(self) -> bool:
        """Whether the package's run ends where the reference model's does."""
        return self.run.status == Status.COMPLETED or self.run.overturned

    @property
    def same_verdict(self) -> bool:
        """Whether both overturn or neither does."""
        return bool(self.run.overturned) == self.reference.overturned

    @property
    def impacts(self) -> tuple[int, int]:
        """Impacts that lose a thousandth of the greatest loss or more, and those found in both."""
        end = min(float(self.run.end_time), self.reference.unique_until)
        ours = [e for e in self.reference.events if e.kind == "impact" and e.time < end]
        strongest = max((e.lost for e in ours), default=0.0)
        counted = [e.time for e in ours if e.lost > 1e-3 * strongest]
        theirs = np.append(self.run.events.time, -1.0)
        both = sum(bool(np.min(np.abs(theirs - one)) < 1e-6) for one in counted)
        return len(counted), both


def model_of(pair: Pair) -> ContactModel:
    """Give the package's model of a pair."""
    links, measure = [], pair.upper.mass
    for one, lower, offset in ((pair.upper, pair.lower, pair.offset), (pair.lower, None, 0.0)):
        body = rigid_body(
            left=one.half_width + one.beside,
            right=one.half_width - one.beside,
            height=one.below,
            inertia=one.inertia / measure,
            restraint=0,
            small_rotation=False,
            gravity=pair.gravity,
        )
        beside = 0.0 if lower is None else offset + one.beside - lower.beside
        links.append(ChainBody(body, rigid_numbers(body), one.mass / measure, one.above, beside))
    left, right = pair.limits[0]
    return chain(links, measure, limits=[(-left, right)])


def motion_of(motion: dict[str, Any]) -> rf.GroundMotion:
    """Give the package's ground motion."""
    if motion["form"] == "record":
        step, across, up = drawing.record_of(motion)
        return rf.GroundMotion.from_arrays((across, "m/s^2"), f"{step!r} s", vertical=(up, "m/s^2"))
    make = getattr(rf.GroundMotion, f"{motion['form']}_pulse")
    made = [
        make(f"{motion[key]!r} m/s^2", f"{motion['frequency']!r} Hz", motion["cycles"])
        for key in ("peak", "vertical")
        if key == "peak" or motion[key]
    ]
    return made[0] if len(made) == 1 else made[0].with_vertical(made[1])


def run_chain(pair: Pair, motion: Motion, accuracy: str) -> Trajectory:
    """Run a pair by the package, at rest at first."""
    return integrate(
        model_of(pair), Start(0.0, 0.0), motion, accuracy_of(accuracy),
        duration=motion.duration + FREE, output_step=STEP,
    )  # fmt: skip


def rotations(model: ContactModel, run: Trajectory) -> np.ndarray:
    """Give the rotations of both bodies at the output times, shape (samples, 2)."""
    memory, row = memory_at_outputs(run)
    shown = observe_states(model, run.mode, run.state, memory, row, np.zeros((len(run.time), 2)))
    return np.column_stack([shown[column_of("rotation", k)] for k in (0, 1)])


def compared(scene: Scene, accuracy: str = "reference") -> Compared:
    """Run a scene by both."""
    pieces, period = drawing.pieces_for(scene.motion)
    reference = simulate(scene.pair, pieces, STEP, quickest=period)
    run = run_chain(scene.pair, motion_of(scene.motion).si, accuracy)
    return Compared(reference, run, rotations(model_of(scene.pair), run))
