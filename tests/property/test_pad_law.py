"""Pads bear a force where their law requires it: N = max(0, k(delta - y) - c y') below delta.

Checked at the states of random runs on pads, alone, coupled and by cascade, with horizontal and
vertical motion, squat and slender blocks, light and heavy dashpots.
"""

import numpy as np
import pytest

import rockframe as rf
from rockframe.dynamics.pads import RELAXING, corner_contact
from rockframe.dynamics.protocol import Start
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate

pytestmark = pytest.mark.property

RULES = ("contact-state", "leading-corner", "centre")
STEP = 0.01


def excitation(rng, slope):
    time = np.arange(301) * STEP
    across = slope * 9.81 * rng.uniform(1.0, 4.0)
    x, y = (
        size * np.sin(2.0 * np.pi * rng.uniform(1.0, 8.0) * time + rng.uniform(0.0, 6.0))
        for size in (across, rng.uniform(2.0, 9.0))
    )
    return rf.GroundMotion.from_arrays((x, "m/s^2"), f"{STEP} s", vertical=(y, "m/s^2"))


def scene(kind, rule, rng):
    slenderness = rng.uniform(1.0, 5.0)
    block = rf.Block.from_size(
        radius=f"{rng.uniform(0.5, 5.0)} m", slenderness=slenderness, mass="10 t"
    )
    pads = rf.TwoSpringSupport(
        frequency_ratio=rng.uniform(8.0, 40.0), damping_ratio=rng.uniform(0.05, 0.6)
    )
    parts = [block, pads]
    if kind != "pads":
        width, height = block.si.width, block.si.height
        # over the least for stability of block and cap
        stiffness = rng.uniform(4.0, 30.0) * 1.5 * 14e3 * 9.81 * height / (0.5 * width) ** 3
        parts += [
            rf.CushionCap(height=f"{0.15 * width} m", mass="4 t"),
            rf.WinklerSoil(stiffness=f"{stiffness} Pa", damping_ratio=rng.uniform(0.05, 0.4)),
        ]
    coupling = {} if kind == "pads" else {"coupling": kind}
    return rf.System(*parts, restraint=rule, **coupling), excitation(rng, 1.0 / slenderness)


def block_on_pads(kind, system):
    """Return the block with its pads; among the bodies of a system it is the first."""
    return system.part if kind == "pads" else system.upper


def free_forces(kind, model, run):
    """Return the law's force in weights at each free corner below its pad's level, by sample."""
    system = model.system
    body, pads = block_on_pads(kind, system)
    gravity = 9.80665
    free = {}  # modes of the run, and the free corners in each
    for mode in np.unique(run.mode):
        contact = system.body_mode(int(mode), 0).contact
        free[mode] = [left for left in (True, False) if corner_contact(contact, left) == RELAXING]
    forces = []
    for mode, state in zip(run.mode, run.state, strict=True):
        for left in free[mode]:
            line = body.base_line_at(system.state_of(0, state))
            if pads.corner(left, line).pressed > 0.0:
                forces.append(pads.reaction(RELAXING, left, line, ()) / gravity)
    return forces


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("kind", ["pads", "coupled", "cascade"])
@pytest.mark.parametrize("count", [15, pytest.param(25, marks=pytest.mark.long)])
def test_free_corner_is_never_pressed(kind, rule, count):
    rng = np.random.default_rng(5)
    relaxing = 0
    for _ in range(count):
        system, motion = scene(kind, rule, rng)
        model = system.setting.compile()
        run = integrate(
            model, Start(), motion.si, accuracy_of("standard"),
            duration=3.0, output_step=1e-3, stop_at_overturning=True,
        )  # fmt: skip
        found = free_forces(kind, model, run)
        relaxing += len(found)
        assert max(found, default=0.0) < 1e-4
    assert relaxing > 500
