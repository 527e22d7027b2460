"""The reference model in maximal coordinates: own checks, and random scenes against rockframe."""

import math
import os
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("numba")
from reference_models.maximal import layout as at
from reference_models.maximal import runge_kutta
from reference_models.maximal.comparison import compare, run_reference
from reference_models.maximal.excitation import HARMONIC
from reference_models.maximal.forces import accelerate, rooms
from reference_models.maximal.guards import total_rotation
from reference_models.maximal.random_scenes import VARIANTS, draw
from reference_models.maximal.running import kinetic, run, stored
from reference_models.maximal.scene import GRAVITY, KINDS, Scene, mirrored, paces, parameters
from reference_models.maximal.simulate import Excitation, simulate
from reference_models.maximal.starting import start

# its code takes half a minute to compile; quick runs have the other reference models
pytestmark = [pytest.mark.reference_models, pytest.mark.long]

SCENES = 8
SLOW = os.environ.get("ROCKFRAME_COMPILE") == "0"
PULSE = Excitation.pulse(HARMONIC, 1.0 / 128.0, 128, 1.0, 0.0, 4.0, 2.0)
SOIL = {"soil_stiffness": 15e6, "cap_width": 3.0, "cap_height": 0.8, "cap_mass": 2e4}


def test_runge_kutta_formula_has_order_8():
    rows = runge_kutta.MATRIX.sum(axis=1)
    assert np.allclose(rows, runge_kutta.NODES, atol=1e-14)
    for order in range(1, 9):
        moment = runge_kutta.WEIGHTS @ runge_kutta.NODES ** (order - 1)
        assert moment == pytest.approx(1.0 / order, abs=1e-14)


def test_first_impact_of_a_free_block():
    scene = Scene("rigid", small=True, start=0.4, free=2.0)
    history = simulate(scene, Excitation.still())
    # Housner: the quarter period of small rotation
    quarter = math.acosh(1.0 / (1.0 - 0.4)) / scene.frequency
    assert history.events[0, 0] == pytest.approx(quarter, abs=1e-12)
    swing = np.max(np.abs(history.rotation[history.time > quarter])) / scene.theta
    assert 1.0 - (1.0 - swing) ** 2 <= scene.eps**2 * (1.0 - 0.6**2) * (1.0 + 1e-12)


def test_flight_is_a_parabola():
    scene = Scene("pads", free=0.2)
    p = parameters(scene, 1e-13)
    z, contact, held = start(scene, p)
    z[4], z[9:12] = 2.0 * p[at.SETTLEMENT], (0.3, 1.5, 0.02)
    contact[at.HOLD], contact[at.LEFT], contact[at.RIGHT] = at.FREE, at.CLEAR, at.CLEAR
    stops = 0.01 * np.arange(21)
    ground = Excitation.still()
    still = (ground.shape, ground.across, ground.upwards)
    before = z.copy()
    pieces = np.full(20, -1)
    _, _, states, _, events = run(
        stops, pieces, still, z, contact, held, p, paces(scene, p), np.inf
    )
    assert len(events) == 0
    rise = before[4] + 1.5 * stops - 0.5 * GRAVITY * stops**2
    assert states[:, 4] == pytest.approx(rise, abs=1e-13)
    assert states[:, 3] == pytest.approx(0.3 * stops, abs=1e-13)
    assert states[:, 5] == pytest.approx(0.02 * stops, abs=1e-13)


@pytest.mark.parametrize("kind", ["pads", "bed", "coupled"])
@pytest.mark.parametrize("separation", ["displacement", "pressure"])
@pytest.mark.parametrize("eccentricity", [0.0, -0.2])
def test_energies_balance(kind, separation, eccentricity):
    scene = Scene(
        kind, separation=separation, start=0.2, free=2.0, cap=True, eccentricity=eccentricity,
        **SOIL,
    )  # fmt: skip
    p = parameters(scene, 1e-13)
    z, contact, held = start(scene, p)
    room = rooms(p)
    start_energy = kinetic(z, room[2]) + stored(z, contact, p, room)
    history = simulate(scene, PULSE)
    _, _, states, _, events = run(
        history.time,
        np.where(np.arange(history.time.size - 1) < PULSE.intervals, 0, -1),
        (PULSE.shape, PULSE.across, PULSE.upwards),
        z,
        contact,
        held,
        p,
        paces(scene, p),
        PULSE.longest,
    )
    ended = kinetic(z, room[2]) + stored(z, contact, p, room)
    assert len(events) > 3
    assert np.all(events[:, 4] > -1e-9 * start_energy)
    lost = states[-1, 12] + events[:, 4].sum()
    supplied = states[-1, 13]
    assert ended + lost - start_energy == pytest.approx(
        supplied, abs=1e-9 * (abs(lost) + abs(supplied))
    )


def test_mirrored_motion():
    scene = replace(Scene("coupled", start=0.3, xi=0.3, beta=10.0, free=3.0), **SOIL)
    one = simulate(scene, Excitation.still())
    other = simulate(replace(scene, start=-0.3), Excitation.still())
    assert other.rotation == pytest.approx(-one.rotation, abs=1e-9)
    assert other.rise == pytest.approx(one.rise, abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_mirrored_eccentric_block_gives_mirrored_response(kind):
    scene = Scene(
        kind, rule="leading-corner", eccentricity=0.3, xi=0.3, beta=12.0, free=2.0, cap=True, **SOIL
    )
    pulses = (Excitation.pulse(HARMONIC, 1.0 / 64.0, 64, 1.0, 0.0, way * 4.0, 2.0)
              for way in (1.0, -1.0))  # fmt: skip
    one, other = map(simulate, (scene, mirrored(scene)), pulses)
    assert np.max(np.abs(one.rotation)) > 0.02
    assert other.rotation == pytest.approx(-one.rotation, abs=1e-9)
    assert other.rise == pytest.approx(one.rise, abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_eccentric_block_starts_in_equilibrium(kind):
    """Closed-form statics against the accelerations of the equations of motion."""
    leans = []
    for number in range(60):
        scene = replace(draw(kind, 3, number, "eccentric"), start=0.0, start_rate=0.0, told=False)
        p = parameters(scene, 1e-13)
        z, contact, held = start(scene, p)
        out = np.zeros(10)
        accelerate(z, 0.0, 0.0, contact, held, p, rooms(p), out)
        assert np.max(np.abs(out[:6])) < 1e-10 * GRAVITY
        leans.append(total_rotation(z, p) * math.copysign(1.0, scene.eccentricity) / p[at.LIMIT])
    if kind == "rigid":
        assert not any(leans)
    else:
        assert min(leans) > 0.0
        assert max(leans) > 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_tolerance_does_not_matter(kind):
    scene = draw(kind, 1, 1)
    one, other = run_reference(scene), run_reference(scene, tolerance=1e-12)
    assert one.status == other.status
    peak = np.max(np.abs(one.rotation))
    assert other.rotation == pytest.approx(one.rotation, abs=1e-9 * peak)


@pytest.mark.skipif(SLOW, reason="rockframe is not compiled")
@pytest.mark.parametrize("kind", KINDS)
def test_random_scenes(kind):
    for number in range(SCENES):
        for variant in VARIANTS:
            for outcome in compare(kind, 1, number, variant, ("tight", "standard", "fast")):
                assert outcome.label != "disagrees", outcome.plain()
