"""Statics from the forces of the equations: closed forms, energy, and chains of bodies."""

import math
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import minimize

import rockframe as rf
from rockframe import extension as ext
from rockframe.dynamics.base_numbers import bed_numbers, pads_numbers
from rockframe.dynamics.body import CENTRE, BodyState
from rockframe.dynamics.body_statics import (
    DISPLACEMENTS,
    RATES,
    base_derivatives,
    standing_body,
)
from rockframe.dynamics.linearization import linearized_chain
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.pads import ElasticPads
from rockframe.dynamics.protocol import Ground, Start
from rockframe.dynamics.single_body import eccentricity_of, rigid_body, starting_state
from rockframe.dynamics.statics import StandingChain

pytestmark = pytest.mark.analytical

EXACT = 1e-11
BLOCKS = {
    "slender": rf.Block(width="2.4 m", height="9.6 m", mass="50 t"),
    "squat": rf.Block(width="4 m", height="3 m", mass="20 t"),
    "eccentric": rf.Block(
        width="2.4 m", height="9.6 m", mass="50 t", centre_of_mass=("4 m", "0.3 m")
    ),
}
BASES = {
    "pads": rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
    "soft pads": rf.TwoSpringSupport(frequency_ratio=9, damping_ratio=0.3),
    "bed": rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1),
    "bed by pressure": rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1, separation="pressure"),
    "soft bed": rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2),
}
CAP = rf.CushionCap(width="3.2 m", height="0.8 m", mass="15 t")
ALONE = list(product(BLOCKS, BASES, ("finite", "small")))


class Form(NamedTuple):
    """Results of a closed form: rise and moment at the middle, bearing ends, outputs."""

    rise: float
    moment: float
    contact: str
    reactions: dict


def closed(setting, rotation):
    """Equations eq-static-pads and eq-static-bed."""
    support, body, weight = setting.support, setting.body, setting.load.weight
    b, delta = body.half_width, support.settlement
    sine, cosine = math.sin(rotation), math.cos(rotation)
    if setting.options.small:
        sine, cosine = rotation, 1.0
    lift = b * abs(sine)
    side = "right" if rotation > 0.0 else "left"
    contact = side if lift > delta else "full"
    if isinstance(support, ext.PadSupport):
        left, right = (0.5 * weight - sign * support.stiffness * b * sine for sign in (1.0, -1.0))
        if contact != "full":
            left, right = (0.0, weight) if rotation > 0.0 else (weight, 0.0)
        rise = max(0.0, lift - delta)
        shown = {"left_reaction": left, "right_reaction": right}
        return Form(rise, (right - left) * b * cosine, contact, shown)
    length, rise = 2.0 * b, 0.0
    moment, sunk = support.stiffness * b**3 / 1.5 * sine * cosine, delta + lift
    if contact != "full":
        length = 2.0 * math.sqrt(b * delta / abs(sine))
        rise, sunk = delta + lift - 2.0 * math.sqrt(lift * delta), length * abs(sine)
        moment = math.copysign(weight * (b - length / 3.0), sine) * cosine
    toe = support.stiffness * sunk
    shown = {"soil_reaction": weight, "contact_length": length, "toe_pressure": toe}
    return Form(rise, moment, contact, shown)


@pytest.mark.parametrize(("block", "base", "rotation"), ALONE)
def test_held_body_matches_closed_forms(block, base, rotation):
    setting = rf.System(BLOCKS[block], BASES[base], rotation=rotation).setting
    body, weight, uplift = setting.body, setting.load.weight, setting.uplift_angle
    ratio = setting.settlement / body.half_width
    assert uplift == pytest.approx(ratio if rotation == "small" else math.asin(ratio), rel=1e-13)
    for share in (0.0, 1e-9, 0.2, -0.7, 0.999, 1.001, -1.5, 3.0, -6.0):
        angle = share * uplift
        form, found = closed(setting, angle), setting.statics(angle)
        small = rotation == "small"
        sine, cosine = (angle, 1.0) if small else (math.sin(angle), math.cos(angle))
        h, eccentricity = body.centre_height, body.eccentricity
        assert found.contact_state == form.contact
        rounding = EXACT * weight * body.half_width
        assert found.base_moment == pytest.approx(form.moment, rel=EXACT, abs=rounding)
        back = form.moment - weight * (h * sine + eccentricity * cosine)
        assert found.restoring_moment == pytest.approx(back, rel=EXACT, abs=rounding)
        rise = 0.5 * h * angle**2 if small else h * (1.0 - math.cos(angle))
        height = form.rise - rise - eccentricity * sine
        assert found.vertical_displacement == pytest.approx(height, rel=EXACT, abs=1e-14)
        assert found.reactions == pytest.approx(form.reactions, rel=EXACT, abs=1e-8)


