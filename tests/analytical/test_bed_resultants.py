"""Resultants of the bed against numerical quadrature, at random states of the base."""

import itertools
import math

import numpy as np
import pytest

from rockframe.dynamics.base_numbers import bed_numbers
from rockframe.dynamics.bed import Bed, Ends, both_contacts, contact_of_end
from rockframe.dynamics.body import CENTRE, BaseLine, with_accelerations
from rockframe.dynamics.protocol import Ground, Start
from rockframe.dynamics.single_body import rigid_body, single_body

pytestmark = pytest.mark.analytical

SETTLEMENT, STIFFNESS, WIDTH, HEIGHT = 0.013, 710.0, 2.6, 4.1
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)
DAMPINGS = (0.0, 45.0)
SEPARATIONS = (False, True)  # of `Bed.by_pressure`


def make_bed(damping, by_pressure):
    return Bed(STIFFNESS, damping, SETTLEMENT, WIDTH, by_pressure)


def states(count, seed):
    """Return random heights and speeds of both ends: down, raised, grazing, level."""
    rng = np.random.default_rng(seed)
    special = [0.0, 1e-15, -1e-15, 1e-300, SETTLEMENT, 1e-9 * SETTLEMENT, -1e-9 * SETTLEMENT]
    for i in range(count):
        u = SETTLEMENT * rng.normal(size=2) * 10.0 ** rng.uniform(-3.0, 1.0)
        v = rng.normal(size=2) * 10.0 ** rng.uniform(-4.0, 0.0)
        if i % 5 == 0:
            u[rng.integers(2)] = special[rng.integers(len(special))]
        if i % 7 == 0:
            u[1] = u[0] + special[rng.integers(3)]
        if i % 11 == 0:
            v[1] = v[0]
        if i % 13 == 0:
            v[:] = 0.0
        yield Ends(*map(float, (*u, *v)))


def modes(ends):
    """Return the contact states of the ends for a state of the base."""
    return contact_of_end(ends.u_left), contact_of_end(ends.u_right)


def contact_of(ends):
    left, right = modes(ends)
    return both_contacts(left, right)


def line_of(ends, bed, lever_left=0.0, lever_right=0.0):
    """Return the base line of these heights and speeds."""
    heights = bed.settlement - ends.u_left, bed.settlement - ends.u_right
    return BaseLine(*heights, ends.v_left, ends.v_right, lever_left, lever_right)


def resultants(ends, bed, lever_left, lever_right):
    """Return force, moment and power; heights are relative to the unloaded bed, for precision."""
    bed = bed._replace(settlement=0.0)
    return bed.force(contact_of(ends), line_of(ends, bed, lever_left, lever_right), ())


def by_quadrature(ends, bed, lever_left, lever_right):
    """Integrate piecewise between all points where contact may begin or end."""
    u = np.polynomial.Polynomial([ends.u_left, ends.u_right - ends.u_left])
    v = np.polynomial.Polynomial([ends.v_left, ends.v_right - ends.v_left])
    lever = np.polynomial.Polynomial([lever_left, lever_right - lever_left])
    p = bed.stiffness * u - bed.damping * v
    kinks = {0.0, 1.0}
    for line in (u, p):
        if line(0.0) * line(1.0) < 0.0:
            kinks.add(line(0.0) / (line(0.0) - line(1.0)))
    force = moment = dissipated = stored = length = 0.0
    edges = sorted(kinks)
    for start, end in itertools.pairwise(edges):
        middle = 0.5 * (start + end)
        if u(middle) <= 0.0:
            continue
        s = middle + 0.5 * (end - start) * POINTS
        ds = 0.5 * (end - start) * WIDTH * WEIGHTS
        stored += np.sum(0.5 * bed.stiffness * u(s) ** 2 * ds)
        if bed.by_pressure and p(middle) <= 0.0:
            # the spring relaxes against its dashpot: all its power is dissipated
            dissipated += np.sum(bed.stiffness * u(s) * v(s) * ds)
            continue
        length += WIDTH * (end - start)
        force += np.sum(p(s) * ds)
        moment += np.sum(p(s) * lever(s) * ds)
        dissipated += np.sum(bed.damping * v(s) ** 2 * ds)
    return force, moment, dissipated, stored, length


