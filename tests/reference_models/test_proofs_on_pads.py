"""Enclosures of proofs on pads contain a 50-digit run at every sample; planted faults are caught.

The run integrates Newton's and Euler's equations with the force that holds the base, by
extrapolation of the midpoint rule, independently of the prover's series.
"""

from functools import cache, partial
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest

import rockframe as rf

pytest.importorskip("flint", reason="python-flint is not installed")

from rockframe.dynamics.pads import CLEAR as CLEARS
from rockframe.dynamics.pads import TOUCHING as HOLDS
from rockframe.proof.balls import ball, working_precision
from rockframe.proof.pads import flow, law, prover
from rockframe.proof.pads.verdict import pad_prover
from rockframe.proof.problem import Undecided
from rockframe.signals.motion import Motion, Signal
from rockframe.simulation.plan import plan_run, start_of

pytestmark = pytest.mark.wide

STEP, KNOTS, DIGITS, BITS = 0.01, 32, 50, 106
COLUMNS, ROUGH_DIGITS, ROUGH_COLUMNS = 12, 18, 5
TOUCHES, RELAXES, CLEAR, LEAVES = "touches", "relaxes", "clear", "leaves"
MP = mpmath.mp


def samples(seed, peak):
    rough = np.random.default_rng(seed).normal(size=KNOTS + 1)
    smooth = np.convolve(rough, np.hanning(31) / 16.0, "same")
    return np.round(peak * smooth / np.abs(smooth).max(), 6)


ACROSS, UP = samples(3, 7.0), samples(4, 3.0)
SKEW = rf.Block(width="0.5 m", height="1.4 m", mass="2 t", centre_of_mass=("0.65 m", "0.02 m"))
EVEN = rf.Block.from_size(radius="0.7 m", slenderness=3, mass="1 t")
SOFT = rf.TwoSpringSupport(frequency_ratio=8, damping_ratio=0.1, restitution=0.8)
FIRM = rf.TwoSpringSupport(frequency_ratio=14, damping_ratio=0.06)
NO_OFFSET = (0.0,) * 6
CASES = {
    "small rotation": (EVEN, SOFT, "centre", "small", 0.7 * ACROSS, 4.0 * UP),
    "held at the centre": (EVEN, FIRM, "centre", "finite", ACROSS, None),
    "held by contact": (EVEN, FIRM, "contact-state", "finite", 0.7 * ACROSS, 4.0 * UP),
    "skew, held by contact": (SKEW, FIRM, "contact-state", "finite", 0.7 * ACROSS, 4.0 * UP),
}


