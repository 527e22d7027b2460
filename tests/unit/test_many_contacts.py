"""A bed of single springs, with far more possible modes than a run reaches."""

from contextlib import contextmanager
from dataclasses import replace
from time import thread_time
from typing import NamedTuple

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe import extension as ext
from rockframe.dynamics.pads import CONTACTS
from rockframe.errors import AssemblyError
from rockframe.results.schema import SCHEMA
from rockframe.system import parts as parts_of

pytestmark = pytest.mark.unit

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.05)
CAP = rf.CushionCap(height="0.5 m", mass="4 t")
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0)
PULSE = rf.GroundMotion.sine_pulse(amplitude="-3 m/s^2", frequency="1 Hz")


class SpringNumbers(NamedTuple):
    """Springs in a row from one end to the other."""

    stiffness: float  # of one spring, per unit mass
    settlement: float
    count: int


class Springs(ext.Base, SpringNumbers):
    """A base in whose contact number each bit is a lifted spring."""

    __slots__ = ()

    def contacts(self):
        return 1 << self.count

    def end_guards(self):
        return self.count // 2

    def in_flight(self):
        return self.contacts() - 1

    def spring(self, left, which):
        """Return the number of a spring, counted from an end."""
        return which if left else self.count - 1 - which

    def along(self, i, left, right):
        """Interpolate linearly along the base at a spring."""
        return left + (right - left) * i / (self.count - 1)

    def pressed(self, i, line):
        return self.settlement - self.along(i, line.left, line.right)

    def is_held(self, contact, left):
        return not contact >> self.spring(left, 0) & 1

    def force(self, contact, line, own):
        upward = moment = 0.0
        for i in range(self.count):
            if not contact >> i & 1:
                force = self.stiffness * self.pressed(i, line)
                upward += force
                moment += force * self.along(i, line.left_lever, line.right_lever)
        return ext.BaseForce(upward, moment, 0.0)

    def energy(self, line, own):
        half = 0.5 * self.stiffness
        stored = half * sum(max(self.pressed(i, line), 0.0) ** 2 for i in range(self.count))
        return stored, stored - half * self.count * self.settlement**2

    def guards_of(self, contact, left, line, own):
        values, rates = [], []
        for which in range(self.count // 2):
            i = self.spring(left, which)
            sign = (-1.0 if contact >> i & 1 else 1.0) / self.settlement
            values.append(sign * self.pressed(i, line))
            rates.append(-sign * self.along(i, line.left_speed, line.right_speed))
        return ext.Guards(tuple(values), tuple(rates))

    def switch(self, contact, left, which, line, own):
        new = contact ^ 1 << self.spring(left, which)
        if which > 0:
            return ext.EndEvent(new, ext.SILENT, False)
        lands = self.is_held(new, left)
        kind = ext.EventKind.REENGAGEMENT if lands else ext.EventKind.SEPARATION
        return ext.EndEvent(new, int(kind), True)

    def level(self, left, line, own):
        return self.pressed(self.spring(left, 0), line)

    def starting(self, line, own):
        return sum((self.pressed(i, line) <= 0.0) << i for i in range(self.count))

    def resting_height(self, left, right, own):
        return -0.5 * (left + right)

    def observed(self, contact, line, own):
        bearing = self.count - contact.bit_count()
        toe = self.stiffness * max(self.pressed(0, line), self.pressed(self.count - 1, line))
        return self.force(contact, line, own).upward, float(bearing), toe


class SpringSupport(ext.BedSupport):
    """Springs with the total stiffness of a bed."""

    count = 0

    def law(self, body, mass, load_mass):
        bed = super().law(body, mass, load_mass)
        one = bed.vertical_stiffness / self.count
        middle = 0.5 * (self.count - 1)
        half = 0.5 * (body.left + body.right)
        places = half * (np.arange(self.count) - middle) / middle
        return replace(
            bed,
            law=Springs(one, bed.settlement, self.count),
            rotational_stiffness=one * float(np.sum(places**2)),
            end_tolerance=np.full(self.count // 2, 1e-13),
        )


@contextmanager
def springs(count):
    """Yield soil of so many springs, registered during the context."""
    support = type("Some", (SpringSupport,), {"count": count})

    class SpringBed(ext.OwnBase):
        """A row of springs."""

        slot = "soil"

        def support(self, load):
            bed = ext.bed_under(SOIL, load)
            return support(load, bed.stiffness, bed.damping, bed.separation)

    rows, kinds = dict(SCHEMA), dict(parts_of._KINDS)
    try:
        rf.register(SpringBed)
        yield SpringBed()
    finally:
        for table, was in ((SCHEMA, rows), (parts_of._KINDS, kinds)):
            table.clear()
            table.update(was)


@pytest.mark.parametrize(
    ("count", "coupling"),
    [
        (6, "cascade"),
        (10, "coupled"),
        pytest.param(6, "coupled", marks=pytest.mark.long),
        pytest.param(8, "coupled", marks=pytest.mark.long),
        pytest.param(8, "cascade", marks=pytest.mark.long),
        pytest.param(10, "cascade", marks=pytest.mark.long),
    ],
)
def test_a_scene_is_built_whatever_the_number_of_modes(count, coupling):
    with springs(count) as soil, plain_python():
        system = rf.System(BLOCK, PADS, CAP, soil, coupling=coupling)
        began = thread_time()  # of this thread, since others share the processor
        model = system.setting.compile()
        assert thread_time() - began < 0.05
        assert model.system.modes() == 8 * CONTACTS * 8 * 2**count
        response = system.simulate(PULSE, duration="0.6 s", outputs="energy")
    assert float(response.energy_residual) < 1e-6
    assert len(np.unique(response.soil_contact_state)) > 1


@pytest.mark.parametrize(("count", "parts"), [(62, ()), (54, (PADS, CAP))])
def test_more_modes_than_can_be_numbered_are_refused(count, parts):
    with springs(count) as soil, pytest.raises(AssemblyError, match="contacts of its bases"):
        rf.System(BLOCK, *parts, soil)
    with springs(count - 10) as soil:
        rf.System(BLOCK, *parts, soil)
