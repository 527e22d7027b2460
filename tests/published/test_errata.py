"""The paper's Eqs. (2), (3), (12), (13c) and (15), printed and corrected.

They are tested against Newton's and Euler's equations, written here with vectors and a rotation
matrix: no Lagrangian, no levers, and nothing from rockframe. Every equation is a sum of terms that
must vanish. Its *imbalance* is that sum over the largest term, at the accelerations and the
reactions that Newton and Euler give for a random state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import rockframe as rf
from rockframe.dynamics.bodies import ROTATION, VERTICAL
from rockframe.dynamics.body import PIVOT_CENTRE, PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CLEAR, CORNER, TOUCHING
from rockframe.dynamics.protocol import Ground

G = 9.80665
STATES = 200
EXACT = 1e-12
LEFT, RIGHT, FULL = -1, 1, 0


@dataclass(frozen=True)
class Case:
    """A block on two pads in a state of motion; its mass is one."""

    theta: float
    radius: float
    mu: float
    beta: float
    xi: float
    alpha: float
    spin: float
    y: float
    speed: float
    ground_x: float
    ground_y: float

    @property
    def b(self):
        return self.radius * math.sin(self.theta)

    @property
    def h(self):
        return self.radius * math.cos(self.theta)

    @property
    def inertia(self):
        return self.radius**2 / self.mu

    @property
    def omega(self):
        return math.sqrt(self.mu / (1.0 + self.mu) * G / self.radius)

    @property
    def stiffness(self):
        return (self.beta * self.omega) ** 2 / 2.0

    @property
    def damping(self):
        return self.xi * self.beta * self.omega

    @property
    def delta(self):
        return G / (2.0 * self.stiffness)


def random_case(rng, contact):
    """Draw a state as large as those that the paper's figures show."""
    theta = rng.uniform(0.15, 0.46)
    radius = rng.uniform(2.0, 12.0)
    mu = rng.uniform(1.5, 3.5)
    beta = rng.uniform(10.0, 40.0)
    omega = math.sqrt(mu / (1.0 + mu) * G / radius)
    delta = G / (beta * omega) ** 2
    side = contact if contact != FULL else rng.choice([-1.0, 1.0])
    return Case(
        theta=theta,
        radius=radius,
        mu=mu,
        beta=beta,
        xi=rng.uniform(0.05, 0.4),
        alpha=side * theta * rng.uniform(0.2, 0.9),
        spin=rng.choice([-1.0, 1.0]) * theta * omega * rng.uniform(0.3, 1.0),
        y=rng.choice([-1.0, 1.0]) * delta * rng.uniform(0.3, 2.0),
        speed=rng.choice([-1.0, 1.0]) * delta * beta * omega * rng.uniform(0.3, 1.0),
        ground_x=G * rng.uniform(-1.0, 1.0),
        ground_y=G * rng.uniform(-0.5, 0.5),
    )


def cases(contact):
    rng = np.random.default_rng(20 + contact)
    return [random_case(rng, contact) for _ in range(STATES)]


def newton_euler(case, contact):
    """Solve for accelerations and horizontal reaction; return them and the pad forces."""
    cosine, sine = math.cos(case.alpha), math.sin(case.alpha)
    turn = np.array([[cosine, sine], [-sine, cosine]])  # clockwise
    at_rest = {LEFT: np.array([-case.b, -case.h]), RIGHT: np.array([case.b, -case.h])}
    forces = {}
    for corner, place in at_rest.items():
        if contact in (FULL, corner):
            arm = turn @ place  # from the centre of mass to the corner
            level = case.y + arm[1] - place[1]
            rate = case.speed - case.spin * arm[0]
            forces[corner] = (
                arm,
                case.stiffness * (case.delta - level) - case.damping * rate,
            )
    pin = turn @ np.array([contact * case.b, -case.h])  # FULL: the middle of the base
    # unknowns: x'', y'', alpha'', H
    matrix = np.array(
        [
            [1.0, 0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, case.inertia, -pin[1]],
            [1.0, 0.0, pin[1], 0.0],  # the pinned point has no horizontal acceleration
        ]
    )
    right = np.array(
        [
            -case.ground_x,
            -(G + case.ground_y) + sum(force for _, force in forces.values()),
            -sum(arm[0] * force for arm, force in forces.values()),
            case.spin**2 * pin[0],
        ]
    )
    x, y, alpha, horizontal = np.linalg.solve(matrix, right)
    return x, y, alpha, horizontal, {corner: force for corner, (_, force) in forces.items()}


