"""A block with Coulomb friction on rigid ground, in maximal coordinates, by SciPy.

Shares nothing with the package. Coordinates are position and rotation of the centre of mass;
forces at both corners follow from the constraints of a mode; the first consistent mode of all is
taken; impacts step through the impulse (Routh).
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from . import ties

TINY = 1e-9
STOPPED = 1e-11
REST = 1e-10  # rotation over that of unstable equilibrium
MOST_EVENTS = 4000
LONGEST = 0.005  # longest step, so that no margin falls and rises again within one [s]


@dataclass(frozen=True)
class Mode:
    """The bearing corners, and the sign of the slip."""

    corners: str  # "", "R", "L" or "LR"
    slip: int


ORDER = [
    Mode("", 0), Mode("LR", 0), Mode("R", 0), Mode("L", 0), Mode("LR", 1), Mode("LR", -1),
    Mode("R", 1), Mode("R", -1), Mode("L", 1), Mode("L", -1),
]  # fmt: skip


@dataclass
class Block:
    """The block, and the ground's acceleration along and normal to its base."""

    left: float
    right: float
    height: float
    inertia: float
    static: float
    kinetic: float
    gravity: float
    times: np.ndarray
    along: np.ndarray
    normal: np.ndarray
    limits: tuple  # rotations to the left and to the right at which it overturns
    events: list = field(default_factory=list)
    tied: list = field(default_factory=list)  # a `ties.Tie` each

    def seen_by_ties(self, z):
        """Rotation, height and place as ties have them, and their rates."""
        return z[2], z[1] - self.height, z[0], z[5], z[4], z[3]

    def ground(self, t, piece):
        t0, t1 = self.times[piece], self.times[piece + 1]
        share = (t - t0) / (t1 - t0)
        return tuple(
            one[piece] + share * (one[piece + 1] - one[piece]) for one in (self.along, self.normal)
        )

    def corner(self, which, a):
        d = self.right if which == "R" else -self.left
        c, s = math.cos(a), math.sin(a)
        r = (d * c - self.height * s, -d * s - self.height * c)
        return r, (-d * s - self.height * c, -d * c + self.height * s)

    def gap(self, which, z):
        return z[1] + self.corner(which, z[2])[0][1]

    def rates(self, which, z):
        """Velocities of a corner along and normal to the ground."""
        _, dr = self.corner(which, z[2])
        return z[3] + dr[0] * z[5], z[4] + dr[1] * z[5]

    def forces(self, mode, z, ground):
        """Accelerations of the body, normal forces by corner, and friction."""
        n = len(mode.corners)
        size = 3 + n + (n > 0)
        m, f = np.zeros((size, size)), np.zeros(size)
        m[0, 0] = m[1, 1] = 1.0
        m[2, 2] = self.inertia
        f[:2] = -ground[0], -self.gravity - ground[1]
        turning, up, across = ties.forces(self.tied, self.seen_by_ties(z), math)
        f[:3] += across, up, turning
        w2 = z[5] * z[5]
        for k, which in enumerate(mode.corners):
            r, dr = self.corner(which, z[2])
            normal = np.array([0.0, 1.0, dr[1]])
            m[3 + k, :3], m[:3, 3 + k] = normal, -normal
            f[3 + k] = r[1] * w2
            tangent, bend = np.array([1.0, 0.0, dr[0]]), r[0] * w2
        if n:
            m[:3, -1] = -tangent
            if mode.slip == 0:
                m[-1, :3], f[-1] = tangent, bend
            else:
                m[-1, -1], m[-1, 3 : 3 + n] = 1.0, mode.slip * self.kinetic
        solution = np.linalg.solve(m, f)
        return solution[:3], dict(zip(mode.corners, solution[3 : 3 + n], strict=True)), (
            solution[-1] if n else 0.0
        )  # fmt: skip

    def corner_acceleration(self, which, z, a):
        r, dr = self.corner(which, z[2])
        w2 = z[5] * z[5]
        return a[0] + dr[0] * a[2] - r[0] * w2, a[1] + dr[1] * a[2] - r[1] * w2

    def margins(self, mode, z, ground):
        """Functions that are positive as long as the mode lasts, by name."""
        margins = {f"gap {c}": self.gap(c, z) for c in "RL" if c not in mode.corners}
        margins |= ties.guards_of(self.tied, self.seen_by_ties(z))
        if not mode.corners:
            return margins
        _, normal, friction = self.forces(mode, z, ground)
        margins |= {f"press {c}": n for c, n in normal.items()}
        if mode.slip == 0:
            most = self.static * sum(normal.values())
            margins |= {"friction +": most + friction, "friction -": most - friction}
        else:
            margins["slip"] = mode.slip * self.rates(mode.corners[-1], z)[0]
        return margins

    def next_mode(self, z, ground, gone, touching):
        """Return the first consistent mode; `gone` is the contact that has just ended."""
        for mode in ORDER:
            if mode == gone or any(c not in touching for c in mode.corners):
                continue
            a, normal, friction = self.forces(mode, z, ground)
            scale = self.gravity
            if any(n < -TINY * scale for n in normal.values()):
                continue
            free = [c for c in touching if c not in mode.corners]
            opening = (self.corner_acceleration(c, z, a)[1] for c in free)
            if any(one < -TINY * scale for one in opening):
                continue
            if mode.corners:
                speed = self.rates(mode.corners[-1], z)[0]
                speeding = self.corner_acceleration(mode.corners[-1], z, a)[0]
                if abs(speed) > 1e-11 and mode.slip != math.copysign(1, speed):
                    continue
                if abs(speed) <= 1e-11 and mode.slip * speeding < -TINY * scale:
                    continue
                if mode.slip == 0 and abs(friction) > self.static * sum(normal.values()) + TINY:
                    continue
            return mode
        msg = "no mode is consistent"
        raise RuntimeError(msg)

    def impulse(self, which, z):
        """Stop a corner by stepping through the impulse (Routh)."""
        _, dr = self.corner(which, z[2])
        inverse = np.array([1.0, 1.0, 1.0 / self.inertia])
        normal, tangent = np.array([0.0, 1.0, dr[1]]), np.array([1.0, 0.0, dr[0]])
        v = np.array(z[3:])
        for _ in range(3):
            slip, sink = tangent @ v, normal @ v
            if abs(slip) > 1e-13:
                ratio = -self.kinetic * math.copysign(1, slip)
            else:
                ratio = -(tangent * inverse @ normal) / (tangent * inverse @ tangent)
                ratio = min(max(ratio, -self.kinetic), self.kinetic)
            push = inverse * (normal + ratio * tangent)
            ends = -sink / (normal @ push)
            stops = -slip / (tangent @ push) if abs(slip) > 1e-13 else math.inf
            if not 0.0 < stops < ends:
                v = v + ends * push
                break
            v = v + stops * push
            v -= tangent * (tangent @ v) / (tangent @ tangent)
        return np.array([*z[:3], *v])

    def land(self, mode, which, z, ground):
        """Return state and mode after an impact, and whether the block comes to rest."""
        other = "L" if which == "R" else "R"
        both = abs(self.gap(other, z)) < 1e-11
        new = self.impulse(which, z)
        if both and self.rates(other, new)[1] < 0.0:
            vx, vy = z[3], z[4]
            most = self.kinetic * abs(vy)
            vx = 0.0 if abs(vx) <= most else vx - math.copysign(most, vx)
            new = np.array([z[0], self.height, 0.0, vx, 0.0, 0.0])
            return new, self.next_mode(new, ground, None, "LR"), False
        new_mode = self.next_mode(new, ground, None, which)
        if both and new_mode.corners in (which, "") and mode.corners == other:
            angle = math.atan2(self.right if which == "R" else self.left, self.height)
            slip, leans, still = new[3] - new[5] * self.height, new_mode, new.copy()
            if slip**2 < REST * self.gravity * self.height:  # too low to resolve
                still[3], slip = still[3] - slip, 0.0
                leans = Mode(which, 0) if new_mode.corners else new_mode
            a = self.forces(leans, still, ground)[0]
            falls = -self.corner_acceleration(other, still, a)[1] / (self.left + self.right)
            if falls > 0.0 and new[5] ** 2 < 2.0 * falls * REST * angle:
                # all later bounces together supply the vertical momentum, and its friction
                most = self.kinetic * abs(z[4])
                across = math.copysign(max(abs(z[3]) - most, 0.0), z[3]) if slip != 0.0 else 0.0
                flat = np.array([z[0], self.height, 0.0, across, 0.0, 0.0])
                resting, side = (
                    self.next_mode(flat, ground, None, "LR"),
                    1.0 if which == "R" else -1.0,
                )
                held = self.forces(mode, flat, ground)[0][2]
                if resting.corners == "LR" and -side * held <= 0.0:
                    return flat, resting, True
                if not new_mode.corners and resting.corners == other:  # it bounces on both
                    return flat, resting, False
        return new, new_mode, False

    def simulate(self, rotation, duration, rtol=1e-11, stop=True):
        """Integrate; return peaks of rotation and slip, events, and the end."""
        a = rotation
        which = "R" if a > 0 else "L"
        r, _ = self.corner(which, a)
        d = self.right if which == "R" else -self.left
        z = np.array([d - r[0], -r[1], a, 0.0, 0.0, 0.0])
        if a == 0.0:
            z = np.array([0.0, self.height, 0.0, 0.0, 0.0, 0.0])
        for tie in self.tied:
            tie.begin(self.height, self.seen_by_ties(z))
        mode = None
        t, piece, peak, peak_slip = 0.0, 0, abs(a), 0.0
        began, passes = t, 0
        while t < duration - 1e-12:
            began, passes = (t, 0) if t > began else (began, passes + 1)
            while self.times[piece + 1] <= t + 1e-13:
                piece += 1
            ground = self.ground(t, piece)
            touching = "LR" if z[2] == 0.0 and mode is None else which if mode is None else None
            if mode is None:
                mode = self.next_mode(z, ground, None, touching)
                if not mode.corners:
                    self.events.append((t, "SEPARATION"))
                elif mode.corners != touching:
                    self.events.append((t, "UPLIFT"))
                elif mode.slip:
                    self.events.append((t, "SLIP"))
            else:  # the ground acceleration may have jumped
                margins = self.margins(mode, z, ground)
                own = [one for name, one in margins.items() if "tie" not in name]
                if min(own, default=0.0) < -1e-7:
                    mode = self.changed(t, mode, None, z, ground)
            end = min(self.times[piece + 1], duration)
            t, z, mode, largest, slipped, fell = self.go(t, z, mode, piece, end, rtol)
            peak, peak_slip = max(peak, largest), max(peak_slip, slipped)
            if fell and stop:
                break
            if max(len(self.events), passes) > MOST_EVENTS:
                msg = "too many events"
                raise RuntimeError(msg)
        return {"peak": peak, "peak_slip": peak_slip, "time": t, "state": z, "mode": mode,
                "events": self.events, "fell": fell}  # fmt: skip

    def slip(self, mode, z):
        """Slip of the corner that bears."""
        if not mode.corners:
            return 0.0
        which = mode.corners[-1]
        d = self.right if which == "R" else -self.left
        return z[0] + self.corner(which, z[2])[0][0] - d

    def changed(self, t, mode, gone, z, ground):
        """Change the mode without an impact."""
        touching = mode.corners
        new = self.next_mode(z, ground, gone, touching)
        if not new.corners:
            kind = "SEPARATION"
        elif mode.corners == "LR" and new.corners != "LR":
            kind = "UPLIFT"
        elif new == mode:
            return new
        elif new.slip == 0:
            kind = "STICK"
        else:
            kind = "SLIP" if mode.slip == 0 else "SLIP_REVERSAL"
        self.events.append((t, kind))
        return new

    def go(self, t, z, mode, piece, end, rtol):
        """Integrate up to the next event or the end of a piece."""
        names = list(self.margins(mode, z, self.ground(t, piece)))
        last = [None, {}]

        def event(name):
            def margin(time, state):
                at = time, *state
                if at != last[0]:  # all event functions are evaluated at the same points
                    last[:] = at, self.margins(mode, state, self.ground(time, piece))
                return last[1][name]

            margin.terminal, margin.direction = True, -1.0
            return margin

        def fallen(time, state):
            return self.limits[int(state[2] > 0.0)] - abs(state[2])

        fallen.terminal, fallen.direction = True, -1.0

        def rate(time, state):
            a = self.forces(mode, state, self.ground(time, piece))[0]
            return [*state[3:], *a]

        ground = self.ground(t, piece)
        a = self.forces(mode, z, ground)[0]
        longest = LONGEST
        if self.tied:  # nor the change of a tie
            stiffest = max(math.sqrt(tie.stiffness) for tie in self.tied)
            longest = min(longest, 0.1 / stiffest)
        for c in "RL":  # a corner that has just left returns
            if c not in mode.corners:
                opens, closing = self.rates(c, z)[1], self.corner_acceleration(c, z, a)[1]
                if opens > 0.0 > closing:
                    longest = min(longest, -0.2 * opens / closing)
        atol = np.full(6, 1e-13)
        atol[[2, 5]] = 1e-19 if longest < LONGEST else 1e-13
        first = min(longest, end - t, 1e-3)
        ran = solve_ivp(
            rate, (t, end), z, method="DOP853", rtol=rtol, atol=atol, max_step=longest,
            first_step=first, events=[*map(event, names), fallen],
        )  # fmt: skip
        peak = float(np.abs(ran.y[2]).max())
        rates = ran.y[5]
        for i in np.flatnonzero(rates[:-1] * rates[1:] < 0.0):
            h = ran.t[i + 1] - ran.t[i]
            r0, r1, v0, v1 = ran.y[2, i], ran.y[2, i + 1], rates[i] * h, rates[i + 1] * h
            c2, c3 = 3 * (r1 - r0) - 2 * v0 - v1, 2 * (r0 - r1) + v0 + v1
            for s in np.roots([3 * c3, 2 * c2, v0]):
                if abs(s.imag) < 1e-12 and 0 < s.real < 1:
                    s = s.real
                    peak = max(peak, abs(r0 + s * (v0 + s * (c2 + s * c3))))
        slips = [abs(self.slip(mode, ran.y[:, k])) for k in (0, -1)]
        t, z = float(ran.t[-1]), ran.y[:, -1].copy()
        if ran.status != 1:
            return t, self.tidied(mode, z), mode, peak, max(slips), False
        hit = next(k for k, times in enumerate(ran.t_events) if len(times))
        if hit == len(names):
            self.events.append((t, "OVERTURNING"))
            return t, z, mode, peak, max(slips), True
        name, ground = names[hit], self.ground(t, piece)
        if name[-1] == "turn" and self.stops(mode, z, ground):
            name = "slip"  # the tie reverses because the block stops
        z = self.tidied(mode, z)
        if name[0] == "tie":
            tie, kind = self.tied[name[1]], name[2]
            self.events.append((t, ties.event_of(tie, kind)))
            tie.switch(kind, self.seen_by_ties(z))
            turned = ties.turn_others(self.tied, self.seen_by_ties(z))
            self.events += [(t, one) for one in turned]
            if tie.state == ties.BROKEN and mode.corners:
                shown = len(self.events)
                mode = self.changed(t, mode, None, z, ground)
                del self.events[shown:]  # a change of the tie
            return t, z, mode, peak, max(slips), False
        if name.startswith("gap"):
            which = name[-1]
            other = "L" if which == "R" else "R"
            if other in mode.corners:
                z[2] = 0.0
                z[1] = self.height
            else:
                z[1] -= self.gap(which, z)
            z, new, rests = self.land(mode, which, z, ground)
            self.events.append((t, "REST" if rests else "IMPACT"))
            turned = ties.turn_others(self.tied, self.seen_by_ties(z))
            self.events += [(t, one) for one in turned]
            return t, self.tidied(new, z), new, peak, max(slips), False
        if name == "slip":
            z[3] -= self.rates(mode.corners[-1], z)[0]
            new = self.changed(t, mode, None, z, ground)
            return t, z, new, peak, max(slips), False
        return t, z, self.changed(t, mode, mode, z, ground), peak, max(slips), False

    def stops(self, mode, z, ground):
        """Whether a block that slides on its whole base stops."""
        if mode.corners != "LR" or not mode.slip or abs(z[3]) > STOPPED:
            return False
        return mode.slip * self.forces(mode, z, ground)[0][0] < 0.0

    def tidied(self, mode, z):
        """Project the state on the constraints, from which rounding of steps has moved it."""
        if mode.corners == "LR":
            z[1], z[2], z[4], z[5] = self.height, 0.0, 0.0, 0.0
            if mode.slip == 0:
                z[3] = 0.0
        elif mode.corners:
            which = mode.corners
            z[1] -= self.gap(which, z)
            across, up = self.rates(which, z)
            z[4] -= up
            if mode.slip == 0:
                z[3] -= across
        return z
