"""Consistency of histories of random scenes of all kinds.

Velocities are the rates of displacements between events; peaks are not exceeded by histories;
elongations follow the bodies.
"""

import numpy as np
import pytest
from benchmarks.random_parts import PARTS, draw_scene

import rockframe as rf
from rockframe.errors import AssemblyError

pytestmark = [
    pytest.mark.long,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]

SEEDS = range(7000, 7010)
FINER = 40  # output samples per sample of the motion
RATES = {
    "rotation": "angular_velocity",
    "vertical_displacement": "vertical_velocity",
    "slip": "slip_velocity",
    "body_rotation": "body_angular_velocity",
}
PEAKS = {
    "peak_rotation": "rotation",
    "peak_base_shear": "base_shear",
    "peak_body_rotation": "body_rotation",
    "peak_restrainer_force": "restrainer_force",
    "peak_point_horizontal_displacement": "point_horizontal_displacement",
    "peak_point_vertical_displacement": "point_vertical_displacement",
}
TIED = ("friction on pads", "friction on rigid ground")


def scenes(seed):
    rng = np.random.default_rng(seed)
    for part in PARTS:
        try:
            system, motion = draw_scene(part, rng)
        except AssemblyError:  # the pads are too soft to stand on
            continue
        yield part, system, motion
    for part in TIED:
        on = part.removeprefix("friction on ")
        _, motion = draw_scene("friction on pads", rng)
        base = rf.RigidGround(friction=rng.uniform(0.05, 1.0))
        if on == "pads":
            base = rf.TwoSpringSupport(frequency_ratio=rng.uniform(8.0, 40.0), damping_ratio=0.1)
        block = rf.Block(width="1 m", height=f"{rng.uniform(2.0, 6.0)} m", mass="2 t")
        tie = rf.Restrainer(
            on=("-0.5 m", f"{rng.uniform(0.5, 2.0)} m"), to=(f"{rng.uniform(-3.0, -1.0)} m", "0 m"),
            stiffness=f"{10.0 ** rng.uniform(4.0, 7.0)} N/m", slack=f"{rng.uniform(0.0, 5.0)} mm",
        )  # fmt: skip
        yield f"tied, {on}", rf.System(block, base, tie), motion


def runs(seed):
    for name, system, motion in scenes(seed):
        step = motion.time_step.m_as("s")
        try:
            run = system.simulate(
                motion, output_step=f"{step / FINER} s", points={"p": ("0.1 m", "0.5 m")}
            )
        except AssemblyError:  # the pads are too soft to stand on
            continue
        if int(run.status) <= 2:  # reached its end
            yield name, run, step


def rows(values):
    return np.atleast_2d(values.to_numpy())


@pytest.mark.parametrize("seed", SEEDS)
def test_histories_agree(seed):
    seen = set()
    for name, run, step in runs(seed):
        seen |= {*RATES, *RATES.values(), *PEAKS} & {*run}
        time = run.time.to_numpy()
        width = step / FINER
        # forces have kinks at those of the ground motion and at events
        bends = np.concatenate([run.event_time, np.arange(0.0, time[-1] + step, step)])
        away = np.abs(time[1:-1, None] - bends).min(axis=1) > 2.1 * width
        away &= np.abs(time[2:] - time[:-2] - 2.0 * width) < 1e-9
        for place, rate in RATES.items():
            if place in run and rate in run:
                differences = (rows(run[place])[:, 2:] - rows(run[place])[:, :-2]) / (2.0 * width)
                rates = rows(run[rate])
                curvature = np.abs(
                    np.diff(rates, 2)
                )  # six times the error of the central difference
                size = max(np.abs(rates).max(), 1e-6)  # [m/s] or [rad/s]: less is rounding
                error = np.abs(differences - rates[:, 1:-1]) - curvature - 1e-6 * size
                assert (error[:, away] <= 1e-3 * size).all(), (name, seed, place)
        before_overturning = ~(time > run.attrs["overturning_time"])
        for peak, history in PEAKS.items():
            # peaks exclude the instants at which friction stops a new held point
            stops = peak == "peak_base_shear" and "slip" in run
            if peak in run and history in run and not stops:
                most = np.abs(rows(run[history])[:, before_overturning]).max(axis=1)
                assert (np.atleast_1d(run[peak]) >= (1.0 - 1e-3) * most - 1e-9).all(), (name, peak)
        if "restrainer_elongation" in run:
            moves = np.abs(np.diff(run.rotation)) > 1e-6
            still = (np.diff(rows(run.restrainer_elongation)) == 0.0) & moves
            assert (still.sum(axis=1) <= 5).all(), (name, seed)
    assert seen == {*RATES, *RATES.values(), *PEAKS}
