"""A rope that hardens: a link with a user's own law, in one file.

Usage: python examples/own_link.py

A taut rope has the tension k e + h e^3. Prints the response of a block on pads with the rope and
without.
"""

from typing import NamedTuple

import rockframe as rf
from rockframe import extension as ext

SLACK, TAUT = 0, 1
BECAME_SLACK = int(ext.EventKind.RESTRAINER_SLACK)
BECAME_TAUT = int(ext.EventKind.RESTRAINER_TAUT)


@ext.link_law
class Hardening(NamedTuple):
    """A rope with the tension k e + h e^3, per unit mass."""

    stiffness: float
    hardening: float

    def force(self, state, stretch, own):
        e = stretch.elongation
        return (self.stiffness + self.hardening * e * e) * e if state == TAUT else 0.0

    def energy(self, state, stretch, own):
        square = stretch.elongation * stretch.elongation
        stored = 0.5 * self.stiffness * square + 0.25 * self.hardening * square * square
        return stored if state == TAUT else 0.0

    def states(self):
        return 2

    def starting(self, stretch, own):
        return TAUT if stretch.elongation >= 0.0 else SLACK

    def guard(self, which, state, stretch, own):
        if which == 1:
            return 1.0, 0.0
        if state == TAUT:
            return stretch.elongation, stretch.rate
        return -stretch.elongation, -stretch.rate

    def switch(self, which, state, stretch, own):
        if state == TAUT:
            return ext.LinkEvent(SLACK, BECAME_SLACK, 0.0)
        return ext.LinkEvent(TAUT, BECAME_TAUT, 0.0)

    def shown(self, state):
        return state


class Rope(ext.OwnLink):
    """A rope that hardens."""

    stiffness: ext.Parameter = ext.Parameter(
        ext.Measure("a stiffness", ext.Unit.NEWTON_PER_METRE, "2 MN/m"), ext.POSITIVE,
        doc="Stiffness where it becomes taut.",
    )  # fmt: skip
    reach: ext.Parameter = ext.Parameter(
        ext.Measure("a length", ext.Unit.METRE, "0.1 m"), ext.POSITIVE,
        doc="Elongation at which its force is twice that of a spring.",
    )  # fmt: skip

    def law(self, mass):
        """Return the law, per unit of a mass."""
        stiffness = self.si.stiffness / mass
        law = Hardening(stiffness, stiffness / self.si.reach**2)
        return ext.LinkNumbers(law, stiffness=13.0 * stiffness)


rf.register(Rope)


def main():
    """Simulate a block with the rope and without."""
    block = rf.Block(width="1 m", height="4 m", mass="4 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    rope = Rope(
        on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="50 kN/m", reach="0.1 m", name="rope"
    )
    pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    for name, parts in (("free", ()), ("with a rope", (rope,))):
        run = rf.System(block, pads, *parts).simulate(pulse, free_vibration="2 s")
        print(f"{name}: {run.attrs['verdict']}")
    print(f"force of the rope: at most {float(run.peak_restrainer_force[0]):.0f} N")


if __name__ == "__main__":
    main()