def imbalance(terms):
    return abs(math.fsum(terms)) / max(abs(term) for term in terms)


# The equations; `printed` is the set of misprints to leave in --------------------------------


def eq_12a(q, y_acc, alpha_acc, printed):
    damping = 2.0 * q.xi * math.sin(q.alpha) / (q.beta * q.omega)
    if "damping" in printed:
        damping = 2.0 * q.xi * q.omega * math.sin(q.alpha) / q.beta
    lift = q.mu * q.beta**2 * G / (1.0 + q.mu) * math.cos(q.theta)
    return [
        y_acc,
        2.0 * q.xi * q.beta * q.omega * q.speed,
        (q.beta * q.omega) ** 2 * q.y,
        lift * (1.0 - math.cos(q.alpha)),
        lift * damping * q.spin,
        q.ground_y,
    ]


def eq_12b(q, y_acc, alpha_acc, printed):
    cosine = math.cos(q.theta)
    doubled = q.theta if "angle" in printed else q.alpha
    power = 2 if "omega" in printed else 4
    damping = 2.0 * q.xi / (q.beta * q.omega)
    if "damping" in printed:
        damping = 2.0 * q.xi * q.omega / q.beta
    stiffness = (
        cosine**2
        - (1.0 + q.mu) / (q.mu * q.beta**2) * cosine
        - math.cos(2.0 * q.theta) * math.cos(q.alpha)
    )
    coupling = (1.0 + q.mu) * q.beta**2 * q.omega**power / G * cosine * math.sin(q.alpha)
    return [
        (1.0 + q.mu * (cosine * math.cos(q.alpha)) ** 2) * alpha_acc,
        -0.5 * q.mu * cosine**2 * math.sin(2.0 * doubled) * q.spin**2,
        q.mu
        * q.xi
        * q.beta
        * q.omega
        * (1.0 - math.cos(2.0 * q.theta) * math.cos(2.0 * q.alpha))
        * q.spin,
        q.mu * (q.beta * q.omega) ** 2 * stiffness * math.sin(q.alpha),
        coupling * q.y,
        coupling * damping * q.speed,
        (1.0 + q.mu) * q.omega**2 * cosine * math.cos(q.alpha) / G * q.ground_x,
    ]


def lean(q):
    """theta +- alpha, and the sign: upper where the left corner bears."""
    sign = 1.0 if q.alpha < 0.0 else -1.0
    return q.theta + sign * q.alpha, sign


def eq_15a(q, y_acc, alpha_acc, printed):
    angle, sign = lean(q)
    scale = q.mu * q.beta**2 * G / (2.0 * (1.0 + q.mu))
    flip = -1.0 if "bracket" in printed else 1.0
    return [
        y_acc,
        q.xi * q.beta * q.omega * q.speed,
        0.5 * (q.beta * q.omega) ** 2 * q.y,
        flip * scale * (math.cos(q.theta) - math.cos(angle)),
        flip * scale * sign * 2.0 * q.xi * q.spin / (q.beta * q.omega) * math.sin(angle),
        q.ground_y,
        0.5 * G,
    ]


def eq_15b(q, y_acc, alpha_acc, printed):
    angle, sign = lean(q)
    power = 2 if "omega" in printed else 4
    side = 1.0 if "side" in printed else sign
    stiffness = math.cos(q.theta) - (1.0 + q.mu) / (q.mu * q.beta**2) - math.cos(angle)
    coupling = side * (1.0 + q.mu) * q.beta**2 * q.omega**power / (2.0 * G) * math.sin(angle)
    return [
        (1.0 + q.mu * math.cos(angle) ** 2) * alpha_acc,
        -sign * 0.5 * q.mu * math.sin(2.0 * angle) * q.spin**2,
        q.mu * q.xi * q.beta * q.omega * math.sin(angle) ** 2 * q.spin,
        side * 0.5 * q.mu * (q.beta * q.omega) ** 2 * stiffness * math.sin(angle),
        coupling * q.y,
        coupling * 2.0 * q.xi / (q.beta * q.omega) * q.speed,
        (1.0 + q.mu) * q.omega**2 * math.cos(angle) / G * q.ground_x,
    ]