@pytest.mark.parametrize(("block", "base", "rotation"), ALONE)
def test_force_slopes_match_declared_stiffnesses(block, base, rotation):
    """Sizes and steps of runs are scaled by these."""
    support = rf.System(BLOCKS[block], BASES[base], rotation=rotation).setting.support
    numbers, link, pose = support.base_numbers, support.carried, support.upright
    slopes = np.array([base_derivatives(link, pose, name) for name in (*DISPLACEMENTS, *RATES)])
    h, g = support.load.body.centre_height, support.load.options.slope.normal_gravity
    vertical, turning = numbers.vertical_stiffness, numbers.rotational_stiffness
    damping = numbers.damping_time
    assert link.settlement == pytest.approx(numbers.settlement, rel=1e-14)
    assert slopes[1, 1] == pytest.approx(vertical, rel=EXACT)
    assert slopes[0, 0] == pytest.approx(turning - g * h, rel=EXACT)
    assert slopes[3, 1] == pytest.approx(damping * vertical, rel=EXACT)
    assert slopes[2, 0] == pytest.approx(damping * turning, rel=EXACT)
    assert slopes[:2, ::-1].diagonal() == pytest.approx(slopes[0, 1], abs=EXACT * vertical)


def printed_matrices(block, cap):
    """Return the matrices of eq-coupled-small, per unit mass of the block."""
    h, h_c, g, inertia = block.body.height, cap.body.height, block.body.gravity, block.body.inertia
    high = h + 2.0 * h_c
    turning = cap.body.inertia + cap.mass * h_c**2 + inertia + high**2
    mass = np.array([
        [1.0 + cap.mass, 0.0, 1.0, 0.0],
        [0.0, turning, 0.0, inertia + h * high],
        [1.0, 0.0, 1.0, 0.0],
        [0.0, inertia + h * high, 0.0, inertia + h**2],
    ])  # fmt: skip
    bases = [cap.base, cap.base, block.base, block.base]
    springs = np.array([
        one.rotational_stiffness if i % 2 else one.vertical_stiffness
        for i, one in enumerate(bases)
    ])  # fmt: skip
    stiffness = np.diag(springs)
    stiffness[1, 1] -= g * (cap.mass * h_c + high)
    stiffness[3, 3] -= g * h
    stiffness[1, 3] = stiffness[3, 1] = -g * h
    return mass, np.diag(springs * [one.damping_time for one in bases]), stiffness


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_linearized_stack_has_printed_matrices(rotation):
    """Equation eq-coupled-small, in the order Y, phi, r, psi."""
    setting = rf.System(BLOCKS["slender"], BASES["pads"], CAP, BASES["bed"], rotation=rotation)
    setting = setting.setting
    order = [3, 2, 1, 0]
    found = linearized_chain(setting._effective_statics.chain, setting._rest)
    mass, damping, stiffness = printed_matrices(*setting.bodies())
    for matrix, printed in zip(found, (mass, damping, stiffness), strict=True):
        size = np.abs(printed).max()
        assert matrix[np.ix_(order, order)] == pytest.approx(printed, rel=1e-10, abs=1e-11 * size)


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("restraint", ["contact-state", "leading-corner", "centre"])
@pytest.mark.parametrize("inclination", ["0 deg", "0.8 deg", "-0.5 deg"])
@pytest.mark.parametrize("block", ["slender", "eccentric"])
def test_stack_at_rest_has_zero_acceleration(block, inclination, restraint, rotation):
    setting = rf.System(
        BLOCKS[block], BASES["pads"], CAP, BASES["bed"], inclination=inclination,
        restraint=restraint, rotation=rotation,
    ).setting  # fmt: skip
    system = setting.contact_model().system
    mode, state, _ = setting.contact_model().initial(Start())
    slope = system.accelerate(mode, state, Ground(setting.slope.along_gravity, 0.0))
    assert np.abs(slope[:4]).max() < 1e-11 * setting.gravity
    held = setting.statics(setting.rest_rotation)
    size = setting.load.weight * setting.body.half_width
    assert held.restoring_moment == pytest.approx(0.0, abs=1e-11 * size)
    assert held.reactions["cap_rotation"] == pytest.approx(setting.rest[1].rotation, abs=1e-14)


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("block", BLOCKS)
def test_stored_energy_of_held_body_equals_work(block, base):
    setting = rf.System(BLOCKS[block], BASES[base]).setting
    link = setting.support.carried
    body, law = link.part
    for share in (0.1, 0.3):
        angle = share * setting.overturning_angle
        ends = (setting.support.standing.chain.poses_at([each])[0] for each in (0.0, angle))
        low, high = (law.energy(e.line, ())[0] + body.gravity * e.state.vertical for e in ends)
        work = setting.body.mass * (high - low)
        assert setting.stored_energy(angle) == pytest.approx(work, rel=5e-3)


