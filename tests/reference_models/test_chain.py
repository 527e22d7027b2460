"""Chains of bodies against two bodies solved by hand and the reference model of stacks."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_models.stacks.scene import mirrored

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.dynamics.chain.model import bare_chain
from rockframe.dynamics.chain.rows import BASE_COLUMNS, COLUMNS, GUARDS, body_row
from rockframe.dynamics.coupled.model import system_of
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER, CORNER_GUARDS
from rockframe.dynamics.protocol import MEMORY, Ground
from rockframe.system.assembly import assemble

pytestmark = pytest.mark.reference_models

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "chain_oracle.json"
STATES = 60
OF_UPPER = np.array([.1, .01, .1, .01, .05, .05, .5, .1, .5, .1, .3, .3])  # fmt: skip


@pytest.fixture(scope="module")
def pair():
    """Return a block on pads on a cap on soil, solved by hand and as a chain."""
    parts = (
        rf.Block(width="1 m", height="4 m", mass="4 t"),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
        rf.CushionCap(height="0.9 m", mass="3 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2),
    )
    both = assemble(parts).setting.bodies()
    return system_of(*both), bare_chain(both)


def draw_body_mode(rng, base, corners: int, size: int) -> Mode:
    contact = int(rng.integers(corners)) + size * int(rng.integers(corners))
    one_end = base.is_held(contact, True) != base.is_held(contact, False)
    return Mode(contact, int(rng.integers(3)), bool(one_end and rng.random() < 0.4))


def agree(ours, theirs, share: float) -> bool:
    ours, theirs = np.array(ours), np.array(theirs)
    return bool(np.abs(ours - theirs).max() <= share * np.abs(theirs).max())


def states(pair):
    """Draw states, modes and ground accelerations."""
    by_hand, chain = pair
    rng = np.random.default_rng(3)
    for _ in range(STATES):
        upper = draw_body_mode(rng, by_hand.upper.base, 5, CORNER)
        lower = draw_body_mode(rng, by_hand.lower.base, 2, 2)
        mode = by_hand.with_body_mode(by_hand.with_body_mode(0, 0, upper), 1, lower)
        ours = chain.with_body_mode(chain.with_body_mode(0, 0, upper), 1, lower)
        assert (chain.body_mode(ours, 0), chain.body_mode(ours, 1)) == (upper, lower)
        ground = Ground(*rng.normal(size=2) * 3.0)
        yield rng.normal(size=12) * OF_UPPER, mode, ours, ground


def test_accelerations_match_two_body_solution(pair):
    by_hand, chain = pair
    for state, mode, ours, ground in states(pair):
        slope = by_hand.accelerate(mode, state, ground)
        assert agree(chain.accelerate(ours, state, ground), slope, 1e-12)
        assert agree(chain.energies(ours, state), by_hand.energies(mode, state), 1e-12)


def test_guards_match_two_body_solution(pair):
    by_hand, chain = pair
    # guards of the cap, one at each end
    lower = [0, CORNER_GUARDS, *range(2 * CORNER_GUARDS, GUARDS)]
    places = np.array([*range(GUARDS), *(GUARDS + guard for guard in lower)])
    for state, mode, ours, ground in states(pair):
        slope = by_hand.accelerate(mode, state, ground)
        theirs = by_hand.guards_in(mode, state, slope, ground)
        guards = chain.guards_in(ours, state, slope, ground)
        assert np.allclose(np.array(guards.values)[places], theirs.values, rtol=1e-10, atol=1e-10)
        assert np.allclose(np.array(guards.changes)[places], theirs.changes, rtol=1e-9, atol=1e-9)


def test_impulse_responses_match_two_body_solution(pair):
    by_hand, chain = pair
    rng = np.random.default_rng(4)
    for state, mode, ours, _ in states(pair):
        for k in (0, 1):
            if k == 1 and by_hand.lower.is_free(by_hand.body_mode(mode, 1)):
                continue  # a base without contact has no impulses
            position_and_shares = rng.normal(size=3)
            their_state, our_state = state.copy(), state.copy()
            theirs = by_hand.response(k, mode, *position_and_shares, their_state)
            response = chain.response(k, ours, *position_and_shares, our_state)
            assert agree(response[:3], theirs[:3], 1e-11)
            by_hand.respond(k, mode, theirs, their_state)
            chain.respond(k, ours, response, our_state)
            assert agree(
                our_state[:-1], their_state[:-1], 1e-11
            )  # a held cap has no independent sway


def test_observed_columns_match_two_body_solution(pair):
    by_hand, chain = pair
    memory = np.random.default_rng(5).normal(size=len(MEMORY) + 1)
    # motion and forces of the block, the cap's motion, the block on the cap, then the bases
    cap = COLUMNS + np.arange(4)
    bases = [
        *range(COLUMNS - BASE_COLUMNS, COLUMNS - 1),
        *range(2 * COLUMNS - BASE_COLUMNS, 2 * COLUMNS),
    ]
    places = np.array([*range(12), *cap, 12, 13, *bases])
    for state, mode, ours, ground in states(pair):
        slope = by_hand.accelerate(mode, state, ground)
        theirs = by_hand.observe(mode, state, slope, ground, memory)
        assert agree(
            np.array(chain.observe(ours, state, slope, ground, memory))[places], theirs, 1e-10
        )


def test_unknown_base_law_raises(pair):
    by_hand, _ = pair
    body, numbers = (
        by_hand.upper.body,
        assemble(
            (
                rf.Block(width="1 m", height="4 m", mass="4 t"),
                rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
            )
        ).setting.support.base_numbers,
    )
    with pytest.raises(TypeError, match="stands on pads, on a bed or on rigid bases, got tuple"):
        body_row(body, replace(numbers, law=(1.0,)), 1.0, 0.0, 0.0)


if COMPILED:
    from reference_models.stacks.comparison import compare_scene, model_of, rotations, run_chain
    from reference_models.stacks.random_scenes import draw

    # the reference model takes most of a minute to compile
    @pytest.mark.long
    @pytest.mark.parametrize(("bodies", "scenes"), [(1, 3), (2, 3), (3, 4), (5, 1), (8, 1)])
    def test_random_stacks_move_as_in_the_reference_model(bodies, scenes):
        for one in range(scenes):
            found = compare_scene(draw(np.random.default_rng([5, bodies, one]), bodies))
            assert found.difference < 1e-6, one
            assert found.run.energy_residual < 1e-8, one

    def test_mirrored_stack_gives_mirrored_response():
        scene = replace(draw(np.random.default_rng([77, 3, 5]), 3), rotation=0.05)
        ours = run_chain(scene, None, "standard", 0.01)
        mirror = run_chain(mirrored(scene), None, "standard", 0.01)
        model, other = model_of(scene), model_of(mirrored(scene))
        assert len(ours.events.time) > 4
        assert np.abs(rotations(model, ours) + rotations(other, mirror)).max() < 1e-12

    @pytest.mark.long
    def test_fast_and_standard_stay_near_reference_model():
        scene = draw(np.random.default_rng([77, 3, 5]), 3)
        assert compare_scene(scene, "fast").difference < 1e-2
        assert compare_scene(scene, "standard").difference < 1e-5


def test_documented_comparison_matches_data():
    tables = json.loads(DATA.read_text())
    page = (DATA.parents[1] / "validation_scenes.md").read_text()
    for table in tables:
        row = f"| {table['bodies']} | {table['scenes']} | {table['agree']} | "
        assert row in page
        assert f"| {table['uplifting']} | {table['overturning']} | {table['events']} |" in page
        assert table["agree"] >= 0.99 * table["scenes"]