MISPRINTS = [
    (eq_12a, FULL, {"damping"}),
    (eq_12b, FULL, {"angle"}),
    (eq_12b, FULL, {"omega"}),
    (eq_12b, FULL, {"damping"}),
    (eq_12b, FULL, {"angle", "omega", "damping"}),
    (eq_15a, RIGHT, {"bracket"}),
    (eq_15a, LEFT, {"bracket"}),
    (eq_15b, RIGHT, {"side"}),
    (eq_15b, RIGHT, {"omega"}),
    (eq_15b, LEFT, {"omega"}),
    (eq_15b, RIGHT, {"side", "omega"}),
]
IDS = [
    f"{equation.__name__}-{ {FULL: 'full', LEFT: 'left', RIGHT: 'right'}[contact] }-"
    + "+".join(sorted(printed))
    for equation, contact, printed in MISPRINTS
]


def imbalances(equation, contact, printed):
    values = []
    for case in cases(contact):
        _, y_acc, alpha_acc, _, _ = newton_euler(case, contact)
        values.append(imbalance(equation(case, y_acc, alpha_acc, printed)))
    return np.array(values)


@pytest.mark.parametrize(
    ("equation", "contact"),
    [(eq_12a, FULL), (eq_12b, FULL), (eq_15a, LEFT), (eq_15a, RIGHT), (eq_15b, LEFT),
     (eq_15b, RIGHT)],
)  # fmt: skip
def test_corrected_equations_match_newton_euler(equation, contact):
    assert imbalances(equation, contact, set()).max() < EXACT


@pytest.mark.parametrize(("equation", "contact", "printed"), MISPRINTS, ids=IDS)
def test_every_misprint_alone_breaks_the_equation(equation, contact, printed):
    broken = imbalances(equation, contact, printed)
    assert np.median(broken) > 5e-4
    assert broken.min() > 1e3 * EXACT


def eq_13c(q, alpha_acc, horizontal, vertical, printed):
    arm = math.cos(q.theta + q.alpha if "angle" in printed else q.theta - q.alpha)
    return [
        q.inertia * alpha_acc,
        horizontal * q.radius * arm,
        vertical * q.radius * math.sin(q.theta - q.alpha),
    ]


def imbalances_13c(printed):
    values = []
    for case in cases(RIGHT):
        _, _, alpha_acc, horizontal, pads = newton_euler(case, RIGHT)
        values.append(imbalance(eq_13c(case, alpha_acc, horizontal, pads[RIGHT], printed)))
    return np.array(values)


def test_lever_of_horizontal_reaction_in_eq_13c():
    assert imbalances_13c(set()).max() < EXACT
    assert np.median(imbalances_13c({"angle"})) > 1e-2


# Impact, Eqs. (2) and (3) ---------------------------------------------------------------------


def rigid_damper(case, strength):
    """Let a dashpot act on the left corner of an upright block pinned in the middle."""
    inertia = case.inertia + case.h**2  # about M
    lever = np.array([1.0, case.b])  # the corner's speed from (y', alpha')
    mass = np.diag([1.0, inertia])
    before = np.array([-0.3, -0.2])
    after = expm(-strength * np.linalg.solve(mass, np.outer(lever, lever))) @ before
    kinetic = [0.5 * rates @ mass @ rates for rates in (before, after)]
    return lever @ before, lever @ after, kinetic[0] - kinetic[1]


@pytest.mark.parametrize(("reading", "holds"), [("corner", True), ("centre", False)])
def test_impact_law_holds_with_inertia_about_corner(reading, holds):
    """Eqs. (2) and (3) hold if their I_O is the inertia about a corner, I_O + m R0^2."""
    strength = 0.4  # c_inf dt
    for case in cases(FULL)[:20]:
        before, after, loss = rigid_damper(case, strength)
        about_base = case.inertia + case.h**2
        read = case.inertia + (case.radius**2 if reading == "corner" else 0.0)
        eps = math.exp(-read / about_base * strength)
        assert math.isclose(after, eps * before, rel_tol=1e-12) is holds
        printed_loss = 0.5 * about_base / read * (1.0 - (after / before) ** 2) * before**2
        assert math.isclose(loss, printed_loss, rel_tol=1e-12) is holds


# Energy is conserved without damping and ground motion -------------------------------------------


def accelerations(equations, case, printed):
    """Solve the paper's pair of equations, linear in y'' and alpha'', for these."""
    result = []
    for equation, place in zip(equations, (0, 1), strict=True):
        at_zero = math.fsum(equation(case, 0.0, 0.0, printed))
        at_one = math.fsum(equation(case, *((1.0, 0.0), (0.0, 1.0))[place], printed))
        result.append(-at_zero / (at_one - at_zero))
    return result