class ExactRun:
    """A block on two pads, from one change of contact to the next."""

    def __init__(self, system, state, across, up):
        part = system.assembly.model.system.part
        body, pads = part.body, part.base
        of = mpmath.mpf
        self.tall, self.inertia, self.gravity = of(body.height), of(body.inertia), of(body.gravity)
        self.corners = {"left": -of(body.left), "right": of(body.right)}
        self.middle = of(0.5 * (body.right - body.left))
        self.k, self.c, self.rest = of(pads.law.stiffness), of(pads.law.damping), of(pads.rest)
        self.eps = {"left": of(pads.left_restitution), "right": of(pads.right_restitution)}
        self.small, self.by_contact = body.small, body.restraint == 0
        self.across = [of(float(one)) for one in across]
        self.up = [of(0)] * len(across) if up is None else [of(float(one)) for one in up]
        self.contact = dict.fromkeys(self.corners, TOUCHES)
        self.state = list(state)  # rotation, height, x, and their rates
        self.seen, self.kinds = [], []

    def turn(self, rotation):
        if self.small:
            return rotation, MP.mpf(1)
        return MP.sin(rotation), MP.cos(rotation)

    def place(self, name, state):
        """Return height, speed, and the lever of an upward force at a corner."""
        sine, cosine = self.turn(state[0])
        rise = self.tall * state[0] ** 2 / 2 if self.small else self.tall * (1 - cosine)
        lever = self.tall * sine - self.corners[name] * cosine
        return state[1] + rise - self.corners[name] * sine, state[4] + lever * state[3], lever

    def press(self, name, state):
        level, speed, _ = self.place(name, state)
        return self.k * (self.rest - level) - self.c * speed

    def holds(self):
        return [name for name, contact in self.contact.items() if contact == TOUCHES]

    def pin(self):
        held = self.holds()
        return self.corners[held[0]] if self.by_contact and len(held) == 1 else self.middle

    def sway(self, state):
        """Return the first and second derivative of the sway of the centre of mass."""
        if self.small:
            return self.tall, MP.mpf(0)
        sine, cosine = self.turn(state[0])
        e = self.pin()
        return self.tall * cosine + e * sine, e * cosine - self.tall * sine

    def rates(self, state, ground):
        moment, lift = MP.mpf(0), MP.mpf(0)
        for name in self.holds():
            force = self.press(name, state)
            lift += force
            moment += force * self.place(name, state)[2]
        vertical = lift - self.gravity - ground[1]
        if not self.holds():
            return [*state[3:], MP.mpf(0), vertical, -ground[0]]
        first, second = self.sway(state)
        # H = x'' + ground and I a'' = moment - x' H: two equations for a'' and H
        bent = second * state[3] ** 2
        push = (first * moment / self.inertia + bent + ground[0]) / (1 + first**2 / self.inertia)
        return [*state[3:], (moment - first * push) / self.inertia, vertical, push - ground[0]]

    def ground(self, k, time):
        share = time / MP.mpf(STEP)
        return [one[k] + (one[k + 1] - one[k]) * share for one in (self.across, self.up)]

    def moved(self, k, begin, length, columns=COLUMNS):
        """Extrapolate the midpoint rule (Gragg) to step length zero."""
        rows = []
        for column in range(1, columns + 1):
            n = 2 * column
            h = length / n
            old = self.state
            rate = self.rates(old, self.ground(k, begin))
            new = [a + h * b for a, b in zip(old, rate, strict=True)]
            for i in range(1, n):
                rate = self.rates(new, self.ground(k, begin + i * h))
                old, new = new, [a + 2 * h * b for a, b in zip(old, rate, strict=True)]
            rate = self.rates(new, self.ground(k, begin + length))
            row = [[(a + b + h * r) / 2 for a, b, r in zip(old, new, rate, strict=True)]]
            for j, coarser in enumerate(rows[-1] if rows else []):
                share = (MP.mpf(column) / (column - j - 1)) ** 2 - 1
                pairs = zip(row[-1], coarser, strict=True)
                row.append([a + (a - b) / share for a, b in pairs])
            rows.append(row)
        return rows[-1][-1]

    def guards(self, state):
        guards = {}
        for name, contact in self.contact.items():
            level, speed, _ = self.place(name, state)
            force = self.press(name, state)
            guards |= {
                TOUCHES: {(name, "force"): force},
                RELAXES: {(name, "level"): self.rest - level, (name, "slack"): -force},
                CLEAR: {(name, "gap"): level - self.rest},
                LEAVES: {
                    (name, "level"): self.rest - level, (name, "force"): force,
                    (name, "speed"): speed,
                },
            }[contact]  # fmt: skip
        return guards

    def run(self):
        for k in range(KNOTS):
            now, end, parts = MP.mpf(0), MP.mpf(STEP), 2
            new = set()
            while now < end:
                length = min(end / parts, end - now)
                state = self.moved(k, now, length)
                after = self.guards(state)
                fallen = [one for one, value in after.items() if value < 0 and one not in new]
                if not fallen:
                    self.state, now, new = state, now + length, set()
                    continue
                before = self.state
                first = min((self.root(k, now, length, one) for one in fallen), key=lambda x: x[0])
                self.state = before
                self.state = self.moved(k, now, first[0])
                now += first[0]
                new = self.switch(first[1], self.ground(k, now))
            self.seen.append((list(self.state), dict(self.contact)))
        return self

    def root(self, k, begin, length, guard):
        """Find where a guard falls to zero: bracketed at low precision, then by the secant rule."""

        def value(at, columns=COLUMNS):
            return self.guards(self.moved(k, begin, at, columns))[guard]

        low, high = MP.mpf(0), length
        if value(low) <= 0:  # it was zero at the start, and rose first
            low = length / 1024
        with mpmath.workdps(ROUGH_DIGITS):
            at = mpmath.findroot(
                lambda at: value(at, ROUGH_COLUMNS), (low, high), solver="anderson",
                tol=1e-16, maxsteps=60, verify=False,
            )  # fmt: skip
        offset = at + length * MP.mpf("1e-10")
        before, now = value(at), value(offset)
        while abs(offset - at) > length * MP.mpf("1e-40"):
            at, offset = offset, offset - now * (offset - at) / (now - before)
            before, now = now, value(offset)
        return offset, guard

    def switch(self, guard, ground):
        """Change the contact; return the guards that are now zero."""
        (name, kind), was, pin = guard, self.contact[guard[0]], self.pin()
        held, other = bool(self.holds()), "left" if guard[0] == "right" else "right"
        if held:
            self.state[5] = self.sway(self.state)[0] * self.state[3]
        self.kinds.append((was, kind))
        if (was, kind) in ((RELAXES, "level"), (LEAVES, "level")):
            self.contact[name] = CLEAR
            return {(name, "gap")}
        if (was, kind) == (LEAVES, "force"):
            self.contact[name] = RELAXES
            return {(name, "slack")}
        if was == TOUCHES:
            self.contact[name] = RELAXES
            if self.contact[other] == LEAVES:
                self.contact[other] = RELAXES
            if self.holds() and self.pin() != pin:
                self.hold()
                if self.press(name, self.state) > 0:
                    self.contact[name] = LEAVES
                return set()
            return {(name, "slack")}
        self.contact[name] = TOUCHES
        if self.contact[other] == LEAVES:
            self.contact[other] = RELAXES
        if not held or self.pin() != pin:
            self.hold()
        if was == CLEAR:
            self.strike(name)
        return set() if was == CLEAR or not held or self.pin() != pin else {(name, "force")}

    def hold(self):
        """Stop the slip of the held point by a horizontal impulse there."""
        first = self.sway(self.state)[0]
        slip = self.state[5] - first * self.state[3]
        impulse = -slip / (1 + first**2 / self.inertia)
        self.state[5] += impulse
        self.state[3] -= first * impulse / self.inertia

    def strike(self, name):
        """Reduce the speed of a corner by impulses of its pad and of the held point."""
        _, speed, lever = self.place(name, self.state)
        first = self.sway(self.state)[0]
        inertia = self.inertia + first**2
        impulse = -(1 - self.eps[name]) * speed / (1 + lever**2 / inertia)
        self.state[4] += impulse
        self.state[3] += impulse * lever / inertia


