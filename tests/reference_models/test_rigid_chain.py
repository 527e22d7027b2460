"""Chains on rigid bases: one body against Housner's, impacts of two against the reference model."""

import math

import numpy as np
import pytest
from reference_models.rigid_pair.choices import ALL, strike
from reference_models.rigid_pair.count_impacts import KINDS, draw_impact
from reference_models.rigid_pair.pair import Body, Pair, Pattern, Phase

import rockframe as rf
from rockframe.dynamics.base_numbers import rigid_numbers
from rockframe.dynamics.bodies import ROTATION
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import solve_trial, write_trial_data
from rockframe.dynamics.chain.model import chain_model
from rockframe.dynamics.chain.motion import (
    NOT_ELIMINATED,
    add_base_load,
    add_tangential_load,
    set_inertia_loads,
    write_kinematics,
)
from rockframe.dynamics.chain.rigid import ADMISSIBLE_COUNT, CHOSEN_CORNERS
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, Ground, Start
from rockframe.dynamics.single_body import rigid_body
from rockframe.dynamics.vibrations import ChainBody
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.system.assembly import assemble

pytestmark = pytest.mark.reference_models

STILL = Ground(0.0, 0.0)
EQUAL = Pair(Body.uniform(1.0, 2.0, 1.0), Body.uniform(1.0, 2.0, 1.0))
ENDS = {"none": 0, "left": 1, "right": 2, "both": 3}


def housner_and_chain(block):
    """Return a block on rigid ground, as Housner's block and as a chain of one body."""
    setting = assemble((block,)).setting
    law = setting.load.law(setting.body.mass)
    one = ChainBody(law, rigid_numbers(law), 1.0, 0.0, 0.0)
    return setting, chain_model([one], setting.body.mass)


def model_of(pair: Pair):
    """Return two blocks on rigid bases, per unit mass of the upper one."""
    links, measure = [], pair.upper.mass
    offset = pair.offset + pair.upper.beside - pair.lower.beside
    for body_data, shift in ((pair.upper, offset), (pair.lower, 0.0)):
        body = rigid_body(
            left=body_data.half_width + body_data.beside,
            right=body_data.half_width - body_data.beside,
            height=body_data.below,
            inertia=body_data.inertia / measure,
            restraint=0,
            small_rotation=False,
            gravity=pair.gravity,
        )
        links.append(
            ChainBody(body, rigid_numbers(body), body_data.mass / measure, body_data.above, shift)
        )
    return chain_model(links, measure)


def impact_by_chain(pair: Pair, place, speed, touching):
    """Return the pattern after an impact, the number of admissible ones, and velocities."""
    model, (lower, upper) = model_of(pair), (pair.lower, pair.upper)
    system, state, memory = model.system, np.zeros(12), np.zeros(len(model.memory))
    cosine, sine = math.cos(place[2]), math.sin(place[2])
    along, normal = np.array([cosine, -sine]), np.array([sine, cosine])
    between, moving = place[3:5] - place[:2], speed[3:5] - speed[:2]
    state[:6] = (
        place[5] - place[2], between @ normal - lower.above - upper.below, place[2],
        place[1] - lower.below, between @ along, place[0],
    )  # fmt: skip
    state[6:] = (
        speed[5] - speed[2], moving @ normal + (between @ along) * speed[2], speed[2], speed[1],
        moving @ along - (between @ normal) * speed[2], speed[0],
    )  # fmt: skip
    weight = {"joint": 1, "ground": 4}
    closed = sum(
        weight[key] * ENDS[end] for key, ends_touching in touching.items() for end in ends_touching
    )
    flying = system.with_bearing_corners(0, 0, 0)
    energy_before = system.energies(flying, state).kinetic
    assert 2.0 * energy_before * upper.mass == pytest.approx(pair.masses @ speed**2, rel=1e-11)
    new = system.choose_bearing_corners(flying, closed, 0, 0, state, STILL, memory)
    energy_after = system.energies(new, state).kinetic
    assert memory[IMPACT_LOSS] == pytest.approx(
        energy_before - energy_after, abs=1e-12 * energy_before
    )
    work = system.workspace()
    velocities = [
        work[k * BODY_STRIDE + i] if i >= 0 else sum(state[6 + 2 * j] for j in range(k, 2))
        for k in (1, 0)
        for i in (at.SPEED_X, at.SPEED_Y, -1)
    ]
    start = HELD_PLACE + 2
    chosen = int(memory[start + CHOSEN_CORNERS])
    bears = {number: name for name, number in ENDS.items()}
    pattern = Pattern(bears[chosen >> 2], bears[chosen & 3])
    return (
        pattern,
        int(memory[start + ADMISSIBLE_COUNT]),
        np.array(velocities),
        energy_after / energy_before,
    )