def energy(q, contact):
    corners = [corner for corner in (LEFT, RIGHT) if contact in (FULL, corner)]
    bend = q.h * math.cos(q.alpha) + contact * q.b * math.sin(q.alpha)
    kinetic = 0.5 * (q.speed**2 + (q.inertia + bend**2) * q.spin**2)
    springs = 0.0
    for corner in corners:
        level = q.y + q.h * (1.0 - math.cos(q.alpha)) - corner * q.b * math.sin(q.alpha)
        springs += 0.5 * q.stiffness * (q.delta - level) ** 2
    return kinetic, kinetic + G * q.y + springs


def energy_drift(contact, printed):
    """Return the largest change of energy in free motion over the largest kinetic energy."""
    equations = (eq_12a, eq_12b) if contact == FULL else (eq_15a, eq_15b)
    block = {"theta": math.atan(0.25), "radius": 5.0, "mu": 3.0, "beta": 20.0, "xi": 0.0}
    still = {"ground_x": 0.0, "ground_y": 0.0}

    def case(z):
        return Case(**block, alpha=z[0], y=z[1], spin=z[2], speed=z[3], **still)

    def rates(_, z):
        y_acc, alpha_acc = accelerations(equations, case(z), printed)
        return [z[2], z[3], alpha_acc, y_acc]

    at_rest = case([0.0, 0.0, 0.0, 0.0])
    if contact == FULL:
        start = [0.6 * at_rest.delta / at_rest.b, 0.3 * at_rest.delta, 0.0, 0.0]
    else:
        alpha = contact * 0.4 * at_rest.theta
        rise = at_rest.b * math.sin(abs(alpha)) - at_rest.h * (1.0 - math.cos(alpha))
        start = [alpha, rise - at_rest.delta, 0.0, 0.0]
    run = solve_ivp(rates, (0.0, 0.5), start, method="DOP853", rtol=1e-12, atol=1e-14)
    values = np.array([energy(case(z), contact) for z in run.y.T])
    return np.ptp(values[:, 1]) / values[:, 0].max()


@pytest.mark.parametrize("contact", [FULL, LEFT, RIGHT], ids=["full", "left", "right"])
def test_corrected_equations_conserve_energy(contact):
    assert energy_drift(contact, set()) < 1e-9


@pytest.mark.parametrize("contact", [FULL, LEFT, RIGHT], ids=["full", "left", "right"])
def test_printed_equations_do_not_conserve_energy(contact):
    everything = {"angle", "omega", "damping", "bracket", "side"}
    assert energy_drift(contact, everything) > 1e-3


# rockframe's own equations --------------------------------------------------------------------


def model_of(case, restraint="contact-state"):
    theta = case.theta
    block = rf.Block(
        width=f"{2.0 * case.b!r} m",
        height=f"{2.0 * case.h!r} m",
        mass="1 kg",
        shape_factor=case.mu,
    )
    assert block.overturning_angle.m == pytest.approx(theta, rel=1e-14)
    pads = rf.TwoSpringSupport(frequency_ratio=case.beta, damping_ratio=case.xi)
    return rf.System(block, pads, restraint=restraint).setting.compile()


MODES = {
    FULL: Mode(TOUCHING + CORNER * TOUCHING, PIVOT_CENTRE, False),
    LEFT: Mode(TOUCHING + CORNER * CLEAR, PIVOT_LEFT, False),
    RIGHT: Mode(CLEAR + CORNER * TOUCHING, PIVOT_RIGHT, False),
}


@pytest.mark.parametrize("contact", [FULL, LEFT, RIGHT], ids=["full", "left", "right"])
def test_rockframe_accelerations_match_newton_euler(contact):
    for case in cases(contact)[:50]:
        system = model_of(case).system
        mode = system.part.number_of(MODES[contact])
        state = np.array([case.alpha, case.y, 0.0, case.spin, case.speed, 0.0])
        out = system.accelerate(mode, state, Ground(case.ground_x, case.ground_y))
        _, y_acc, alpha_acc, _, pads = newton_euler(case, contact)
        sizes = [G, *map(abs, pads.values())]
        assert abs(out[VERTICAL] - y_acc) < 10.0 * EXACT * max(sizes)
        turning = max(sizes) * case.radius / case.inertia
        assert abs(out[ROTATION] - alpha_acc) < 10.0 * EXACT * turning