# three bodies -----------------------------------------------------------------------------------

G = 9.8
MASSES = (1.0, 0.7, 1.6)
TOPS = (0.0, 0.9, 0.4)


def bodies(eccentricity=0.0, along=0.0):
    """Return a block on pads on a block on pads on a plate on a bed; eccentric by a share."""
    shapes = ((2.2, 0.55, 0.12), (0.9, 0.7, 0.05), (0.4, 1.1, 0.0))
    links = []
    for k, (height, half, off) in enumerate(shapes):
        off *= eccentricity
        body = rigid_body(
            left=half + off, right=half - off, height=height, inertia=MASSES[k] * 0.5,
            restraint=CENTRE, small_rotation=False, gravity=G,
        )  # fmt: skip
        above = sum(MASSES[: k + 1])
        if k == 2:
            base = bed_numbers(body, stiffness=4500.0, damping=5.0, by_pressure=False, load=above)
        else:
            base = pads_numbers(
                body, stiffness=(900.0, 1500.0)[k], damping=1.0, restitution=(1, 1), load=above
            )
        links.append(
            standing_body(BodyOnBase(body, base.law), MASSES[k], TOPS[k], eccentricity_of(body))
        )
    return StandingChain(tuple(links), along)


def potential(chain, places):
    """Return the energy of all weights and bases for rotations and heights of bodies."""
    point, turned, energy = np.zeros(2), 0.0, 0.0
    top = 0.0
    for link, (rotation, rise), mass, above in reversed(
        list(zip(chain.bodies, places, MASSES, TOPS, strict=True))
    ):
        body, law = link.part
        state = BodyState(rotation, rise, 0.0, 0.0, 0.0, 0.0)
        energy += law.energy(body.base_line_at(state), ())[0]
        middle = eccentricity_of(body)
        along = body.height * math.sin(rotation) + middle * math.cos(rotation)
        normal = top + body.height + rise
        axes = np.array(
            [[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]]
        )
        point = point + np.array([along, normal]) @ axes
        energy += mass * (G * point[1] + chain.along_gravity * point[0])
        turned, top = turned + rotation, above
    return energy


def minimum_energy(chain, rotation=None):
    """Return rotations and heights of least energy, with the highest body held or free."""
    sizes = np.array([1e-3, 1e-3] * 3)

    def places(scaled):
        found = (scaled * sizes).reshape(3, 2)
        if rotation is not None:
            found[0, 0] = rotation - found[1:, 0].sum()
        return found

    start = np.zeros(6)
    for method in ("BFGS", "Nelder-Mead", "BFGS"):
        options = {"gtol": 1e-9} if method == "BFGS" else {"xatol": 1e-9, "fatol": 1e-15}
        start = minimize(lambda x: potential(chain, places(x)), start, method=method,
                         options=options | {"maxiter": 20000}).x  # fmt: skip
    return places(start), potential(chain, places(start))


def placed(poses):
    return np.array([[pose.state.rotation, pose.state.vertical] for pose in poses])


@pytest.mark.parametrize(
    ("eccentricity", "along"), [(0.0, 0.0), (1.0, 0.0), (0.0, 0.15), (1.0, -0.1)]
)
def test_three_bodies_rest_where_their_energy_is_least(eccentricity, along):
    chain = bodies(eccentricity, along)
    poses = chain.rest()
    found, energy = minimum_energy(chain)
    assert placed(poses) == pytest.approx(found, rel=1e-4, abs=1e-6)
    assert potential(chain, placed(poses)) <= energy + 1e-12
    assert chain.moments(poses) == pytest.approx([0.0] * 3, abs=1e-11)
    stiffness = linearized_chain(chain, poses).stiffness
    assert stiffness == pytest.approx(stiffness.T, abs=1e-6 * np.abs(stiffness).max())
    assert np.linalg.eigvalsh(stiffness).min() > 0.0


@pytest.mark.parametrize(("eccentricity", "along"), [(0.0, 0.0), (1.0, -0.1)])
def test_three_bodies_are_held_where_their_energy_is_least(eccentricity, along):
    chain = bodies(eccentricity, along)
    rotations = (0.004, 0.03, 0.08, -0.02, -0.1)
    contacts = set()
    for rotation, poses in zip(rotations, chain.curve(rotations), strict=True):
        found, energy = minimum_energy(chain, rotation)
        assert placed(poses)[:, 0].sum() == pytest.approx(rotation, rel=1e-13)
        assert placed(poses) == pytest.approx(found, rel=1e-4, abs=1e-6)
        assert potential(chain, placed(poses)) <= energy + 1e-12
        moments = chain.moments(poses)
        assert moments == pytest.approx([moments[0]] * 3, abs=1e-11)
        contacts.add(tuple(pose.mode.contact for pose in poses))
    assert len(contacts) > 2


