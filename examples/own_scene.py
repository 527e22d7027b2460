"""A block that slides and rocks: a user's own scene, with its own equations, in one file.

Usage: python examples/own_scene.py [--folder results]

The block stands on rigid ground with Coulomb friction: it rests, slides on its whole base, rocks
about a corner that sticks, or slides on that corner while it rocks. Prints the response with
little, some and much friction; writes own_scene.nc.
"""

import argparse
import math
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np
import xarray as xr

import rockframe as rf
from rockframe import extension as ext

FULL, RIGHT, LEFT = 0, 1, 2  # contact: the whole base or a corner; mode = 3 * contact + slip
NO_SLIP, TO_RIGHT, TO_LEFT = 0, 1, 2  # slip of the contact
TO_IMPACT, TO_STICK, UPLIFT_RIGHT, UPLIFT_LEFT, SLIP_RIGHT, SLIP_LEFT = range(6)  # guards
GUARD_COUNT = 6
ROUNDING = 1e-12  # of accelerations, over gravity
LEAST_REBOUND = 1e-10  # rotation of the smallest rebound, over the overturning angle


class Accelerations(NamedTuple):
    """Accelerations of slip and rotation, and the force of the ground on the block."""

    slip: float
    rotation: float
    tangential: float
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
        return GUARD_COUNT

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
            return CONTACT_FULL
        return CONTACT_RIGHT if mode // 3 == RIGHT else CONTACT_LEFT

    @ext.inlined
    def relaxation_in(self, mode):
        return 0.0

    @ext.inlined
    def corner_sign(self, mode):
        return -1.0 if mode // 3 == LEFT else 1.0

    @ext.inlined
    def slip_sign(self, mode):
        """Return the sign of the slip, 0 without slip."""
        return 0.0 if mode % 3 == NO_SLIP else 1.0 if mode % 3 == TO_RIGHT else -1.0

    @ext.inlined
    def centre_from_corner(self, mode, rotation):
        """Return the centre of mass relative to the corner in contact, to the right and above."""
        sine, cosine = math.sin(rotation), math.cos(rotation)
        side = self.corner_sign(mode)
        beside = self.height * sine - side * self.half_width * cosine
        return beside, self.height * cosine + side * self.half_width * sine

    @ext.inlined
    def accelerations(self, mode, state, ground):
        """Return accelerations and forces in a mode."""
        weight, sign = self.gravity + ground.y, self.slip_sign(mode)
        if mode // 3 == FULL:
            tangential = ground.x if sign == 0.0 else -sign * self.kinetic * weight
            return Accelerations(tangential - ground.x, 0.0, tangential, weight)
        beside, above = self.centre_from_corner(mode, state[1])
        square = state[3] * state[3]
        pressing = weight - above * square
        if sign == 0.0:
            inertia = self.inertia + beside * beside + above * above
            angular = (weight * beside - ground.x * above) / inertia
            tangential = ground.x + above * angular - beside * square
            return Accelerations(0.0, angular, tangential, pressing - beside * angular)
        arm = beside + sign * self.kinetic * above
        angular = pressing * arm / (self.inertia + beside * arm)
        normal = pressing - beside * angular
        tangential = -sign * self.kinetic * normal
        slip = tangential - ground.x - above * angular + beside * square
        return Accelerations(slip, angular, tangential, normal)

    @ext.inlined
    def centre_velocity(self, mode, state):
        """Return the velocity of the centre of mass relative to the ground."""
        beside, above = self.centre_from_corner(mode, state[1])
        return state[2] + above * state[3], -beside * state[3]

    @ext.inlined
    def accelerate(self, mode, state, ground):
        """Return accelerations, the power dissipated by friction, and that of the ground."""
        if mode == 0:
            return 0.0, 0.0, 0.0, 0.0
        motion = self.accelerations(mode, state, ground)
        across, up = self.centre_velocity(mode, state)
        supplied = -ground.x * across - ground.y * up
        return motion.slip, motion.rotation, -motion.tangential * state[2], supplied

    @ext.inlined
    def guards_in(self, mode, state, slope, ground):
        """Guard the signs of rotation and slip; without slip also the forces."""
        scale = 1.0 / self.gravity
        gap = gap_rate = slip_speed = slip_rate = 1.0
        right = left = to_right = to_left = 1.0
        sign, side = self.slip_sign(mode), self.corner_sign(mode)
        if mode // 3 != FULL:
            gap, gap_rate = side * state[1], side * state[3]
        if sign != 0.0:
            # rounding must not stop a slip that has just started
            slip_speed, slip_rate = sign * state[2], sign * slope[0] + ROUNDING * self.gravity
        else:
            motion = self.accelerations(mode, state, ground)
            most = self.static * motion.normal
            to_right = scale * (most + motion.tangential)
            to_left = scale * (most - motion.tangential)
            if mode // 3 == FULL:
                tipping_force = self.half_width / self.height * motion.normal
                right, left = scale * (tipping_force + ground.x), scale * (tipping_force - ground.x)
        values = gap, slip_speed, right, left, to_right, to_left
        return ext.Guards(values, (gap_rate, slip_rate, 0.0, 0.0, 0.0, 0.0))

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
            return self.impact(mode, state, ground, memory)
        contact = mode // 3
        if guard in (UPLIFT_RIGHT, UPLIFT_LEFT):
            memory[ext.LAST_EVENT] = UPLIFT
            return 3 * (RIGHT if guard == UPLIFT_RIGHT else LEFT)
        if guard in (SLIP_RIGHT, SLIP_LEFT):
            slipping = 3 * contact + (TO_RIGHT if guard == SLIP_RIGHT else TO_LEFT)
            # located too early, it would stick again
            slip_rate = self.slip_sign(slipping) * self.accelerations(slipping, state, ground).slip
            return slipping if slip_rate > -ROUNDING * self.gravity else mode
        state[2] = 0.0
        sticking = self.accelerations(3 * contact, state, ground)
        if abs(sticking.tangential) <= self.static * sticking.normal:
            memory[ext.LAST_EVENT] = STICK
            return 3 * contact
        return 3 * contact + (TO_LEFT if sticking.tangential > 0.0 else TO_RIGHT)

    @ext.kernel
    def impact(self, mode, state, ground, memory):
        """Impact of the other corner, which sticks if friction can hold its impulse, else slips."""
        side, before, slip = self.corner_sign(mode), state[3], state[2]
        b, h, friction = side * self.half_width, self.height, self.kinetic
        across, up = self.centre_velocity(mode, state)
        energy_loss = 0.5 * (across * across + up * up + self.inertia * before * before)
        square = b * b + h * h
        # if the corner sticks: angular velocity, and impulses along and normal to the ground
        after = (self.inertia + square - 2.0 * b * b) * before + h * slip
        after /= self.inertia + square
        normal = -b * (after + before)
        tangential = h * (after - before) - slip
        slip_after = 0.0
        if abs(tangential) > friction * normal:
            ratio = friction if tangential > 0.0 else -friction
            arm = b * (b - ratio * h)
            after = before * (self.inertia - arm) / (self.inertia + arm)
            tangential = -ratio * b * (after + before)
            slip_after = slip + tangential - h * (after - before)
        state[1] = 0.0
        contact = LEFT if mode // 3 == RIGHT else RIGHT
        memory[ext.LAST_EVENT] = IMPACT
        if side * after >= 0.0:  # a wide block lands flat
            contact, after = FULL, 0.0
            most = friction * b * abs(before)
            sliding = slip + h * before
            slip_after = 0.0 if abs(sliding) <= most else sliding - math.copysign(most, sliding)
        slip_state = NO_SLIP if slip_after == 0.0 else TO_RIGHT if slip_after > 0.0 else TO_LEFT
        state[2], state[3] = slip_after, after
        if self.comes_to_rest(mode, 3 * contact + slip_state, state, ground):
            contact, state[3] = FULL, 0.0
            memory[ext.LAST_EVENT] = REST
        new_mode = 3 * contact + slip_state
        across, up = self.centre_velocity(new_mode, state)
        energy_loss -= 0.5 * (across * across + up * up + self.inertia * state[3] * state[3])
        memory[ext.IMPACT_LOSS] += energy_loss
        return new_mode

    @ext.kernel
    def comes_to_rest(self, old, new, state, ground):
        """Whether a rebound is negligible, and the block can rest on its whole base."""
        slips = new % 3 != NO_SLIP
        if new // 3 == FULL or (slips and self.kinetic * self.height > self.half_width):
            return False
        restoring = -self.corner_sign(new) * self.accelerations(new, state, ground).rotation
        before = self.accelerations(3 * (old // 3), state, ground).rotation
        pressed = self.corner_sign(old) * before <= 0.0
        least = LEAST_REBOUND * math.atan2(self.half_width, self.height)
        return pressed and restoring > 0.0 and state[3] * state[3] < 2.0 * restoring * least

    @ext.kernel
    def rise(self, mode, rotation):
        """Return the rise of the centre of mass without cancellation."""
        half = math.sin(0.5 * rotation)
        side = self.corner_sign(mode)
        return side * self.half_width * math.sin(rotation) - 2.0 * self.height * half * half

    @ext.kernel
    def energies(self, mode, state):
        across, up = self.centre_velocity(mode, state)
        kinetic = 0.5 * (across * across + up * up + self.inertia * state[3] * state[3])
        return ext.Energies(kinetic, self.gravity * self.rise(mode, state[1]), 0.0, 0.0)

    @ext.kernel
    def observe(self, mode, state, slope, ground, memory):
        """Return the motion of the centre of mass, the reactions, and the slip."""
        motion = self.accelerations(mode, state, ground)
        beside, _ = self.centre_from_corner(mode, state[1])
        across, up = self.centre_velocity(mode, state)
        place = state[0] + self.corner_sign(mode) * self.half_width + beside
        if mode // 3 == FULL:
            place = state[0]
        horizontal = motion.tangential - ground.x
        vertical = motion.normal - self.gravity - ground.y
        difference = self.height / self.half_width * motion.tangential
        left, right = 0.5 * (motion.normal + difference), 0.5 * (motion.normal - difference)
        if mode // 3 != FULL:
            on_right = mode // 3 == RIGHT
            left, right = (0.0, motion.normal) if on_right else (motion.normal, 0.0)
        rise, shear = self.rise(mode, state[1]), motion.tangential
        body = (
            state[1], state[3], rise, up, place, shear, across,
            motion.rotation, horizontal, vertical,
        )  # fmt: skip
        return body + (shear, motion.normal, left, right, state[0], state[2])


CONTACT_FULL, CONTACT_LEFT, CONTACT_RIGHT = (int(state) for state in (
    ext.ContactState.FULL, ext.ContactState.LEFT, ext.ContactState.RIGHT))  # fmt: skip
UPLIFT, IMPACT, REST, STICK = (int(kind) for kind in (
    ext.EventKind.UPLIFT, ext.EventKind.IMPACT, ext.EventKind.REST,
    ext.EventKind.PIVOT_CHANGE))  # fmt: skip


class SlidingGround(ext.Component):
    """Rigid ground with Coulomb friction."""

    noun = "ground"
    friction: ext.Ratio = ext.Ratio(ext.POSITIVE, doc="Coefficient of friction at rest.")
    kinetic_friction: ext.Ratio[None] = ext.Ratio(
        ext.POSITIVE, doc="While it slides; as at rest.", default=None
    )


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
            disturbed = rotation or rate
            contact = FULL if disturbed == 0.0 else RIGHT if disturbed > 0.0 else LEFT
            return 3 * contact, np.array([0.0, rotation, 0.0, rate]), np.zeros(len(ext.MEMORY))

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
