"""The reference model of stacks: beside that of one or two bodies, and by itself."""

import math
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("numba")
from reference_models.maximal.drawing import draw as draw_known
from reference_models.maximal.excitation import HARMONIC
from reference_models.maximal.motions import both
from reference_models.maximal.simulate import Excitation
from reference_models.maximal.simulate import simulate as simulate_known
from reference_models.stacks.drawing import draw
from reference_models.stacks.paired import as_stack
from reference_models.stacks.scene import GRAVITY, Bed, Body, Pads, Scene, mirrored, stack_of
from reference_models.stacks.simulate import simulate
from reference_models.stacks.starting import placed, rest_of

pytestmark = pytest.mark.reference_models

SCENES = 24
COLUMNS = {"pads": [3, 4, 5], "bed": [0, 1, 2], "coupled": [3, 4, 5, 0, 1, 2]}


def pulse(peak: float = 4.0, vertical: float = 2.0) -> Excitation:
    return Excitation.pulse(HARMONIC, 1.0 / 64.0, 64, 1.0, 0.0, peak, vertical)


def block(width: float, height: float, **given) -> Body:
    mass = 2000.0 * width * height
    inertia = mass * (width**2 + height**2) / 12.0
    return Body(mass, inertia, 0.5 * width, 0.5 * height, 0.5 * height, **given)


def pads(bodies, frequency: float = 60.0, share: float = 0.1, eps: float = 0.6) -> tuple[Pads, ...]:
    """Give pads of the same frequency and damping ratio under the load of each."""
    loads = np.cumsum([body.mass for body in bodies])
    return tuple(Pads(0.5 * m * frequency**2, share * m * frequency, eps) for m in loads)


def stack(count: int, **given) -> Scene:
    bodies = tuple(block(1.2 + 0.1 * k, 2.0 - 0.1 * k) for k in range(count))
    return Scene(bodies, pads(bodies), rotation=0.1, **given)


@pytest.mark.parametrize("kind", COLUMNS)
@pytest.mark.parametrize("variant", ["plain", "eccentric"])
def test_one_or_two_bodies_as_in_the_other_model(kind, variant):
    for number in range(SCENES):
        known = replace(draw_known(kind, 1, number, variant), separation="displacement")
        if known.small:
            continue
        motion = both(known.motion)[1]
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


def test_flight_is_a_parabola():
    scene = stack(3)
    numbers = stack_of(scene, 1e-13)
    z, standing, _ = placed(numbers, np.zeros(3), 2.0 * numbers.settlement)
    assert not standing.hold.any()
    assert z[1] == pytest.approx(2.0 * numbers.settlement.sum(), rel=1e-12)


@pytest.mark.parametrize("firm", [1.0, 2.0])
def test_firm_pads_make_one_body_of_three(firm):
    """Three blocks on pads so stiff that they stay together, beside one of their size."""
    third, whole = block(1.0, 1.0), block(1.0, 3.0)
    below = pads([whole], 30.0, eps=1.0)[0]  # an impact would act on the lowest block alone
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
    for number in range(12):
        scene = draw(np.random.default_rng([5, number]))
        history = simulate(scene, both(scene.motion)[1], 1e-11)
        assert abs(history.imbalance) < 1e-9
        ends.append((bool(history.events), history.overturned))
    assert 3 <= sum(uplifted for uplifted, _ in ends) <= 10


def test_tolerance_does_not_matter():
    one, other = (simulate(stack(3), pulse(), size) for size in (1e-13, 1e-12))
    assert other.rotation == pytest.approx(one.rotation, abs=1e-9)


def test_rest_of_an_upright_stack_is_upright():
    angles, middles = rest_of(stack_of(stack(4), 1e-13))
    assert not angles.any()
    assert not middles.any()
    assert math.isclose(stack_of(stack(1), 1e-13).gravity, GRAVITY)
