"""The reference model of stacks, against that of one or two bodies and by balances."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("numba")
from reference_models.maximal.excitation import HARMONIC
from reference_models.maximal.motions import build_motions
from reference_models.maximal.random_scenes import draw as draw_known
from reference_models.maximal.scene import Scene as Known
from reference_models.maximal.simulate import Excitation
from reference_models.maximal.simulate import simulate as simulate_known
from reference_models.stacks.contact import COMPLETED
from reference_models.stacks.forces import accelerate
from reference_models.stacks.from_maximal import as_stack
from reference_models.stacks.impulses import jump, relate
from reference_models.stacks.random_scenes import draw
from reference_models.stacks.scene import GRAVITY, Bed, Body, Pads, Scene, mirrored, stack_of
from reference_models.stacks.simulate import simulate
from reference_models.stacks.starting import rest_of, state_at

# tests of a reference model that rarely changes
pytestmark = [pytest.mark.reference_models, pytest.mark.long]

SCENES = {"plain": 24, "eccentric": 8}
COLUMNS = {"pads": [3, 4, 5], "bed": [0, 1, 2], "coupled": [3, 4, 5, 0, 1, 2]}


def pulse(peak: float = 4.0, vertical: float = 2.0) -> Excitation:
    return Excitation.pulse(HARMONIC, 1.0 / 64.0, 64, 1.0, 0.0, peak, vertical)


def block(width: float, height: float, **options) -> Body:
    mass = 2000.0 * width * height
    inertia = mass * (width**2 + height**2) / 12.0
    return Body(mass, inertia, 0.5 * width, 0.5 * height, 0.5 * height, **options)


def pads(bodies, frequency: float = 60.0, share: float = 0.1, eps: float = 0.6) -> tuple[Pads, ...]:
    """Return pads with the same frequency and damping ratio under each load."""
    loads = np.cumsum([body.mass for body in bodies])
    return tuple(Pads(0.5 * m * frequency**2, share * m * frequency, eps) for m in loads)


def stack(count: int, **options) -> Scene:
    bodies = tuple(block(1.2 + 0.1 * k, 2.0 - 0.1 * k) for k in range(count))
    return Scene(bodies, pads(bodies), rotation=0.1, **options)


@pytest.mark.parametrize("kind", COLUMNS)
@pytest.mark.parametrize("variant", ["plain", "eccentric"])
def test_one_or_two_bodies_match_maximal_coordinates_model(kind, variant):
    for number in range(SCENES[variant]):
        known = replace(draw_known(kind, 1, number, variant), separation="displacement")
        if known.small:
            continue
        motion = build_motions(known.motion)[1]
        one, other = simulate_known(known, motion), simulate(as_stack(known), motion)
        assert other.status == one.status, number
        assert len(other.events) == len(one.events), number
        theirs = one.states[:, COLUMNS[kind]]
        ours = other.place.reshape(theirs.shape)
        for mine, known_one in zip((ours - ours[0]).T, (theirs - theirs[0]).T, strict=True):
            size = max(np.max(np.abs(known_one)), 1e-6)
            assert mine == pytest.approx(known_one, abs=1e-9 * size), number


@pytest.mark.parametrize("count", [3, 5])
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
def test_energies_balance(count, rule):
    history = simulate(stack(count, rule=rule), pulse())
    assert len(history.events) > 20
    assert len({event.base for event in history.events}) > 1
    assert all(event.lost > -1e-10 * history.start_energy for event in history.events)
    assert abs(history.imbalance) < 1e-10


def test_energies_balance_on_a_bed_with_offsets():
    bodies = (
        block(0.8, 1.5, offset=0.05, eccentricity=0.03), block(1.0, 1.5, offset=-0.1),
        block(1.6, 1.0, eccentricity=0.1),
    )  # fmt: skip
    bases = (*pads(bodies)[:2], Bed(4e6, 4e4))
    history = simulate(Scene(bodies, bases), pulse(6.0))
    assert len(history.events) > 20
    assert abs(history.imbalance) < 1e-10


def test_bodies_with_offsets_rest():
    bodies = (block(0.8, 1.5, offset=0.05, eccentricity=0.03), block(1.0, 1.5, offset=-0.1))
    scene = Scene(bodies, pads(bodies), free=0.5)
    history = simulate(scene, Excitation.still())
    assert not history.events
    assert np.max(np.abs(history.rotation)) > 1e-4
    assert np.max(np.abs(history.place - history.place[0])) < 1e-13


@pytest.mark.parametrize("offsets", [False, True])
def test_mirrored_motion(offsets):
    scene = draw(np.random.default_rng(3), offsets=offsets)
    scene = replace(scene, rotation=0.05)
    one, other = simulate(scene, pulse()), simulate(mirrored(scene), pulse(-4.0))
    assert len(one.events) > 5
    assert other.rotation == pytest.approx(-one.rotation, abs=1e-9)
    assert other.place[:, :, 1] == pytest.approx(one.place[:, :, 1], abs=1e-9)


def test_bodies_in_flight_fall():
    numbers = stack_of(stack(3), 1e-13)
    z, standing, room = state_at(numbers, np.zeros(3), 2.0 * numbers.settlement)
    assert not standing.hold.any()
    assert z[1] == pytest.approx(2.0 * numbers.settlement.sum(), rel=1e-12)
    accelerate(z, 0.3, 0.5, numbers, standing, room)
    expected = np.tile([-0.3, -GRAVITY - 0.5, 0.0], 3)
    assert room.out[:9] == pytest.approx(expected, abs=1e-12)


def places(scene: Scene, q: np.ndarray) -> np.ndarray:
    """Return x, y and angle of all bodies, held at the middles of their bases.

    `q` holds rotations and heights of the centres of mass relative to their supports.
    """
    n = len(scene.bodies)
    angle, corner, coordinates = 0.0, np.zeros(2), np.zeros(3 * n, dtype=q.dtype)
    for k in range(n - 1, -1, -1):
        body, turn = scene.bodies[k], q[2 * k]
        across = body.offset + body.height * np.sin(turn) + body.eccentricity * np.cos(turn)
        up = body.height + q[2 * k + 1]
        along, normal = (np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))
        centre = [corner[i] + across * along[i] + up * normal[i] for i in range(2)]
        angle = angle + turn
        coordinates[3 * k : 3 * k + 3] = *centre, angle
        # the middle of the deck, over that of the base
        along, normal = (np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))
        corner = [centre[i] - body.eccentricity * along[i] + body.top * normal[i] for i in range(2)]
    return coordinates


def jacobian(scene: Scene, q: np.ndarray) -> np.ndarray:
    steps = 1e-30j * np.eye(q.size)
    return np.array([places(scene, q + each).imag / 1e-30 for each in steps]).T


@pytest.fixture
def moving():
    """Return three moving eccentric blocks in full contact, and their minimal coordinates."""
    bodies = (
        block(0.8, 1.5, offset=0.05, eccentricity=0.03), block(1.0, 1.5, offset=-0.1),
        block(1.6, 1.0, eccentricity=0.1),
    )  # fmt: skip
    scene = Scene(bodies, pads(bodies, 20.0), rule="centre")
    numbers = stack_of(scene, 1e-13)
    angles = np.array([0.004, -0.006, 0.003])
    z, standing, room = state_at(numbers, angles, np.array([-0.002, 0.001, 0.003]))
    assert standing.hold.all()
    relate(z, numbers, room)
    q, rates = np.zeros(6), np.array([0.3, 0.1, -0.2, -0.15, 0.25, 0.05])
    q[0::2], q[1::2] = angles, room.rel[:, 1]
    z[12:21] = jacobian(scene, q) @ rates
    return scene, numbers, z, standing, room, q, rates


def test_accelerations_follow_from_virtual_work(moving):
    """Virtual work in minimal coordinates: J' (M a - F) = 0 with a = J q'' + J' q', J numerical."""
    scene, numbers, z, standing, room, q, rates = moving
    accelerate(z, 0.7, -0.4, numbers, standing, room)
    jac, mass = jacobian(scene, q), 1.0 / numbers.inverse[:9]
    size = 1e-4
    ahead, back = (jacobian(scene, q + way * size * rates) for way in (1.0, -1.0))
    bends = (ahead - back) @ rates / (2.0 * size)
    loads = mass * np.tile([-0.7, 0.4 - GRAVITY, 0.0], 3)
    pushes = np.zeros(6)
    for k, (body, under) in enumerate(zip(scene.bodies, scene.bases, strict=True)):
        turn, rise = q[2 * k : 2 * k + 2]
        for side in (-1.0, 1.0):
            place = side * body.half_width - body.eccentricity
            lever = body.height * np.sin(turn) - place * np.cos(turn)
            level = rise + body.height * (1.0 - np.cos(turn)) - place * np.sin(turn)
            speed = rates[2 * k + 1] + lever * rates[2 * k]
            push = under.stiffness * (numbers.settlement[k] - level) - under.damping * speed
            pushes[2 * k : 2 * k + 2] += push * lever, push
    right = jac.T @ (loads - mass * bends) + pushes
    wanted = jac @ np.linalg.solve(jac.T @ (mass[:, None] * jac), right) + bends
    assert room.out[:9] == pytest.approx(wanted, rel=1e-7, abs=1e-7)


