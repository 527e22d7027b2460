"""Bounds that every run must keep, however extreme its scene."""

from dataclasses import dataclass

import numpy as np
from extremes.scenes import Scene

RESIDUAL = {"standard": 1e-5, "reference": 1e-8}
"""Largest energy imbalance over the largest energy."""

ENDS = ("completed", "overturned", "toppled")
"""Allowed ends of a run."""

STEPS_PER_EVENT = 40
LEAST_STEPS = 10_000
STEPS_PER_PERIOD = {"standard": 100, "reference": 400}
"""Numbers of steps allowed per radian of the fastest motion, per sample and per event."""


@dataclass(frozen=True)
class Verdict:
    """Measures of a run relative to its bounds."""

    end: str
    residual: float
    steps: int
    allowed: int
    finite: bool

    @property
    def failures(self) -> list[str]:
        """Name the bounds that the run breaks."""
        broken = []
        if self.end not in ENDS:
            broken.append(f"ends as {self.end}")
        if not self.finite:
            broken.append("not finite")
        if not self.residual <= 1.0:
            broken.append(f"imbalance {self.residual:.2g} of its bound")
        if self.steps > self.allowed:
            broken.append(f"{self.steps} steps, {self.allowed} allowed")
        return broken


def steps_allowed(scene: Scene, events: int, accuracy: str) -> int:
    """Return the bound of the number of steps, rejected ones included.

    Explicit steps follow the fastest motion, the more so with supercritical dashpots.
    """
    pads = scene.frequency_ratio * (1.0 + 2.0 * scene.damping_ratio)
    # a light cap between hard pads and the soil moves faster than either alone
    light = 1.0 + scene.cap_share**-0.5
    soil = scene.soil_ratio * (1.0 + 2.0 * scene.soil_damping)
    slender = 1.0 + 1.0 / scene.slenderness
    rate = {"rigid": 1.0, "pads": pads, "soil": soil}.get(scene.base, light * (pads + soil))
    turns = scene.duration * scene.omega * slender * rate / (2.0 * np.pi)
    samples = scene.duration / scene.time_step
    per_period = STEPS_PER_PERIOD[accuracy]
    return int(LEAST_STEPS + per_period * (turns + samples) + STEPS_PER_EVENT * events)


def judge(scene: Scene, accuracy: str) -> Verdict:
    """Run a scene and compare it with the bounds."""
    response = scene.run(accuracy)
    values = [
        response[name].values
        for name in response.data_vars
        if response[name].dtype.kind == "f" and name not in UNDEFINED
    ]
    return Verdict(
        end=response.status.attrs["flag_meanings"].split()[response.status.item()],
        residual=float(response.energy_residual.item()) / RESIDUAL[accuracy],
        steps=int(response.attrs["solver_steps"]) + int(response.attrs["solver_rejected_steps"]),
        allowed=steps_allowed(scene, response.sizes["event"], accuracy),
        finite=all(np.isfinite(value).all() for value in values),
    )


UNDEFINED = frozenset({"first_uplift_time", "overturning_time", "uplift_angle"})
"""Results that are NaN if their event did not happen."""