def initial_state(case):
    block, pads, restraint, rotation, across, up = CASES[case]
    system = rf.System(block, pads, restraint=restraint, rotation=rotation, gravity="9.81 m/s^2")
    vertical = None if up is None else (up, "m/s^2")
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", vertical=vertical)
    plan = plan_run(system.assembly, motion, initial=None, outputs=None, duration=None)
    mode, state, _ = system.assembly.model.initial(start_of(plan.initial))
    return system, plan.motion.si, mode, state, across, up


@cache
def exact(case, offset=NO_OFFSET):
    system, _, _, state, across, up = initial_state(case)
    with mpmath.workdps(DIGITS):
        start = [mpmath.mpf(float(a)) + mpmath.mpf(b) for a, b in zip(state, offset, strict=True)]
        return ExactRun(system, start, across, up).run()


def check_enclosures(case, prepare=None, offset=NO_OFFSET):
    """Follow a proof over the samples; count exact states outside its enclosures."""
    system, motion, mode, state, *_ = initial_state(case)
    seen = []
    with working_precision(BITS):
        prover = pad_prover(
            system.assembly.model.system, mode, state, motion, system.assembly.options.slope,
            system.assembly.setting.overturning_angles,
            callback=lambda k, contacts, box: seen.append(box),
        )  # fmt: skip
        if prepare is not None:
            prepare(prover)
        stopped = None
        try:
            while prover.k < KNOTS and prover.overturning_time is None:
                prover._to_next_knot()
        except Undecided as why:
            stopped = str(why)
        missed = 0
        for box, (place, contacts) in zip(seen, exact(case, offset).seen, strict=False):
            with mpmath.workdps(DIGITS):
                sway = place[5] if TOUCHES not in contacts.values() else mpmath.mpf(0)
                numbers = [place[0], place[3], place[1], place[4], sway]
                texts = [mpmath.nstr(value, 45) for value in numbers]
            with working_precision(200):
                near = ball(0, 1e-36)
                missed += not all(
                    a.overlaps(ball(text) + near) for a, text in zip(box, texts, strict=True)
                )
    return SimpleNamespace(
        missed=missed, seen=len(seen), prover=prover, stopped=stopped, last=seen[-1]
    )


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, marks=[pytest.mark.long] * (k != 1)) for k, case in enumerate(CASES)],
)
def test_enclosures_contain_fifty_digit_run(case):
    check = check_enclosures(case)
    assert check.stopped is None
    assert check.missed == 0
    assert check.seen == KNOTS or check.prover.overturning_time is not None
    assert max(float(one.rad()) for one in check.last) < 1e-15


