"""A block on two springs on a cap on a Winkler bed, integrated independently.

The six coordinates are those of the cap's centre (X, Y), the cap's rotation phi, and, in the
cap's frame, the block's centre (xi along the cap, r along its normal) and its rotation psi
relative to the cap. Kinetic and potential energy are symbolic, and Lagrange's
equations follow by differentiation. Contact is imposed by projection: while the cap
touches the soil X follows phi, while the block touches the cap xi follows psi,

    dX/dphi = h_c cos(phi) + e_c sin(phi),   dxi/dpsi = h cos(psi) + e sin(psi),

with e_c and e the points held. No reduced equation is derived by hand.

The state is (coordinates, their rates, work of the dashpots, work of the ground); works and
energies are per unit of the total mass until the result is written. A corner of the block is
TOUCHING, RELAXING (free, but its spring is still below its free length) or CLEAR; an end of
the cap is TOUCHING (below the bed's unloaded level) or CLEAR. The rules of `two_spring`
for a corner that has just left or re-engaged apply here too. When the other corner or the soil
changes contact, the jump of the rates may take a relaxing corner from pull to pressure: it
re-engages at once, as the force is a function of the state alone.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import sympy
from scipy.optimize import brentq

from . import SIMULTANEOUS, Drive, Guard
from .winkler import CASCADE, CLEAR, ORDER, RELAXING, TOUCHING, Bed, ChatterError, March

X, Y, PHI, XI, R, PSI = range(6)
PAIRS = [(i, j) for i in range(6) for j in range(i + 1)]


@dataclass
class Event:
    """One change of contact or of the leading corner, or an overturning.

    ``interface`` is "pads", "soil" or empty; ``before`` and ``after`` are
    (X, Y, phi, xi, r, psi) and their rates.
    """

    time: float
    kind: str
    interface: str
    corners: str
    contact_before: tuple[str, str]
    contact_after: tuple[str, str]
    before: tuple[float, ...]
    after: tuple[float, ...]
    repinning_loss: float = 0.0
    impact_loss: float = 0.0
    struck: bool = False


@dataclass
class Result:
    """Samples, events and energy balance of one run.

    ``rotation`` is the block's, phi + psi; ``cap_vertical``, ``cap_rotation``, ``pad_vertical``
    and ``pad_rotation`` are Y, phi, r and psi; ``cap_horizontal`` and ``slide`` are X and xi.
    ``horizontal`` and ``vertical`` are those of the block's centre of mass relative to the
    ground, from its position at rest. ``rates`` holds the rates of (X, Y, phi, xi, r, psi), one
    row each. Samples after the end of the run are NaN, the contacts there empty strings; at
    the instant of an event the samples are those after it. Energies are in joules.
    """

    time: np.ndarray
    rotation: np.ndarray
    horizontal: np.ndarray
    vertical: np.ndarray
    cap_horizontal: np.ndarray
    cap_vertical: np.ndarray
    cap_rotation: np.ndarray
    slide: np.ndarray
    pad_vertical: np.ndarray
    pad_rotation: np.ndarray
    rates: np.ndarray
    block_contact: np.ndarray
    cap_contact: np.ndarray
    events: list[Event] = field(default_factory=list)
    peak_rotation: float = 0.0
    impact_count: int = 0
    landing_count: int = 0
    block_flight_time: float = 0.0
    cap_flight_time: float = 0.0
    overturned: bool = False
    overturning_time: float | None = None
    end_time: float = 0.0
    dashpot_work: float = 0.0
    input_work: float = 0.0
    impact_loss: float = 0.0
    repinning_loss: float = 0.0
    initial_energy: float = 0.0
    final_energy: float = 0.0
    energy_residual: float = 0.0


@functools.cache
def lagrangian():
    """Derive Lagrange's equations; return numerical functions for math and for numpy.

    ``equations`` gives the lower triangle of the mass matrix and the six sums of the terms
    quadratic in the rates and of the pull of a uniform field (ax, ay) on both bodies.
    ``places`` gives position and velocity of the block's centre of mass.
    """
    q = sympy.symbols("X Y phi xi r psi")
    v = sympy.symbols("v_X v_Y v_phi v_xi v_r v_psi")
    m, m_c, inertia, inertia_c, h, h_c = parameters = sympy.symbols("m m_c I I_c h h_c")
    ax, ay = sympy.symbols("a_x a_y")
    along = sympy.Matrix([sympy.cos(q[PHI]), -sympy.sin(q[PHI])])
    normal = sympy.Matrix([sympy.sin(q[PHI]), sympy.cos(q[PHI])])
    cap = sympy.Matrix([q[X], h_c + q[Y]])
    block = cap + h_c * normal + q[XI] * along + (h + q[R]) * normal

    def velocity(place):
        return place.jacobian(q) * sympy.Matrix(v)

    def square(vector):
        return vector.dot(vector)

    kinetic = (
        m * square(velocity(block))
        + m_c * square(velocity(cap))
        + inertia * (v[PHI] + v[PSI]) ** 2
        + inertia_c * v[PHI] ** 2
    ) / 2
    field_ = sympy.Matrix([ax, ay])
    potential = m * field_.dot(block) + m_c * field_.dot(cap)
    momenta = [sympy.diff(kinetic, rate) for rate in v]
    mass = sympy.hessian(kinetic, v)
    pull = [
        sum(sympy.diff(momenta[i], q[k]) * v[k] for k in range(6))
        - sympy.diff(kinetic, q[i])
        + sympy.diff(potential, q[i])
        for i in range(6)
    ]
    entries = [sympy.simplify(mass[i, j]) for i, j in PAIRS]
    equations = [*entries, *(sympy.expand(one) for one in pull)]
    places = [*block, *velocity(block)]
    symbols_given = (q, v, parameters)
    return {
        xp: (
            sympy.lambdify((*symbols_given, ax, ay), equations, modules=name, cse=True),
            sympy.lambdify(symbols_given, places, modules=name, cse=True),
        )
        for xp, name in ((math, "math"), (np, "numpy"))
    }


class _Run(March):
    def __init__(self, *, size, pads, cap, bed, restitution, theta, gravity, restraint):
        super().__init__(theta, gravity, restraint)
        self.b, self.h = size
        self.k, self.c, self.delta = pads
        self.b_c, self.h_c = bed.b, bed.h
        self.bed = bed
        m, m_c, inertia, inertia_c = cap
        self.m, self.m_c = m, m_c
        self.parameters = (m, m_c, inertia, inertia_c, self.h, self.h_c)
        self.eps = restitution
        self.corner = {"L": TOUCHING, "R": TOUCHING}
        self.contact = {"pads": "full", "soil": "full"}
        self.side = {"pads": 0, "soil": 0}
        self.grace: set[str] = set()
        self.functions = lagrangian()

    # kinematics -----------------------------------------------------------------------------
    def touch(self) -> None:
        """Name both contacts from the states of their ends."""
        for interface, ends in (("pads", self.corner), ("soil", self.bed.end)):
            left, right = (ends[name] == TOUCHING for name in "LR")
            one_sided = "left" if left else "right"
            self.contact[interface] = one_sided if left != right else ("full" if left else "flight")

    def eccentricity(self, interface) -> float:
        b = self.b if interface == "pads" else self.b_c
        if self.restraint == "leading-corner":
            return b * self.side[interface]
        if self.restraint == "contact-state":
            return {"full": 0.0, "right": b, "left": -b}[self.contact[interface]]
        return 0.0

    def lever(self, interface, angle, xp=math):
        """First and second derivative of X in phi, or of xi in psi."""
        e, h = self.eccentricity(interface), self.h if interface == "pads" else self.h_c
        sine, cosine = xp.sin(angle), xp.cos(angle)
        return h * cosine + e * sine, e * cosine - h * sine

    def constraints(self):
        """List the coordinates held by contact, each with its interface and its master."""
        held = [("soil", X, PHI), ("pads", XI, PSI)]
        return [one for one in held if self.contact[one[0]] != "flight"]

    def rates(self, z, xp=math):
        """Return the six rates: those of held coordinates follow from their masters'."""
        v = list(z[6:12])
        for interface, slave, master in self.constraints():
            v[slave] = self.lever(interface, z[master], xp)[0] * v[master]
        return v

    def basis(self, z, v, xp=math):
        """Return B and a such that the accelerations are B times the free ones, plus a."""
        shape = np.shape(z[0])
        held = self.constraints()
        slaves = [slave for _, slave, _ in held]
        free = [i for i in range(6) if i not in slaves]
        basis = np.zeros((*shape, 6, len(free)))
        bias = np.zeros((*shape, 6))
        for column, i in enumerate(free):
            basis[..., i, column] = 1.0
        for interface, slave, master in held:
            first, second = self.lever(interface, z[master], xp)
            basis[..., slave, free.index(master)] = first
            bias[..., slave] = second * v[master] ** 2
        return basis, bias

    def corners(self, psi, r, xp=math):
        """Return for L and R the rise, its derivative in the rotation, and the second one."""
        b, h = self.b, self.h
        sine, cosine = xp.sin(psi), xp.cos(psi)
        middle = r + h * (1.0 - cosine)
        return {
            "L": (middle + b * sine, h * sine + b * cosine, h * cosine - b * sine),
            "R": (middle - b * sine, h * sine - b * cosine, h * cosine + b * sine),
        }

    def pads(self, z, xp=math):
        """Return for each corner its rise, rate, expression of its force, lever and bend."""
        out = {}
        for name, (rise, arm, bend) in self.corners(z[PSI], z[R], xp).items():
            rate = z[6 + R] + arm * z[6 + PSI]
            out[name] = (rise, rate, self.k * (self.delta - rise) - self.c * rate, arm, bend)
        return out

    def matrix(self, entries, shape=()):
        mass = np.empty((6, 6, *shape))
        for (i, j), entry in zip(PAIRS, entries, strict=True):
            mass[i, j] = mass[j, i] = entry
        return np.moveaxis(mass, (0, 1), (-2, -1)) if shape else mass

    def mass(self, z):
        """Return the mass matrix of the six coordinates."""
        v = [0.0] * 6
        entries = self.functions[math][0](z[:6], v, self.parameters, 0.0, 0.0)[: len(PAIRS)]
        return self.matrix(entries)

    def motion(self, t, z, xp=math):
        """Accelerations, corners and ends, and the power dissipated by the dashpots."""
        q, v = z[:6], self.rates(z, xp)
        ax, ay = self.ground_x(t), self.ground_y(t)
        answers = self.functions[xp][0](q, v, self.parameters, ax, self.g + ay)
        shape = np.shape(z[0])
        mass = self.matrix(answers[: len(PAIRS)], shape)
        force = [0.0 * q[X] - pull for pull in answers[len(PAIRS) :]]
        corners = self.pads(z, xp)
        dissipated = 0.0 * q[X]
        for name, (rise, rate, push, arm, _) in corners.items():
            if self.corner[name] == TOUCHING:
                force[R] += push
                force[PSI] += push * arm
                dissipated = dissipated + self.c * rate * rate
            elif self.corner[name] == RELAXING:
                dissipated = dissipated + self.k * (self.delta - rise) * rate
        ends = self.bed.ends(q[PHI], q[Y], v[PHI], v[Y], xp)
        lift, moment, power = self.bed.resultants(ends, q[PHI], q[Y], v[PHI], v[Y], xp)
        force[Y] += lift
        force[PHI] += moment
        basis, bias = self.basis(z, v, xp)
        turned = np.swapaxes(basis, -1, -2)
        load = turned @ (np.array(force).T[..., None] - mass @ bias[..., None])
        accelerations = (basis @ np.linalg.solve(turned @ mass @ basis, load))[..., 0] + bias
        return accelerations.T, corners, ends, dissipated + power

    def rhs(self, t, z):
        z = z.tolist()  # plain floats: several times as fast as NumPy's own
        accelerations, _, _, dissipated = self.motion(t, z)
        v = self.rates(z)
        _, _, x_dot, y_dot = self.functions[math][1](z[:6], v, self.parameters)
        work = -self.ground_x(t) * (self.m * x_dot + self.m_c * v[X])
        work -= self.ground_y(t) * (self.m * y_dot + self.m_c * v[Y])
        return [*v, *accelerations.tolist(), dissipated, work]

    def energies(self, z):
        v = np.array(self.rates(z))
        _, height, *_ = self.functions[math][1](z[:6], v, self.parameters)
        height -= self.h + 2.0 * self.h_c
        springs = 0.0
        for rise, *_ in self.corners(z[PSI], z[R]).values():
            springs += 0.5 * self.k * max(0.0, self.delta - rise) ** 2
        return (
            0.5 * float(v @ self.mass(z) @ v),
            self.g * (self.m * height + self.m_c * z[Y]),
            springs,
            self.bed.energy(z[PHI], z[Y]),
        )

    def tilt(self, z):
        return z[PHI] + z[PSI], z[6 + PHI] + z[6 + PSI]

    def in_flight(self):
        return [name for name, contact in self.contact.items() if contact == "flight"]

    def wake(self, states) -> bool:
        """Choose the leading corners at the first sign of a rotation."""
        if self.restraint != "leading-corner":
            return False
        woken = False
        for interface, angle in (("pads", states[PSI]), ("soil", states[PHI])):
            if not self.side[interface] and angle.any():
                self.side[interface] = int(np.sign(angle[np.nonzero(angle)[0][0]]))
                woken = True
        if woken:
            self.set_guards()
        return woken

    def sample(self, z):
        q, v = z[:6], self.rates(z)
        x, y, *_ = self.functions[math][1](q, v, self.parameters)
        y -= self.h + 2.0 * self.h_c
        values = (q[PHI] + q[PSI], x, y, *q, *v)
        return *(float(one) for one in values), self.contact["pads"], self.contact["soil"]

    # guards ---------------------------------------------------------------------------------
    def set_guards(self):
        """Set the guards of the present state, unarmed until they have been positive."""
        guards = []
        for name in "LR":
            where = "pads " + name
            if self.corner[name] == TOUCHING:
                guards.append(Guard("leave", where, strict=name not in self.grace))
                if name in self.grace:
                    guards.append(Guard("slip", where, strict=False))
            elif self.corner[name] == RELAXING:
                guards.append(Guard("clear", where))
                guards.append(Guard("engage", where, strict=False))
                guards.append(Guard("settle", where))
            else:
                guards.append(Guard("land", where))
            kind = "leave" if self.bed.end[name] == TOUCHING else "land"
            guards.append(Guard(kind, "soil " + name))
        if self.restraint == "leading-corner":
            guards += [Guard("side", name + " ") for name, side in self.side.items() if side]
        guards.append(Guard("topple", " +", strict=False))
        guards.append(Guard("topple", " -", strict=False))
        self.guards = guards

    def pad_force(self, corner, accelerations, psi_dot):
        """Return the expression of a corner's force, its rate, and the corner's acceleration."""
        _, rate, force, arm, bend = corner
        acceleration = accelerations[R] + arm * accelerations[PSI] + bend * psi_dot**2
        return force, -self.k * rate - self.c * acceleration, acceleration

    def guard_values(self, t, z, xp=math):
        z = z.tolist() if xp is math else z
        accelerations, corners, ends, _ = self.motion(t, z, xp)
        angle, rate = self.tilt(z)
        out = []
        for guard in self.guards:
            interface, name = guard.where.split(" ")
            if guard.kind == "side":
                index = PSI if interface == "pads" else PHI
                side = self.side[interface]
                out.append((side * z[index], side * z[6 + index]))
            elif guard.kind == "topple":
                sign = 1.0 if name == "+" else -1.0
                out.append((self.limit - sign * angle, -sign * rate))
            elif interface == "soil":
                sign = 1.0 if guard.kind == "leave" else -1.0
                out.append((sign * ends[name].depth, -sign * ends[name].rate))
            else:
                rise, speed, *_ = corners[name]
                force, force_rate, acceleration = self.pad_force(
                    corners[name], accelerations, z[6 + PSI]
                )
                out.append(
                    {
                        "leave": (force, force_rate),
                        "clear": (self.delta - rise, -speed),
                        "slip": (self.delta - rise, -speed),
                        "engage": (-force, -force_rate),
                        "settle": (speed, acceleration),
                        "land": (rise - self.delta, speed),
                    }[guard.kind]
                )
        return out

    # switches -------------------------------------------------------------------------------
    def repin(self, z, before):
        """Project the momentum on the constraints of both contacts; return the loss."""
        mass = self.mass(z)
        basis, _ = self.basis(z, before)
        after = basis @ np.linalg.solve(basis.T @ mass @ basis, basis.T @ mass @ before)
        z[6:12] = after
        return 0.5 * float(before @ mass @ before - after @ mass @ after)

    def strike(self, z, names):
        """Apply the normal impulses of a landing; return the loss and whether any acted."""
        corners = self.pads(z)
        falling = [name for name in names if corners[name][1] < 0.0]
        if not falling:
            return 0.0, False
        v = np.array(self.rates(z))
        mass = self.mass(z)
        basis, _ = self.basis(z, v)
        gradient = np.zeros((6, len(falling)))
        for column, name in enumerate(falling):
            gradient[R, column], gradient[PSI, column] = 1.0, corners[name][3]
        answer = basis @ np.linalg.solve(basis.T @ mass @ basis, basis.T @ gradient)
        speeds = gradient.T @ v
        impulses = np.linalg.solve(gradient.T @ answer, -(1.0 - self.eps) * speeds)
        after = v + answer @ impulses
        z[6:12] = after
        return 0.5 * float(v @ mass @ v - after @ mass @ after), True

    def due(self, t, z, before=None, just_left=()):
        """List the changes of contact that are due in the present state.

        ``before`` holds the corners' force expressions before a jump of the rates.
        """
        changes = []
        accelerations, corners, ends, _ = self.motion(t, z)
        for name, corner in corners.items():
            rise, rate, *_ = corner
            state, where = self.corner[name], "pads " + name
            force, force_rate, _ = self.pad_force(corner, accelerations, z[6 + PSI])
            margin = SIMULTANEOUS * abs(force_rate)
            if state == TOUCHING:
                if name in self.grace and force < -margin:
                    continue
                if force < -margin or (force <= margin and force_rate < 0.0):
                    changes.append(("leave", where))
            elif state == RELAXING:
                if rate > 0.0 and self.delta - rise <= SIMULTANEOUS * rate:
                    changes.append(("clear", where))
                elif rate <= 0.0:
                    changes.append(("settle", where))
                elif before and before[name] <= 0.0 < force - margin and name not in just_left:
                    changes.append(("engage", where))
            elif rate < 0.0 and rise - self.delta <= SIMULTANEOUS * -rate:
                changes.append(("land", where))
        for name, end in ends.items():
            touches = self.bed.end[name] == TOUCHING
            sign = 1.0 if touches else -1.0
            if sign * end.rate > 0.0 and sign * end.depth <= SIMULTANEOUS * abs(end.rate):
                changes.append(("leave" if touches else "land", "soil " + name))
        return changes

    def switch(self, t, z, changes):
        """Carry out the changes that fired, and those that follow at the same instant."""
        self.grace = {name for name in self.grace if self.pads(z)[name][2] <= 0.0}
        just_left: set[str] = set()
        for _ in range(CASCADE):
            before = {name: corner[2] for name, corner in self.pads(z).items()}
            for kind in ORDER:
                for interface in ("", "soil", "pads"):
                    names = "".join(
                        where.split(" ")[1]
                        for what, where in changes
                        if what == kind and where.split(" ")[0] == interface
                    )
                    if (kind, interface + " " + names[:1]) in changes:
                        self.enact(t, z, kind, interface, names, just_left)
            changes = self.due(t, z, before, just_left)
            if not changes:
                break
        else:
            msg = f"contact does not settle at t = {float(t)!r}"
            raise ChatterError(msg)
        self.set_guards()

    def enact(self, t, z, kind, interface, names, just_left):
        """Carry out one change at one interface and record it."""
        was, rates = tuple(self.contact.values()), np.array(self.rates(z))
        span = (*(float(one) for one in z[:6]), *(float(one) for one in rates))
        event = Event(float(t), kind, interface, names, was, was, span, span)
        if kind == "topple":
            self.topple(t)
        elif kind == "side":
            self.side[interface] = -self.side[interface]
        else:
            self.change(z, kind, interface, names, just_left)
            self.touch()
            if self.contact[interface] != was[0 if interface == "pads" else 1]:
                event.repinning_loss = self.repin(z, rates)
                self.losses["repin"] += event.repinning_loss
            if kind == "land" and interface == "pads":
                event.impact_loss, event.struck = self.strike(z, names)
                self.losses["impact"] += event.impact_loss
        event.contact_after = tuple(self.contact.values())
        event.after = (*(float(one) for one in z[:6]), *(float(one) for one in self.rates(z)))
        self.events.append(event)

    def change(self, z, kind, interface, names, just_left):
        """Return the new states of the named corners or ends."""
        for name in names:
            if interface == "soil":
                self.bed.end[name] = TOUCHING if kind == "land" else CLEAR
                self.bed.bounds = self.bed.below()
                continue
            self.grace.discard(name)
            if kind in ("engage", "settle"):
                self.grace.add(name)
            if kind in ("leave", "slip"):
                just_left.add(name)
                rise, rate, *_ = self.pads(z)[name]
                below = self.delta - rise > SIMULTANEOUS * abs(rate)
                self.corner[name] = RELAXING if below else CLEAR
            else:
                self.corner[name] = CLEAR if kind == "clear" else TOUCHING

    def rest(self, psi):
        """Find the r at which the pads, at rest under this rotation, carry the block."""

        def excess(r):
            rises = (rise for rise, *_ in self.corners(psi, r).values())
            return sum(self.k * max(0.0, self.delta - rise) for rise in rises) - self.m * self.g

        size = self.h * (1.0 - math.cos(psi)) + self.b * abs(math.sin(psi))
        return brentq(excess, -size - 3.0 * self.delta, size + self.delta, xtol=1e-16, rtol=1e-15)