def test_the_couple_on_three_bodies_is_the_slope_of_their_energy():
    chain = bodies(1.0, -0.1)
    rotations = np.linspace(0.0, 0.05, 401)
    poses = chain.curve(rotations)
    energies = [potential(chain, placed(each)) for each in poses]
    couples = [-chain.moments(each)[0] for each in poses]
    for (low, high), (before, behind) in zip(pairwise(energies), pairwise(couples), strict=True):
        work = 0.5 * (before + behind) * (rotations[1] - rotations[0])
        assert high - low == pytest.approx(work, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("stiffness", ["1e10 N/m", "2e11 N/m", "1e13 N/m", "1e15 N/m"])
def test_body_on_nearly_rigid_pads_moves_with_body_below(stiffness):
    """Pads of very different stiffness: the eccentric lower body leans on soft ones."""
    soft = rf.TwoSpringSupport(stiffness="1 MN/m", damping_ratio=0.1)
    stiff = rf.TwoSpringSupport(stiffness=stiffness, damping_ratio=0.1)
    above = rf.Block(width="0.7 m", height="0.7 m", mass="400 kg")
    below = rf.Block(
        width="1 m", height="0.8 m", mass="1200 kg", centre_of_mass=("0.4 m", "-0.04 m")
    )
    both = rf.Block(
        width="1 m", height="1.5 m", mass="1600 kg", centre_of_mass=("0.5875 m", "-0.03 m")
    )
    angles = ([0.0, 1e-6, -1e-6, 1e-3, -9e-4], "rad")
    found = rf.System(rf.Stack(above, below, interfaces=[stiff]), soft).moment_rotation(angles)
    of_one = rf.System(both, soft).moment_rotation(angles)
    compliance = 1e6 / float(stiffness.split()[0])
    np.testing.assert_allclose(
        found.restoring_moment, of_one.restoring_moment, rtol=10.0 * compliance + EXACT
    )


# user-defined laws --------------------------------------------------------------------------------


PROP = 500.0


class ProppedPads(ElasticPads):
    """Pads and a spring under the middle, which carries part of the weight."""

    __slots__ = ()

    def force(self, contact, line, own):
        found = super().force(contact, line, own)
        middle = 0.5 * (line.left + line.right)
        moment = found.moment - PROP * middle * 0.5 * (line.left_lever + line.right_lever)
        return ext.BaseForce(found.upward - PROP * (middle - 0.01), moment, found.dissipated)


def test_base_with_vertical_thrust_starts_in_equilibrium():
    body = rigid_body(left=0.5, right=0.5, height=2.0, inertia=1.5, restraint=CENTRE,
                   small_rotation=False, gravity=G)  # fmt: skip
    pads = pads_numbers(body, stiffness=2000.0, damping=3.0, restitution=(0.9, 0.9)).law
    part = BodyOnBase(body, ProppedPads(*pads))
    for rotation in (0.0, 0.001, -0.02):
        state, mode = starting_state(part, Start(rotation), ())
        force = part.base.force(mode.contact, body.base_line_at(state), ())
        assert force.upward == pytest.approx(G, rel=1e-12)
    (pose,) = StandingChain((standing_body(part),)).rest()
    assert pose.state.vertical == pytest.approx(PROP * 0.01 / 4500.0, rel=1e-12)


def test_dashpots_of_ties_damp_small_motion():
    """A post under the middle of a block acts in parallel to both pads in vertical motion."""
    mass, stiffness, damping = 5e3, 4e6, 2e4
    block = rf.Block(width="1 m", height="3 m", mass=f"{mass} kg")
    pads = rf.TwoSpringSupport(stiffness=f"{stiffness} N/m", damping=f"{damping} N s/m")
    post = rf.Restrainer(
        on=("0 m", "1 m"), to=("0 m", "0 m"), stiffness="1e6 N/m", damping="6e4 N s/m",
        compression=True,
    )  # fmt: skip
    modes = rf.System(block, pads, post).frequencies()
    upright = int(np.argmax(np.abs(modes.vertical_displacement_shape.values)))
    frequency = math.sqrt((2.0 * stiffness + 1e6) / mass)
    assert float(modes.angular_frequency[upright]) == pytest.approx(frequency, rel=1e-9)
    ratio = (2.0 * damping + 6e4) / (2.0 * mass * frequency)
    assert float(modes.damping_ratio[upright]) == pytest.approx(ratio, rel=1e-9)