@pytest.mark.long
def test_all_contacts_occur():
    kinds = {one for case in CASES for one in exact(case, NO_OFFSET).kinds}
    assert {(TOUCHES, "force"), (RELAXES, "level"), (CLEAR, "gap"), (LEAVES, "force")} <= kinds
    seen = [contacts for case in CASES for _, contacts in exact(case, NO_OFFSET).seen]
    assert any(TOUCHES not in contacts.values() for contacts in seen)


OFFSET = (2e-10, -1e-10, 0.0, 3e-10, 1e-9, 0.0)


def widen_start(prover):
    """Start from a box with the offset start at its corner."""
    radii = np.array([2e-10, 3e-10, 1e-10, 1e-9, 0.0])
    prover.states = prover.states._replace(spread=radii / prover.weights)


def test_box_enclosures_contain_run_from_its_corner():
    check = check_enclosures("skew, held by contact", widen_start, OFFSET)
    assert check.stopped is None
    assert check.missed == 0
    assert check.seen > KNOTS // 2
    assert max(float(one.rad()) for one in check.last) < 1e-3


JUMP = 16  # the sample at which the ground jumps


def states_after_jump(change):
    """Return the states after the ground jumps just after a landing."""
    lands = 0.25655462079917534  # from the proof for the centre
    system = rf.System(EVEN, FIRM, gravity="9.81 m/s^2")
    start = rf.InitialState(rotation="0.1 rad")
    still = rf.GroundMotion.from_arrays(([0.0, 0.0], "m/s^2"), "1 s")
    plan = plan_run(system.assembly, still, initial=start, outputs=None, duration=None)
    mode, state, _ = system.assembly.model.initial(start_of(plan.initial))
    pieces = np.zeros((JUMP + 2, 6))
    pieces[JUMP] = [-400.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    motion = Motion(Signal(lands * (1 + 1e-11) / JUMP, np.append(pieces[:, 0], 0.0), pieces))
    prover = pad_prover(
        system.assembly.model.system, mode, state, motion, system.assembly.options.slope,
        system.assembly.setting.overturning_angles,
    )  # fmt: skip
    change(prover)
    for _ in range(JUMP + 1):
        prover._to_next_knot()
    return prover.states.box(prover.weights)


def test_landings_on_both_sides_of_ground_jump_are_enclosed():
    radii = np.array([1e-10, 1e-10, 1e-10, 1e-10, 0.0])

    def widen(one):
        one.states = one.states._replace(spread=radii / one.weights)

    def move(signs, one):
        shifts = zip(one.states.centre, signs * radii, strict=True)
        one.states = one.states._replace(centre=[a + ball(float(b)) for a, b in shifts])

    with working_precision(BITS):
        box = states_after_jump(widen)
        for signs in ((1, 1, 1, 1, 0), (1, -1, 1, -1, 0), (-1, 1, -1, 1, 0), (-1, -1, -1, -1, 0)):
            state = states_after_jump(partial(move, np.array(signs)))
            assert all(a.overlaps(b) for a, b in zip(box, state, strict=True))


@pytest.mark.parametrize("restraint", ["centre", "contact-state"])
def test_possible_lift_off_before_landing_is_undecided(restraint):
    """The left corner lands within some 3e-6 s, in which the right pad may cease to press."""
    system = rf.System(EVEN, FIRM, restraint=restraint, gravity="9.81 m/s^2")
    still = rf.GroundMotion.from_arrays(([0.0, 0.0], "m/s^2"), "1 s").si
    model, options = system.assembly.model, system.assembly.options
    limits = system.assembly.setting.overturning_angles
    mode, state, _ = model.initial(start_of(rf.InitialState()))
    with working_precision(BITS):
        one = pad_prover(model.system, mode, state, still, options.slope, limits)
        one.contacts = law.Contacts(CLEARS, HOLDS)
        tall, wide = float(one.pads.height), float(one.pads.left)
        rotation, falls, sunk = 1e-4, -0.3, float(one.pads.rest)
        height = sunk - tall * (1 - np.cos(rotation)) - wide * np.sin(rotation)
        depth = 2 * wide * np.sin(rotation)
        rises = depth * float(one.pads.stiffness) / float(one.pads.damping)
        levers = (tall * np.sin(rotation) + side * wide * np.cos(rotation) for side in (1, -1))
        left, right = levers
        rate = (falls - rises) / (left - right)
        box = [rotation, rate, height, falls - left * rate, 0.0]
        box = [ball(value, 1e-6 * (k == 2)) for k, value in enumerate(box)]
        ground = one.ground.ground(0)
        with pytest.raises(Undecided, match="the contacts about a change"):
            one._enclose_change(ground, ball(0.1), box, law.Guard("gap", True), 1.0)


def short_series(prover):
    """Truncate the series so early that the remainder dominates."""
    prover.margin = -70
    prover._set_margin = lambda *_: None


def sign_of_the_ground(monkeypatch):
    old = prover.enclose_motion

    def course(pads, contacts, ground, *others):
        turned = ground._replace(along=[-one for one in ground.along])
        return old(pads, contacts, turned, *others)

    monkeypatch.setattr(prover, "enclose_motion", course)


def dropped_remainder(monkeypatch):
    old = prover.enclose_motion

    def course(*arguments):
        motion = old(*arguments)
        nothing = [0.0] * 7 + [(0.0, 0.0)] * 3 + [0.0] * 2
        return motion._replace(left_out=type(motion.left_out)(*nothing))

    monkeypatch.setattr(prover, "enclose_motion", course)


def missed_contact(monkeypatch):
    old = prover.PadProver._first_guard

    def first(self, made):
        guard, place = old(self, made)
        return (None, 2.0) if guard is not None and guard.kind == "press" else (guard, place)

    monkeypatch.setattr(prover.PadProver, "_first_guard", first)
    monkeypatch.setattr(prover, "_positive", lambda *_, **__: True)


def damping_off(monkeypatch):
    old = prover.PadProver.__init__

    def init(self, pads, *others, **named):
        old(self, pads._replace(damping=pads.damping * (1 + ball(1e-12))), *others, **named)

    monkeypatch.setattr(prover.PadProver, "__init__", init)


def rounded_inwards(monkeypatch):
    old = flow.StateSet.image

    def image(self, *arguments):
        return old(self, *arguments)._replace(spread=np.zeros(law.SIZE))

    monkeypatch.setattr(flow.StateSet, "image", image)


def restitution_off(monkeypatch):
    old = prover.PadProver.__init__

    def init(self, pads, *others, **named):
        both = tuple(one * (1 - ball(1e-12)) for one in pads.restitutions)
        old(self, pads._replace(restitutions=both), *others, **named)

    monkeypatch.setattr(prover.PadProver, "__init__", init)


FAULTS = {
    "sign of the ground": (sign_of_the_ground, None),
    "dropped remainder": (dropped_remainder, short_series),
    "missed contact": (missed_contact, None),
    "damping off by 1e-12": (damping_off, None),
    "rounded inwards": (rounded_inwards, None),
    "restitution off by 1e-12": (restitution_off, None),
}


@pytest.mark.parametrize("fault", list(FAULTS))
def test_a_planted_fault_is_caught(fault, monkeypatch):
    plant, prepare = FAULTS[fault]
    if prepare is not None:
        assert check_enclosures("held at the centre", prepare).missed == 0
    plant(monkeypatch)
    assert check_enclosures("held at the centre", prepare).missed > 0


def test_a_derivative_that_is_left_out_is_caught(monkeypatch):
    old = flow._variation

    def variation(matrix, error):
        powers, defect = old(matrix, error)
        powers[1:] = 0.0
        return powers, defect

    monkeypatch.setattr(flow, "_variation", variation)
    assert check_enclosures("skew, held by contact", widen_start, OFFSET).missed > 0