def scales(ends, bed):
    pressed = bed.stiffness * max(abs(ends.u_left), abs(ends.u_right))
    pressed += bed.damping * max(abs(ends.v_left), abs(ends.v_right))
    return WIDTH * pressed, WIDTH * pressed * max(abs(ends.v_left), abs(ends.v_right))


@pytest.mark.parametrize("by_pressure", SEPARATIONS)
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("count", [1000, pytest.param(3000, marks=pytest.mark.long)])
def test_resultants_are_exact(count, damping, by_pressure):
    bed = make_bed(damping, by_pressure)
    rng = np.random.default_rng(7)
    seen = set()
    for ends in states(count, seed=1):
        levers = rng.normal(size=2)
        force, moment, dissipated = resultants(ends, bed, *levers)
        exact = by_quadrature(ends, bed, *levers)
        size, power = scales(ends, bed)
        assert abs(force - exact[0]) <= 1e-12 * size
        assert abs(moment - exact[1]) <= 1e-12 * size * np.abs(levers).max()
        assert abs(dissipated - exact[2]) <= 1e-12 * power
        start, end = bed.bearing_part(contact_of(ends), ends)
        assert 0.0 <= start <= end <= 1.0
        assert abs(WIDTH * (end - start) - exact[4]) <= 1e-12 * WIDTH
        line = line_of(ends, bed)
        stored, change = bed.energy(line, ())
        pressed = bed.ends(line)  # by the heights alone
        exact_energy = by_quadrature(pressed, bed, *levers)[3]
        energy = WIDTH * STIFFNESS * max(pressed.u_left**2, pressed.u_right**2)
        assert abs(stored - exact_energy) <= 1e-12 * energy
        at_rest = 0.5 * WIDTH * STIFFNESS * SETTLEMENT**2
        assert abs(change - (exact_energy - at_rest)) <= 1e-12 * (energy + at_rest)
        if by_pressure:
            assert force >= -1e-15 * size
            assert dissipated >= -1e-15 * power
        deep = max(ends.u_left, ends.u_right) > 1e-6 * SETTLEMENT
        seen.add((*modes(ends), start == end and deep))
    assert {mode[:2] for mode in seen} == {(0, 0), (0, 1), (1, 0), (1, 1)}
    # down without bearing: the end rises faster than the bed can follow
    tears = any(nothing for left, right, nothing in seen if not left or not right)
    assert tears == (by_pressure and damping > 0.0)


@pytest.mark.parametrize("by_pressure", SEPARATIONS)
@pytest.mark.parametrize("damping", DAMPINGS)
def test_bed_power_equals_stored_and_dissipated_power(damping, by_pressure):
    """dE/dt + dissipated + power on the base = 0; the springs' power by finite differences."""
    bed = make_bed(damping, by_pressure)
    for ends in states(1500, seed=2):
        # the motion of the left and right end, from middle and rotation
        force, moment, dissipated = resultants(ends, bed, 0.5 * WIDTH, -0.5 * WIDTH)
        rise = 0.5 * (ends.v_left + ends.v_right)
        spin = (ends.v_left - ends.v_right) / WIDTH
        speed = max(abs(ends.v_left), abs(ends.v_right))
        if speed == 0.0:
            continue
        step = 1e-6 * max(abs(ends.u_left), abs(ends.u_right)) / speed

        def stored(t, ends=ends):
            u_left, u_right = ends.u_left - t * ends.v_left, ends.u_right - t * ends.v_right
            moved = Ends(u_left, u_right, ends.v_left, ends.v_right)
            return bed.energy(line_of(moved, bed), ())[1]

        rate = (stored(step) - stored(-step)) / (2.0 * step)
        _, power = scales(ends, bed)
        noise = 1e-14 * WIDTH * STIFFNESS * SETTLEMENT**2 / step
        assert abs(rate + dissipated + force * rise + moment * spin) <= 1e-8 * power + noise