def test_an_impact_acts_on_all_bodies(moving):
    scene, numbers, z, standing, room, q, rates = moving
    jac, mass = jacobian(scene, q), 1.0 / numbers.inverse[:9]
    body = scene.bodies[1]
    lever = body.height * np.sin(q[2]) + (body.half_width + body.eccentricity) * np.cos(q[2])
    row = np.array([0.0, 0.0, lever, 1.0, 0.0, 0.0])
    answer = np.linalg.solve(jac.T @ (mass[:, None] * jac), row)
    change = (scene.bases[1].restitution - 1.0) * (row @ rates) / (row @ answer)
    jump(z, numbers, standing, room, 1, True, False)
    assert z[12:21] == pytest.approx(jac @ (rates + change * answer), abs=1e-12)


def test_a_corner_that_would_be_held_again_at_once_does_not_leave():
    """Without that rule it would separate and re-engage thousands of times at one instant."""
    samples = 4.0 * 2.3246231155778894 * np.sin(0.314 * np.arange(120))
    known = Known("pads", radius=3.0, slenderness=4.5, beta=12.816816816816818)
    history = simulate(as_stack(known), Excitation.record(0.02, samples))
    assert history.status == COMPLETED
    assert len(history.events) < 30


@pytest.mark.parametrize("firm", [1.0, 2.0])
def test_three_bodies_on_firm_pads_converge_to_one_body(firm):
    """Three blocks on very stiff pads against one block of their total size."""
    third, whole = block(1.0, 1.0), block(1.0, 3.0)
    below = pads([whole], 30.0, eps=1.0)[0]  # an impact would act on the lowest block only
    stiff = Pads(firm * 2e3 * below.stiffness, firm * 2e1 * below.damping, 0.6)
    bodies = (third, third, replace(third, top=0.5))
    three = Scene(bodies, (stiff, stiff, below), rule="centre", free=1.0)
    one = Scene((whole,), (below,), rule="centre", free=1.0)
    apart, together = simulate(three, pulse(2.0, 0.0)), simulate(one, pulse(2.0, 0.0))
    assert together.peaks[0] > 0.02
    off = np.max(np.abs(apart.rotation - together.rotation))
    assert off < 2e-3 * together.peaks[0] / firm


def test_random_scenes_uplift_and_overturn():
    ends = []
    for number in (*range(6), 7, 13):  # some rest, some rock, and the last overturns
        scene = draw(np.random.default_rng([5, number]))
        history = simulate(scene, build_motions(scene.motion)[1], 1e-11)
        assert abs(history.imbalance) < 1e-9
        ends.append((bool(history.events), history.overturned))
    assert 2 <= sum(uplifted for uplifted, _ in ends) <= 7
    assert 1 <= sum(overturned for _, overturned in ends) <= 2


def test_tolerance_does_not_matter():
    one, other = (simulate(stack(3), pulse(), size) for size in (1e-13, 1e-12))
    assert other.rotation == pytest.approx(one.rotation, abs=1e-9)


def test_an_upright_stack_rests_upright():
    angles, middles = rest_of(stack_of(stack(4), 1e-13))
    assert not angles.any()
    assert not middles.any()


def test_twelve_bodies():
    bodies = tuple(block(1.0 + 0.05 * k, 0.5) for k in range(12))
    scene = Scene(bodies, pads(bodies, 100.0, 0.2), free=0.3)
    history = simulate(scene, pulse(5.0), 1e-10)
    assert len(history.events) > 20
    assert abs(history.imbalance) < 1e-8
