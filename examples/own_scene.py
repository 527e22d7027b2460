"""A block that slides and rocks: a scene of one's own, with its own equations, in one file.

Usage: python examples/own_scene.py [--folder results]

The block stands on rigid ground with Coulomb friction: it rests, slides on its whole base, rocks
about a corner that friction holds, or slides on that corner while it rocks. Prints what becomes of
it with little, some and much friction; writes own_scene.nc.
"""

import argparse
import math
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np
import xarray as xr

import rockframe as rf
from rockframe import extension as ext

FULL, RIGHT, LEFT = 0, 1, 2  # what bears: a mode is 3 * this + the slip
HELD, TO_RIGHT, TO_LEFT = 0, 1, 2  # the slip of what bears
TO_IMPACT, TO_STICK, ON_RIGHT, ON_LEFT, SLIP_RIGHT, SLIP_LEFT = range(6)  # guards
GUARDS = 6
ROUNDING = 1e-12  # of accelerations, over gravity
INSTANT = 1e-10  # rotation, over that which overturns, that a rebound must reach


class Motion(NamedTuple):
    """Accelerations, and force of the ground on the block."""

    slip: float
    rotation: float
    along: float
    normal: float


class SlideRock(NamedTuple):
    """A block on rigid ground with friction, per unit mass: the slip of its base, and its rotation.

    About the left corner everything is the mirror image of that about the right one.
    """

    half_width: float
    height: float  # of the centre of mass
    inertia: float  # about the centre of mass
    static: float  # coefficients of friction
    kinetic: float
    gravity: float

    @ext.kernel
    def bodies(self):
        return 1

    @ext.kernel
    def coordinates(self):
        return 2

    @ext.kernel
    def variables(self):
        return 0

    @ext.kernel
    def guards(self):
        return GUARDS

    @ext.kernel
    def modes(self):
        return 9

    @ext.inlined
    def moving_in(self, mode):
        """Return how many of slip and rotation change, the slip first."""
        return 0 if mode == 0 else 1 if mode // 3 == FULL else 2

    @ext.inlined
    def contact_state_of(self, mode, k):
        if mode // 3 == FULL:
            return BEARS_FULL
        return BEARS_RIGHT if mode // 3 == RIGHT else BEARS_LEFT

    @ext.inlined
    def relaxation_in(self, mode):
        return 0.0

    @ext.inlined
    def mirror(self, mode):
        return -1.0 if mode // 3 == LEFT else 1.0

    @ext.inlined
    def sense(self, mode):
        """Return the sign of the slip, 0 where friction holds."""
        return 0.0 if mode % 3 == HELD else 1.0 if mode % 3 == TO_RIGHT else -1.0

    @ext.inlined
    def reach(self, mode, rotation):
        """Return the place of the centre of mass beside the bearing corner, and above it."""
        sine, cosine = math.sin(rotation), math.cos(rotation)
        side = self.mirror(mode)
        beside = self.height * sine - side * self.half_width * cosine
        return beside, self.height * cosine + side * self.half_width * sine

    @ext.inlined
    def motion(self, mode, state, ground):
        """Return the motion in a mode."""
        weight, sense = self.gravity + ground.y, self.sense(mode)
        if mode // 3 == FULL:
            along = ground.x if sense == 0.0 else -sense * self.kinetic * weight
            return Motion(along - ground.x, 0.0, along, weight)
        beside, above = self.reach(mode, state[1])
        square = state[3] * state[3]
        pressing = weight - above * square
        if sense == 0.0:
            inertia = self.inertia + beside * beside + above * above
            turning = (weight * beside - ground.x * above) / inertia
            along = ground.x + above * turning - beside * square
            return Motion(0.0, turning, along, pressing - beside * turning)
        arm = beside + sense * self.kinetic * above
        turning = pressing * arm / (self.inertia + beside * arm)
        normal = pressing - beside * turning
        along = -sense * self.kinetic * normal
        return Motion(along - ground.x - above * turning + beside * square, turning, along, normal)

    @ext.inlined
    def speeds(self, mode, state):
        """Return the velocity of the centre of mass relative to the ground."""
        beside, above = self.reach(mode, state[1])
        return state[2] + above * state[3], -beside * state[3]

    @ext.inlined
    def accelerate(self, mode, state, ground):
        """Return accelerations, what friction dissipates, and what the ground puts in."""
        if mode == 0:
            return 0.0, 0.0, 0.0, 0.0
        moved = self.motion(mode, state, ground)
        across, up = self.speeds(mode, state)
        supplied = -ground.x * across - ground.y * up
        return moved.slip, moved.rotation, -moved.along * state[2], supplied

    @ext.inlined
    def guards_in(self, mode, state, slope, ground):
        """Guard the rotation's sign, the slip's, and at rest and where it sticks the forces."""
        scale = 1.0 / self.gravity
        landing = falling = stopping = slowing = 1.0
        right = left = to_right = to_left = 1.0
        sense, side = self.sense(mode), self.mirror(mode)
        if mode // 3 != FULL:
            landing, falling = side * state[1], side * state[3]
        if sense != 0.0:
            # a slip that starts is not stopped by rounding
            stopping, slowing = sense * state[2], sense * slope[0] + ROUNDING * self.gravity
        else:
            moved = self.motion(mode, state, ground)
            most = self.static * moved.normal
            to_right, to_left = scale * (most + moved.along), scale * (most - moved.along)
            if mode // 3 == FULL:
                tips = self.half_width / self.height * moved.normal
                right, left = scale * (tips + ground.x), scale * (tips - ground.x)
        values = landing, stopping, right, left, to_right, to_left
        return ext.Guards(values, (falling, slowing, 0.0, 0.0, 0.0, 0.0))

    @ext.kernel
    def some_end_slides(self, mode):
        return False  # ends of springs, of which there are none

    @ext.inlined
    def without_sliding(self, mode):
        return mode

    @ext.kernel
    def switch(self, mode, guard, state, ground, memory):
        memory[ext.LAST_EVENT] = ext.SILENT
        if guard == TO_IMPACT:
            return self.land(mode, state, ground, memory)
        bears = mode // 3
        if guard in (ON_RIGHT, ON_LEFT):
            memory[ext.LAST_EVENT] = UPLIFT
            return 3 * (RIGHT if guard == ON_RIGHT else LEFT)
        if guard in (SLIP_RIGHT, SLIP_LEFT):
            slips = 3 * bears + (TO_RIGHT if guard == SLIP_RIGHT else TO_LEFT)
            # found too early, it would stick again
            starts = self.sense(slips) * self.motion(slips, state, ground).slip
            return slips if starts > -ROUNDING * self.gravity else mode
        state[2] = 0.0
        held = self.motion(3 * bears, state, ground)
        if abs(held.along) <= self.static * held.normal:
            memory[ext.LAST_EVENT] = HELD_AGAIN
            return 3 * bears
        return 3 * bears + (TO_LEFT if held.along > 0.0 else TO_RIGHT)

    @ext.kernel
    def land(self, mode, state, ground, memory):
        """Strike the other corner: friction holds it if its impulse can, else it slips."""
        side, before, slip = self.mirror(mode), state[3], state[2]
        wide, high, friction = side * self.half_width, self.height, self.kinetic
        across, up = self.speeds(mode, state)
        lost = 0.5 * (across * across + up * up + self.inertia * before * before)
        square = wide * wide + high * high
        # as if it were held: rate of the rotation, impulses along and normal to the ground
        after = (self.inertia + square - 2.0 * wide * wide) * before + high * slip
        after /= self.inertia + square
        normal = -wide * (after + before)
        along = high * (after - before) - slip
        left_over = 0.0
        if abs(along) > friction * normal:
            ratio = friction if along > 0.0 else -friction
            arm = wide * (wide - ratio * high)
            after = before * (self.inertia - arm) / (self.inertia + arm)
            along = -ratio * wide * (after + before)
            left_over = slip + along - high * (after - before)
        state[1] = 0.0
        bears = LEFT if mode // 3 == RIGHT else RIGHT
        memory[ext.LAST_EVENT] = IMPACT
        if side * after >= 0.0:  # so wide that it lands flat
            bears, after = FULL, 0.0
            most = friction * wide * abs(before)
            sliding = slip + high * before
            left_over = 0.0 if abs(sliding) <= most else sliding - math.copysign(most, sliding)
        slides = HELD if left_over == 0.0 else TO_RIGHT if left_over > 0.0 else TO_LEFT
        state[2], state[3] = left_over, after
        if self.comes_to_rest(mode, 3 * bears + slides, state, ground):
            bears, state[3] = FULL, 0.0
            memory[ext.LAST_EVENT] = REST
        new = 3 * bears + slides
        across, up = self.speeds(new, state)
        lost -= 0.5 * (across * across + up * up + self.inertia * state[3] * state[3])
        memory[ext.IMPACT_LOSS] += lost
        return new

    @ext.kernel
    def comes_to_rest(self, old, new, state, ground):
        """Whether a rebound is too low to be told, and the block can stand on its whole base."""
        if new // 3 == FULL or (new % 3 != HELD and self.kinetic * self.height > self.half_width):
            return False
        restoring = -self.mirror(new) * self.motion(new, state, ground).rotation
        held = self.mirror(old) * self.motion(3 * (old // 3), state, ground).rotation <= 0.0
        most = INSTANT * math.atan2(self.half_width, self.height)
        return held and restoring > 0.0 and state[3] * state[3] < 2.0 * restoring * most

    @ext.kernel
    def rise(self, mode, rotation):
        """Return the rise of the centre of mass, to all digits."""
        half = math.sin(0.5 * rotation)
        side = self.mirror(mode)
        return side * self.half_width * math.sin(rotation) - 2.0 * self.height * half * half

    @ext.kernel
    def energies(self, mode, state):
        across, up = self.speeds(mode, state)
        kinetic = 0.5 * (across * across + up * up + self.inertia * state[3] * state[3])
        return ext.Energies(kinetic, self.gravity * self.rise(mode, state[1]), 0.0, 0.0)

    @ext.kernel
    def observe(self, mode, state, slope, ground, memory):
        """Return the motion of the centre of mass, the reactions, and the slip."""
        moved = self.motion(mode, state, ground)
        beside, _ = self.reach(mode, state[1])
        across, up = self.speeds(mode, state)
        place = state[0] + self.mirror(mode) * self.half_width + beside
        if mode // 3 == FULL:
            place = state[0]
        sway = moved.along - ground.x
        rise = moved.normal - self.gravity - ground.y
        tilt = self.height / self.half_width * moved.along
        left, right = 0.5 * (moved.normal + tilt), 0.5 * (moved.normal - tilt)
        if mode // 3 != FULL:
            bears = mode // 3 == RIGHT
            left, right = (0.0, moved.normal) if bears else (moved.normal, 0.0)
        lift, shear = self.rise(mode, state[1]), moved.along
        body = state[1], state[3], lift, up, place, shear, across, moved.rotation, sway, rise
        return body + (shear, moved.normal, left, right, state[0], state[2])


BEARS_FULL, BEARS_LEFT, BEARS_RIGHT = (int(state) for state in (
    ext.ContactState.FULL, ext.ContactState.LEFT, ext.ContactState.RIGHT))  # fmt: skip
UPLIFT, IMPACT, REST, HELD_AGAIN = (int(kind) for kind in (
    ext.EventKind.UPLIFT, ext.EventKind.IMPACT, ext.EventKind.REST,
    ext.EventKind.PIVOT_CHANGE))  # fmt: skip


class SlidingGround(ext.Component):
    """Rigid ground with Coulomb friction."""

    noun = "ground"
    friction = ext.Ratio(ext.POSITIVE, doc="Coefficient of friction at rest.")
    kinetic_friction = ext.Ratio(ext.POSITIVE, doc="While it slides; as at rest.", default=None)


class SlidingScene(ext.OwnScene):
    """A block that slides and rocks on rigid ground."""

    made_of: ClassVar = {"block": rf.Block, "sliding_ground": SlidingGround}
    slides = True  # friction is in the equations
    flies = False  # a run warns where the ground would have to pull

    @property
    def model(self):
        return "slide-rock"

    @property
    def frictions(self):
        given = self.parts["sliding_ground"].si
        kinetic = given.kinetic_friction
        return given.friction, given.friction if kinetic is None else kinetic

    def misfits(self):
        static, kinetic = self.frictions
        faults = ["the kinetic friction is above that at rest"] if kinetic > static else []
        if self.leans or self.options.small:
            faults.append("slide-rock needs a symmetric block on level ground, with rotation="
                          "'finite'")  # fmt: skip
        return faults

    def contact_model(self):
        body, gravity = self.body, self.gravity
        frequency = math.sqrt(gravity * body.radius / body.gyration_square_about(body.half_width))
        size = np.array([body.half_width, self.overturning_angle])

        def initial(start):
            rotation, rate = start.rotation or 0.0, start.angular_velocity
            leans = rotation or rate
            bears = FULL if leans == 0.0 else RIGHT if leans > 0.0 else LEFT
            return 3 * bears, np.array([0.0, rotation, 0.0, rate]), np.zeros(len(ext.MEMORY))

        return ext.ContactModel(
            name=self.model,
            system=SlideRock(body.half_width, body.centre_height, body.inertia / body.mass,
                             *self.frictions, gravity),
            rotation_limits=self.overturning_angles,
            rotation_weights=np.array([0.0, 1.0]),
            scales=np.concatenate([size, frequency * size]),
            guard_tolerance=np.array([1e-15, 1e-15, *(1e-14,) * 4]),
            columns=(*ext.BODY_COLUMNS, ext.Column("left_reaction", per_mass=True),
                     ext.Column("right_reaction", per_mass=True), ext.Column("slip"),
                     ext.Column("slip_velocity")),
            mass=body.mass,
            fastest_frequency=frequency,
            damping_rate=0.0,
            energy_scale=gravity * body.radius * self.overturning_angle,
            initial=initial,
        )  # fmt: skip

    def words(self):
        slides, rocks = "the base slides: x'' = -xg'' - s mu (g + yg'')", "I a'' = N (l + s mu x')"
        return ext.Words(
            equations=[
                ("full", "at rest while |xg''| <= (g + yg'') min(mu at rest, b/h)"),
                ("full", f"{slides}, s the sign of the slip"),
                ("left, right", "the corner is held: Housner's equation"),
                ("left, right", f"the corner slides: {rocks}, N the force of the ground"),
                ("impact", "of the corner that strikes, held or sliding, by its friction"),
            ],
            restraint="friction (the restraint options make no difference)",
            numbers=[("friction at rest, and of slip", "{:.6g}, {:.6g}".format(*self.frictions))],
            left_out=["elasticity of block and ground", "flight", "jamming of a corner that slips"],
        )

    def answers(self, histories, before, after):
        return {"event_slip": after["slip"], "residual_slip": histories["slip"][-1]}


rf.register(SlidingScene, columns=[
    ext.Variable("slip", ext.TIME, ext.Unit.METRE, "slip of the base, to the right"),
    ext.Variable("slip_velocity", ext.TIME, ext.Unit.METRE_PER_SECOND, "rate of the slip"),
    ext.Variable("event_slip", ext.EVENT, ext.Unit.METRE, "slip of the base at the event"),
    ext.Variable("residual_slip", (), ext.Unit.METRE, "slip of the base at the end of the run"),
])  # fmt: skip


def edge_height(state):
    """Height of the higher corner of the base of a block of 1 m."""
    return np.sin(np.abs(state["rotation"]))


rf.register(edge_height, unit="m")


def main() -> None:
    """Simulate a block with little, some and much friction."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    file = Path(parser.parse_args().folder) / "own_scene.nc"
    block = rf.Block(width="1 m", height="4 m", mass="10 t")
    pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    print(rf.System(block, SlidingGround(friction=0.26)).describe(), end="\n\n")
    for friction in 0.2, 0.26, 1.0:
        system = rf.System(block, SlidingGround(friction=friction))
        response = system.simulate(pulse, free_vibration="3 s", outputs=["energy", "edge_height"])
        print(f"Friction {friction}: {response.attrs['verdict']}")
        print(f"  slip left {1e3 * float(response.residual_slip):.1f} mm, edge lifted by "
              f"{1e3 * float(response.peak_edge_height):.1f} mm")  # fmt: skip
    response.to_netcdf(file)
    with xr.open_dataset(file) as read:
        print("Read back the same:", rf.System.from_dataset(read).parts["sliding_ground"]
              == system.parts["sliding_ground"])  # fmt: skip
    runs = rf.sweep(system, pulse, friction=[0.2, 0.26, 1.0], free_vibration="3 s")
    print("Peak rotations:", runs.peak_rotation.values.round(4))


if __name__ == "__main__":
    main()