# special states of a body ---------------------------------------------------------------------


def shape(*, small):
    return rigid_body(
        left=0.5 * WIDTH,
        right=0.5 * WIDTH,
        height=HEIGHT,
        inertia=7.0,
        restraint=CENTRE,
        small_rotation=small,
        gravity=9.81,
    )


def body(alpha, y, spin, speed, *, small, damping=45.0, by_pressure=False):
    """Return a model, its state and the mode of the state."""
    block = shape(small=small)
    bed = bed_numbers(block, stiffness=STIFFNESS, damping=damping, by_pressure=by_pressure)
    model = single_body("Winkler", block, bed, mass=1.0)
    mode, state, _ = model.initial(Start(alpha, spin, y, speed))
    return model, mode, state


def by_strips(model, state, alpha, small, *, by_pressure, damping):
    """Return the accelerations of a body from pressures along its base, by definition."""
    settlement = model.system.part.base.settlement
    sine, cosine = (alpha, 1.0) if small else (math.sin(alpha), math.cos(alpha))
    rise = HEIGHT * (0.5 * alpha**2 if small else 2.0 * math.sin(0.5 * alpha) ** 2)
    spin, speed = state[3], state[4]
    half = 0.5 * WIDTH

    def w_of(s):
        return state[1] + rise - s * sine

    def rate_of(s):
        return speed + HEIGHT * sine * spin - s * cosine * spin

    def p_of(s):
        return STIFFNESS * (settlement - w_of(s)) - damping * rate_of(s)

    edges = {-half, half}
    for line in (lambda s: settlement - w_of(s), p_of):
        if line(-half) * line(half) < 0.0:
            edges.add(half * (line(-half) + line(half)) / (line(-half) - line(half)))
    edges = sorted(edges)
    force = moment = 0.0
    for start, end in itertools.pairwise(edges):
        s = 0.5 * (start + end) + 0.5 * (end - start) * POINTS
        ds = 0.5 * (end - start) * WEIGHTS
        middle = 0.5 * (start + end)
        if w_of(middle) >= settlement or (by_pressure and p_of(middle) <= 0.0):
            continue
        force += np.sum(p_of(s) * ds)
        moment += np.sum(p_of(s) * (HEIGHT * sine - s * cosine) * ds)
    return force, moment


ALPHAS = (0.0, 1e-15, -1e-15, 1e-9, 3e-3, -0.011, 0.05, -0.3)


@pytest.mark.parametrize("small", [False, True])
@pytest.mark.parametrize("by_pressure", SEPARATIONS)
@pytest.mark.parametrize("alpha", ALPHAS)
def test_body_accelerations_follow_from_bed_pressure(alpha, by_pressure, small):
    rng = np.random.default_rng(5)
    for _ in range(60):
        y = SETTLEMENT * rng.normal() * 2.0 - 0.5 * HEIGHT * alpha**2
        spin, speed = 0.3 * rng.normal(), 0.3 * rng.normal()
        model, mode, state = body(alpha, y, spin, speed, small=small, by_pressure=by_pressure)
        out = model.system.accelerate(mode, state, Ground(0.4, -0.2))
        force, moment = by_strips(model, state, alpha, small, by_pressure=by_pressure, damping=45.0)
        gravity = 9.81
        size = 1e-12 * (abs(force) + gravity + STIFFNESS * WIDTH * (abs(y) + abs(alpha)))
        assert abs(out[1] - (force - gravity + 0.2)) <= size
        if model.system.contact_state_of(mode, 0) == 3:
            assert out[0] == 0.0
            assert out[2] == -0.4
            continue
        reach = HEIGHT if small else HEIGHT * math.cos(alpha)
        bend = 0.0 if small else -HEIGHT * math.sin(alpha)
        expected = (moment - reach * (0.4 + bend * spin**2)) / (7.0 + reach**2)
        assert abs(out[0] - expected) <= size