def simulate(
    *,
    half_width: float,
    half_height: float,
    shape_factor: float,
    mass: float = 1.0,
    frequency_ratio: float,
    damping_ratio: float,
    restitution: float | None = None,
    cap_half_width: float,
    cap_half_height: float,
    cap_mass: float,
    cap_inertia: float | None = None,
    bed_stiffness: float,
    bed_damping: float = 0.0,
    restraint: str = "contact-state",
    gravity: float = 9.80665,
    time_step: float | None = None,
    acceleration: Sequence[float] | Callable[[float], float] | None = None,
    vertical: Sequence[float] | Callable[[float], float] | None = None,
    breakpoints: Sequence[float] = (),
    duration: float,
    initial: Sequence[float | None] = (None, 0.0, None, 0.0, 0.0, 0.0, 0.0, 0.0),
    sample_times: Sequence[float] = (),
    rtol: float = 1e-12,
    atol: float = 1e-14,
    overturning: str = "stop",
    restart_every_knot: bool = True,
    steps_per_period: float = 40.0,
    max_step: float | None = None,
    method: str = "DOP853",
) -> Result:
    """Integrate block, pads, cap and bed from ``initial`` = (Y, phi, r, psi and their rates).

    The pads are those of the block alone: frequency and damping ratio belong to its mass. The
    bed's stiffness and damping are per unit length of the cap's base. An initial Y of None is
    that at which the bed carries block and cap at rest, an initial r of None that at which the
    pads carry the block. The block starts with ``xi = h sin(psi) + e (1 - cos(psi))``, in
    flight with ``e = 0``; the cap likewise. A free coordinate starts with rate zero.
    """
    if overturning not in ("stop", "continue"):
        msg = f"unknown overturning {overturning!r}"
        raise ValueError(msg)
    b, h, total = half_width, half_height, mass + cap_mass
    radius, theta = math.hypot(b, h), math.atan2(b, h)
    omega_v = frequency_ratio * math.sqrt(shape_factor / (1.0 + shape_factor) * gravity / radius)
    share, cap_share = mass / total, cap_mass / total
    if cap_inertia is None:
        cap_inertia = cap_mass * (cap_half_width**2 + cap_half_height**2) / 3.0
    eps = restitution
    if eps is None:
        eps = (1.0 + shape_factor * math.cos(2.0 * theta)) / (1.0 + shape_factor)
    if not 0.0 < eps <= 1.0:
        msg = f"restitution {eps} is outside (0, 1]"
        raise ValueError(msg)
    run = _Run(
        size=(b, h),
        pads=(share * omega_v**2 / 2.0, damping_ratio * share * omega_v, gravity / omega_v**2),
        cap=(share, cap_share, share * radius**2 / shape_factor, cap_inertia / total),
        bed=Bed(
            half_width=cap_half_width,
            height=cap_half_height,
            stiffness=bed_stiffness / total,
            damping=bed_damping / total,
            settlement=total * gravity / (2.0 * cap_half_width * bed_stiffness),
            separation="displacement",
        ),
        restitution=eps,
        theta=theta,
        gravity=gravity,
        restraint=restraint,
    )
    run.stop_at_theta = overturning == "stop"
    drive = Drive(
        acceleration=acceleration,
        vertical=vertical,
        time_step=time_step,
        breakpoints=breakpoints,
        duration=duration,
        restart_every_knot=restart_every_knot,
    )
    bed_period = 2.0 * math.pi * math.sqrt(total / (2.0 * cap_half_width * bed_stiffness))
    period = min(2.0 * math.pi / omega_v, bed_period)
    if max_step is None:
        max_step = period / steps_per_period
        if not restart_every_knot and time_step is not None:
            max_step = min(max_step, time_step)

    # the start
    sink, phi, r, psi, *rates = initial
    sink = run.bed.rest(phi, gravity) if sink is None else sink
    r = run.rest(psi) if r is None else r
    z = np.zeros(14)
    z[[Y, PHI, R, PSI]] = sink, phi, r, psi
    z[[6 + Y, 6 + PHI, 6 + R, 6 + PSI]] = rates
    for interface, angle in (("pads", PSI), ("soil", PHI)):
        run.side[interface] = int(np.sign(z[angle]) or np.sign(z[6 + angle]))
    for name, (rise, _, force, *_) in run.pads(z).items():
        below = TOUCHING if force > 0.0 else RELAXING
        run.corner[name] = below if rise < run.delta else CLEAR
    for name, end in run.bed.ends(phi, sink, z[6 + PHI], z[6 + Y]).items():
        run.bed.end[name] = TOUCHING if end.depth > 0.0 else CLEAR
    run.bed.bounds = run.bed.below()
    run.touch()
    z[X], z[XI] = cap_half_height * math.sin(phi), h * math.sin(psi)
    for interface, slave, master in run.constraints():
        z[slave] += run.eccentricity(interface) * (1.0 - math.cos(z[master]))
    z[6:12] = run.rates(z)
    run.sample_start = run.sample(z)
    now, z = run.march(
        z,
        drive,
        sample_times,
        period=period,
        max_step=max_step,
        rtol=rtol,
        atol=atol,
        method=method,
    )

    columns = run.columns(sample_times)
    landings = [one for one in run.events if (one.kind, one.interface) == ("land", "pads")]
    return Result(
        np.asarray(sample_times, dtype=float),
        *columns[:9],
        rates=np.array(columns[9:15]),
        block_contact=columns[15],
        cap_contact=columns[16],
        events=run.events,
        peak_rotation=float(run.peak),
        impact_count=sum(event.struck for event in landings),
        landing_count=len(landings),
        block_flight_time=float(run.flight.get("pads", 0.0)),
        cap_flight_time=float(run.flight.get("soil", 0.0)),
        overturned=run.overturning_time is not None,
        overturning_time=run.overturning_time,
        end_time=float(now),
        dashpot_work=total * float(z[-2]),
        input_work=total * float(z[-1]),
        impact_loss=total * float(run.losses["impact"]),
        repinning_loss=total * float(run.losses["repin"]),
        initial_energy=total * run.energy_start,
        final_energy=total * float(sum(run.energies(z))),
        energy_residual=run.energy_residual,
    )