def test_chain_of_one_body_matches_housner_block():
    rng = np.random.default_rng(1)
    impacts = compared = number = 0
    while compared < 30:
        number += 1
        width, height = rng.uniform(0.3, 2.0), rng.uniform(2.0, 6.0)
        eccentricity = rng.uniform(-0.1, 0.1) * width if number % 3 == 0 else 0.0
        middle = (f"{0.5 * height} m", f"{eccentricity} m")
        setting, model = housner_and_chain(
            rf.Block(width=f"{width} m", height=f"{height} m", mass="1 t", centre_of_mass=middle)
        )
        start, motion = Start(), None
        if number % 5 == 4:
            start = Start(0.5 * setting.overturning_angle)
        else:
            times = np.arange(0.0, 3.0, 0.01)
            peak = rng.uniform(0.8, 3.0) * 9.81 * width / height
            across = peak * np.sin(2.0 * np.pi * rng.uniform(0.5, 2.0) * times)
            up = rng.uniform(-4.0, 4.0) * np.sin(6.0 * np.pi * times)
            motion = rf.GroundMotion.from_arrays(
                (across, "m/s^2"), "0.01 s", vertical=(up, "m/s^2")
            ).si
        housner, ours = (
            integrate(
                model_run, start, motion, accuracy_of("reference"), duration=6.0, output_step=0.05
            )
            for model_run in (setting.compile(), model)
        )
        if (ours.events.memory[:, HELD_PLACE + 1 + ADMISSIBLE_COUNT] != 1.0).any():
            continue  # a corner that does not press may separate: Housner's block is held
        compared += 1
        assert ours.status == housner.status, number
        assert len(ours.events.time) == len(housner.events.time), number
        difference = np.abs(ours.state[:, 0] - housner.state[:, 0])
        assert difference.max() < 1e-9 * np.abs(housner.state[:, 0]).max() + 1e-15, number
        assert ours.energy_residual < 1e-9
        impacts += len(ours.events.time)
    assert impacts > 300


@pytest.mark.parametrize("slenderness", [1.5, 3.0, 8.0])
def test_impact_of_one_body_has_housner_restitution(slenderness):
    _, model = housner_and_chain(rf.Block(width="1 m", height=f"{slenderness} m", mass="1 t"))
    system, state, memory = model.system, np.zeros(6), np.zeros(len(model.memory))
    mode = system.with_bearing_corners(0, 2, 0)
    state[3] = -1.0
    system.fix_held_points(mode, state, memory)
    new = system.switch(mode, 0, state, STILL, memory)
    assert system.bearing_corners(new) == 1
    expected = 1.0 - 1.5 * math.sin(math.atan(1.0 / slenderness)) ** 2
    assert state[3] == pytest.approx(-expected, abs=4e-16)


@pytest.mark.parametrize(
    ("before", "after", "rates", "energy"),
    [
        (Pattern("right", "both"), ("left", "both"), (-31 / 34, -31 / 34), 961 / 1156),
        (Pattern("both", "right"), ("left", "left"), (-9 / 49, -47 / 98), 109 / 196),
    ],
)
def test_landings_of_two_equal_blocks_in_exact_numbers(before, after, rates, energy):
    phase = Phase(EQUAL, before, 0.0)
    place = phase.placed(np.zeros(phase.size))
    speed = phase.motions(0.0, 0.0)[0] @ np.full(phase.size, -1.0)
    pattern, admissible, six, share = impact_by_chain(EQUAL, place, speed, ALL)
    assert (pattern, admissible) == (after, 1)
    assert (six[2], six[5]) == pytest.approx(rates, abs=1e-14)
    assert share == pytest.approx(energy, abs=1e-14)