def test_resultants_are_continuous_at_zero_rotation():
    """No division by the rotation: resultants are finite and continuous from either side."""
    bed = make_bed(45.0, by_pressure=False)
    for level in (SETTLEMENT, 0.1 * SETTLEMENT, 1e-12):
        base = resultants(Ends(level, level, 0.1, 0.1), bed, 1.3, -1.3)
        for tilt in (1e-18, -1e-18, 1e-15, -1e-15, 5e-324):
            near = resultants(Ends(level + tilt, level - tilt, 0.1, 0.1), bed, 1.3, -1.3)
            # k b^2 (2/3) tilt and rounding
            room = 1e-14 * WIDTH * (STIFFNESS * level + 4.5) + 2.0 * STIFFNESS * WIDTH * abs(tilt)
            np.testing.assert_allclose(near, base, atol=room)


@pytest.mark.parametrize("tilt", [0.0, 1e-15, -1e-15])
@pytest.mark.parametrize("by_pressure", SEPARATIONS)
def test_base_that_just_touches_bed_carries_no_force(by_pressure, tilt):
    bed = make_bed(0.0, by_pressure)
    for level in (0.0, -1e-15, -1e-300):
        ends = Ends(level + tilt, level - tilt, 0.2, -0.1)
        force, moment, dissipated = resultants(ends, bed, 1.0, -1.0)
        assert abs(force) <= 1e-14 * STIFFNESS * WIDTH
        assert abs(moment) <= 1e-14 * STIFFNESS * WIDTH
        assert abs(dissipated) <= 1e-14 * STIFFNESS * WIDTH
        assert bed.energy(line_of(ends, bed), ())[0] <= 1e-25


@pytest.mark.parametrize("by_pressure", SEPARATIONS)
@pytest.mark.parametrize("damping", DAMPINGS)
def test_bed_has_no_force_or_energy_in_flight(damping, by_pressure):
    bed = make_bed(damping, by_pressure)
    for ends in (Ends(-1e-300, -0.1, -3.0, -4.0), Ends(-0.2, -0.2, 1.0, 1.0)):
        assert resultants(ends, bed, 1.0, -1.0) == (0.0, 0.0, 0.0)
        stored, change = bed.energy(line_of(ends, bed), ())
        assert stored == 0.0
        assert change == pytest.approx(-0.5 * STIFFNESS * WIDTH * SETTLEMENT**2, rel=1e-14)
        assert not any(bed.is_held(contact_of(ends), left) for left in (True, False))


def test_separation_rules_agree_without_damping():
    for ends in states(500, seed=4):
        one, other = (resultants(ends, make_bed(0.0, rule), 1.1, -1.2) for rule in SEPARATIONS)
        size, power = scales(ends, make_bed(0.0, by_pressure=False))
        np.testing.assert_allclose(one[:2], other[:2], atol=1e-14 * size)
        assert abs(one[2] - other[2]) <= 1e-14 * power


@pytest.mark.parametrize("by_pressure", SEPARATIONS)
def test_mirrored_state_has_mirrored_resultants(by_pressure):
    bed = make_bed(45.0, by_pressure)
    for ends in states(500, seed=6):
        turned = Ends(ends.u_right, ends.u_left, ends.v_right, ends.v_left)
        one = resultants(ends, bed, 1.1, -1.1)
        other = resultants(turned, bed, 1.1, -1.1)
        size, power = scales(ends, bed)
        assert abs(one[0] - other[0]) <= 1e-14 * size
        assert abs(one[1] + other[1]) <= 2e-14 * size
        assert abs(one[2] - other[2]) <= 1e-14 * power


# guards -------------------------------------------------------------------------------------------


