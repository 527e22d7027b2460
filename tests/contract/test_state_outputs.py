"""Outputs of a state depend on that state alone, not on states evaluated before.

Equations of several bodies and links reuse work arrays; outputs must not contain values that an
earlier state left there.
"""

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.protocol import Start
from rockframe.solve.accuracy import LEVELS
from rockframe.solve.integrate import integrate
from rockframe.solve.observe import energies_of, memory_at_outputs, observe_run, observe_states

BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
STATUE = rf.Block(width="0.8 m", height="1.2 m", mass="1 t")
PADS = rf.TwoSpringSupport(frequency_ratio=10, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
CAP = rf.CushionCap(height="0.5 m", mass="1 t")
SLIPPERY = {"friction": 0.2}
JOINT = rf.RigidGround(**SLIPPERY)
WALL = rf.RearWall(stiffness="1 MN/m", gap="5 mm")
TIE = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="0.2 MN/m", slack="5 mm")
FRAME = rf.RockingFrame(BLOCK, columns=2, beam_mass="6 t")
PULSE = rf.GroundMotion.from_arrays(
    (3.5 * np.sin(np.linspace(0.0, 2.0 * np.pi, 41)), "m/s^2"), time_step="0.02 s"
)
SCENES = {
    "rigid ground": (BLOCK,),
    "slippery ground": (BLOCK, rf.RigidGround(**SLIPPERY)),
    "pads": (BLOCK, PADS),
    "slippery pads": (BLOCK, PADS.replace(**SLIPPERY)),
    "soil": (BLOCK, SOIL),
    "coupled": (BLOCK, PADS, CAP, SOIL),
    "cascade": (BLOCK, PADS, CAP, SOIL, {"coupling": "cascade"}),
    "wall on rigid ground": (BLOCK, WALL),
    "wall on slippery ground": (BLOCK, rf.RigidGround(**SLIPPERY), WALL),
    "wall on pads": (BLOCK, PADS, WALL),
    "tie on rigid ground": (BLOCK, TIE),
    "tie on slippery pads": (BLOCK, PADS.replace(**SLIPPERY), TIE),
    "frame with tendons": (FRAME, rf.Tendon(stiffness="0.2 MN/m", preload="5 kN")),
    "stack on rigid joints": (rf.Stack(STATUE, BLOCK, interfaces=[rf.RigidGround()]),),
    "stack that slides": (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), JOINT),
    "stack on pads": (rf.Stack(STATUE, BLOCK, interfaces=[PADS]), PADS),
    "stack of both": (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), PADS),
    "stack with a wall": (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), JOINT, WALL),
}


# their parts occur in other scenes, too
LONG_SCENES = {
    "pads", "coupled", "wall on rigid ground", "wall on slippery ground", "tie on rigid ground",
    "stack of both", "stack with a wall",
}  # fmt: skip


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(name, marks=[pytest.mark.long] * (name in LONG_SCENES)) for name in SCENES
    ],
)
def run(request):
    """Return a model and a run of it."""
    parts = [part for part in SCENES[request.param] if not isinstance(part, dict)]
    options = [part for part in SCENES[request.param] if isinstance(part, dict)]
    model = rf.System(*parts, **dict(*options)).assembly.model
    with plain_python():
        return model, integrate(
            model, Start(), PULSE.si, LEVELS["standard"], duration=1.2, output_step=0.06,
            keep_steps=True,
        )  # fmt: skip


def outputs_of(model, run, order):
    memory, row = memory_at_outputs(run)
    ground = PULSE.si.horizontal.at(run.time)
    with plain_python():
        return observe_states(
            model, run.mode[order], run.state[order], memory, row[order],
            np.column_stack([ground, np.zeros_like(ground)])[order],
        )  # fmt: skip


def test_columns_do_not_depend_on_earlier_states(run):
    model, trajectory = run
    forwards = np.arange(len(trajectory.time))
    assert np.ptp(trajectory.state[:, :3], axis=0).max() > 0.0  # the body moves
    expected, found = (outputs_of(model, trajectory, order) for order in (forwards, forwards[::-1]))
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name][::-1], values, err_msg=name)


def test_energies_do_not_depend_on_earlier_states(run):
    model, trajectory = run
    with plain_python():
        expected = energies_of(model, trajectory)
        outputs_of(model, trajectory, np.array([len(trajectory.time) // 2]))
        np.testing.assert_array_equal(energies_of(model, trajectory), expected)


def test_samples_at_step_ends_match_their_states(run):
    model, trajectory = run
    assert len(trajectory.outputs_in_steps) == len(PULSE) // 3  # while the ground has samples
    events = trajectory.events.time
    times = np.concatenate([trajectory.time, events, events])
    ground = PULSE.si.horizontal.at(times)
    with plain_python():
        _, found = observe_run(
            model, trajectory, (), np.column_stack([ground, np.zeros_like(ground)])
        )
    for name, values in outputs_of(model, trajectory, np.arange(len(trajectory.time))).items():
        size = np.abs(values).max()
        np.testing.assert_allclose(
            found[name][: len(values)], values, rtol=0.0, atol=1e-12 * size, err_msg=name
        )


def test_first_sample_follows_all_events_at_start():
    push = rf.GroundMotion.from_arrays(
        (np.repeat([5.0, 0.0], [10, 10]), "m/s^2"), time_step="0.02 s"
    )
    stack = rf.Stack(STATUE, BLOCK, interfaces=[rf.RigidGround()])
    for parts in ((BLOCK,), (BLOCK, rf.RigidGround(friction=0.6)), (stack,), (FRAME,)):
        with plain_python():
            response = rf.System(*parts).simulate(push, outputs="energy")
        assert response.event_time[0] == 0.0
        assert response.contact_state[0] == response.contact_state[1]
        assert abs(response.base_shear[0]) <= response.peak_base_shear * (1.0 + 1e-12)
        assert response.impact_energy[0] == response.kinetic_energy[0] == 0.0
        if "left_reaction" in response:
            assert response.left_reaction[0] >= 0.0
            assert response.right_reaction[0] >= 0.0


@pytest.mark.parametrize("accuracy", ["standard", "fast"])
@pytest.mark.parametrize("name", ["rigid ground", "slippery pads", "stack on pads"])
def test_energies_among_the_outputs_change_no_other_output(name, accuracy):
    noise = np.random.default_rng(3).normal(size=60)
    motion = rf.GroundMotion.from_arrays((4.0 * noise, "m/s^2"), time_step="0.02 s")
    system = rf.System(*SCENES[name])
    with plain_python():
        alone, more = (
            system.simulate(motion, outputs=outputs, accuracy=accuracy)
            for outputs in (["reaction"], ["reaction", "energy"])
        )
    assert alone.drop_attrs().identical(more[list(alone.data_vars)].drop_attrs())