@pytest.mark.long
def test_random_impacts_of_two_blocks():
    """Outcomes match the reference model, also where not exactly one pattern is admissible."""
    rng, others = np.random.default_rng(5), dict.fromkeys(KINDS, 0)
    for kind in KINDS:
        for number in range(250):
            pair, place, speed, touching = draw_impact(rng, kind)
            theirs = strike(pair, pair.offset, place, speed, touching)
            pattern, admissible, six, _ = impact_by_chain(pair, place, speed, touching)
            assert admissible == theirs.admissible, (kind, number)
            others[kind] += admissible != 1
            size = np.abs(speed).max()
            assert six == pytest.approx(theirs.motion, abs=1e-9 * size), (kind, number)
            if admissible == 1:
                assert pattern == theirs.pattern, (kind, number)
    assert others[KINDS[0]] == others[KINDS[1]] == 0
    assert sum(others.values()) > 5


def changes():
    """Return functions that change positions or loads of bodies."""
    return {
        "places": lambda system, state, work: write_kinematics(system, 0, state, work),
        "loads": lambda system, state, work: set_inertia_loads(system, 0.1, 0.2, work),
        "press": lambda system, state, work: add_base_load(system, 0, 1.0, 0.1, work),
        "friction": lambda system, state, work: add_tangential_load(system, 0, 1.0, work),
        "levers": lambda system, state, work: write_trial_data(system, True, state),
        "forces": lambda system, state, work: system.solve(system.body_count, 0, work),
    }


@pytest.mark.parametrize("change", changes())
def test_elimination_is_invalidated_when_positions_or_loads_change(change):
    stone, block = rf.RigidGround(friction=0.3), rf.Block(width="1 m", height="1 m", mass="1 t")
    stack = rf.Stack(block, block, interfaces=[stone])
    system = rf.System(stack, stone).assembly.model.system
    state, work = np.zeros(2 * system.coordinates()), system.workspace()
    last = (system.body_count - 1) * BODY_STRIDE + at.TRIAL_CODE
    write_kinematics(system, 0, state, work)
    set_inertia_loads(system, 0.0, 9.8, work)
    write_trial_data(system, False, state)
    solve_trial(system, 0, 0b1111, 0b1111, False, False, 1e-12, state)
    assert work[last] != NOT_ELIMINATED
    changes()[change](system, state, work)
    assert work[last] == NOT_ELIMINATED
    work[(system.body_count - 1) * BODY_STRIDE + at.FORCES_VALID] = 1.0
    changes()[change](system, state, work)
    assert not system.forces_are_valid(0, state, STILL)


def column(count):
    """Return the equations of a stack of equal blocks, and the mode and state of rest."""
    stone, block = rf.RigidGround(friction=0.3), rf.Block(width="1 m", height="1 m", mass="1 t")
    model = rf.System(rf.Stack(*[block] * count, interfaces=[stone] * (count - 1)), stone)
    model = model.assembly.model
    return model.system, *model.initial(Start())[:2]


def test_cached_forces_are_valid_only_for_same_mode_state_and_ground():
    system, standing, state = column(12)
    ground = Ground(0.5, 0.1)
    system.find_forces(standing, state, ground)
    assert system.forces_are_valid(standing, state, ground)
    slips = system.with_body_mode(standing, 0, system.body_mode(standing, 0)._replace(slides=True))
    moved = state.copy()
    moved[-1] = 1e-12
    assert not system.forces_are_valid(slips, state, ground)
    assert not system.forces_are_valid(standing, moved, ground)
    assert not system.forces_are_valid(standing, state, Ground(0.5, 0.2))
    large = 2**60  # beyond it floats do not distinguish modes
    system.find_forces(standing, state, ground)
    note = system.solved_inputs()
    note[0], note[1] = large >> 32, 0.0
    assert system.forces_are_valid(large, state, ground)
    assert not system.forces_are_valid(large + 1, state, ground)


def test_resting_bodies_act_as_ground_for_bodies_above():
    """A block that rocks on two at rest moves as if all forces were solved for."""
    system, standing, state = column(3)
    rocks = system.with_bearing_corners(standing, 0b111101, 0)
    state[ROTATION], state[system.coordinates() + ROTATION] = 0.02, -0.3
    ground = Ground(0.7, -0.2)
    full = np.array(system.find_forces(rocks, state, ground))
    reduced = np.array(system.accelerate(rocks, state, ground))
    assert not system.forces_are_valid(rocks, state, ground)
    assert np.abs(full[: system.coordinates()]).max() > 1.0
    np.testing.assert_allclose(reduced, full, rtol=1e-12, atol=1e-12)
    at_rest = np.array(system.accelerate(standing, state * 0.0, ground))
    np.testing.assert_array_equal(at_rest, 0.0 * at_rest)