def test_guard_rates_match_finite_differences():
    rng = np.random.default_rng(8)
    bed = make_bed(45.0, by_pressure=False)
    checked = 0
    for ends in states(1500, seed=9):
        accelerations = rng.normal(size=2)
        contact = contact_of(ends)
        speed = max(abs(ends.v_left), abs(ends.v_right), 1e-3)
        step = 1e-5 * SETTLEMENT / speed

        def moved(t, ends=ends, accelerations=accelerations):
            a_left, a_right = accelerations
            return Ends(
                ends.u_left - ends.v_left * t - 0.5 * a_left * t * t,
                ends.u_right - ends.v_right * t - 0.5 * a_right * t * t,
                ends.v_left + a_left * t,
                ends.v_right + a_right * t,
            )

        size = (speed + 1.0) / SETTLEMENT
        for left in (True, False):
            now, ahead, behind = (
                bed.guards_of(
                    contact, left, with_accelerations(line_of(moved(t), bed), *accelerations), ()
                )
                for t in (0.0, step, -step)
            )
            slope = (ahead.values[0] - behind.values[0]) / (2.0 * step)
            np.testing.assert_allclose(slope, now.changes[0], atol=1e-5 * size)
            assert now.values[0] >= 0.0
        checked += 1
    assert checked > 300


def test_kinematics_at_small_and_finite_rotation_agree_to_second_order():
    for alpha in (1e-3, 1e-4):
        finite = shape(small=False).attitude(alpha)
        small = shape(small=True).attitude(alpha)
        np.testing.assert_allclose(finite, small, atol=5.0 * alpha**2 * (alpha + 0.2))


# many springs -----------------------------------------------------------------------------------


def springs(ends, bed, levers, count):
    """Sum over equal springs and dashpots in the middle of equal strips of the base."""
    s = (np.arange(count) + 0.5) / count
    u = ends.u_left + s * (ends.u_right - ends.u_left)
    v = ends.v_left + s * (ends.v_right - ends.v_left)
    p = bed.stiffness * u - bed.damping * v
    p = np.where((u > 0.0) & ((p > 0.0) | (not bed.by_pressure)), p, 0.0) * WIDTH / count
    return p.sum(), (p * (levers[0] + s * (levers[1] - levers[0]))).sum()


COUNTS = np.array([10, 32, 100, 316, 1000, 3162])


@pytest.mark.parametrize("by_pressure", SEPARATIONS)
@pytest.mark.parametrize(("damping", "order"), [(0.0, 2), (45.0, 1)])
def test_discrete_springs_converge_to_bed(damping, order, by_pressure):
    """As 1/N^2 where the pressure ends at zero, as 1/N where dashpots make it end in a step."""
    bed = make_bed(damping, by_pressure)
    levers = (1.3, -1.3)
    errors = np.zeros((len(COUNTS), 2))
    cases = [ends for ends in states(600, seed=10) if modes(ends) in ((0, 1), (1, 0))]
    for ends in cases:
        exact = resultants(ends, bed, *levers)[:2]
        size, _ = scales(ends, bed)
        for row, count in enumerate(COUNTS):
            errors[row] += np.abs(np.subtract(springs(ends, bed, levers, count), exact)) / size
    errors /= len(cases)
    assert len(cases) > 150
    slopes = np.polyfit(np.log(COUNTS), np.log(errors), 1)[0]
    assert slopes == pytest.approx([-order, -order], abs=0.1)
    assert (errors[COUNTS == 1000] < {1: 1e-3, 2: 1e-6}[order]).all()


def test_discrete_springs_in_full_contact_differ_only_in_moment():
    """The midpoint rule is exact for the force; it misses the share 1/N^2 of b^3/3."""
    bed = make_bed(45.0, by_pressure=False)
    ends = Ends(1.4 * SETTLEMENT, 0.6 * SETTLEMENT, 0.01, -0.02)
    force, moment, _ = resultants(ends, bed, 1.3, -1.3)
    for count in COUNTS:
        summed, turning = springs(ends, bed, (1.3, -1.3), count)
        assert summed == pytest.approx(force, rel=1e-13)
        assert turning == pytest.approx(moment * (1.0 - 1.0 / count**2), rel=1e-12)
