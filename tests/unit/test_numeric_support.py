"""Rest and held rotations found from a law alone are those of the closed forms."""

import math
from dataclasses import dataclass, replace
from itertools import product

import pytest

import rockframe as rf
from rockframe.system.numeric_support import NumericSupport
from rockframe.system.options import Restraint
from rockframe.system.statics import sine_cosine_rise
from rockframe.system.support import Support

AGREEMENT = 1e-9
BLOCK = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
SQUAT = rf.Block(width="4 m", height="3 m", mass="20 t")
BASES = {
    "pads": rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
    "soft pads": rf.TwoSpringSupport(frequency_ratio=9, damping_ratio=0.3),
    "bed": rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1),
    "bed by pressure": rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1, separation="pressure"),
    "soft bed": rf.WinklerSoil(stiffness="4 MPa", damping_ratio=0.2),
}


@dataclass(frozen=True)
class ByNumbers(NumericSupport):
    """A base of which only the law is used."""

    closed: Support
    model = "by numbers"

    def law(self, body, mass, load_mass):
        return self.closed.law(body, mass, load_mass)

    def words(self):
        return self.closed.words()


class OnSoilByNumbers(ByNumbers):
    """The same, of soil."""

    settlement_name = "soil_settlement"


def supports(base, block=BLOCK, **options):
    """Give a base by its closed forms, and by numbers."""
    closed = rf.System(block, BASES[base], **options).setting.support
    kind = OnSoilByNumbers if "bed" in base else ByNumbers
    return closed, kind(closed.load, closed)


def held(support, rotation, share=1.0):
    """Hold a body at a rotation under a share of its weight."""
    load = support.load
    rule = load.options.rotation
    sine, cosine, _ = sine_cosine_rise(load.body.centre_height, rule, rotation)
    return support.held(sine, cosine, share * load.weight)


@pytest.mark.parametrize(("base", "rotation"), list(product(BASES, ("finite", "small"))))
def test_rest_and_uplift(base, rotation):
    closed, numeric = supports(base, rotation=rotation)
    assert numeric.settlement == pytest.approx(closed.settlement, rel=AGREEMENT)
    assert closed.uplift_angle > 0.0
    assert numeric.uplift_angle == pytest.approx(closed.uplift_angle, rel=AGREEMENT)
    assert numeric.rocking_stiffness == pytest.approx(closed.rocking_stiffness, rel=AGREEMENT)
    expected = closed.at_rest()
    found = numeric.at_rest()
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=AGREEMENT)


@pytest.mark.parametrize("share", [1.0, 0.8])
@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("base", BASES)
def test_a_held_rotation(base, side, rotation, share):
    closed, numeric = supports(base, rotation=rotation)
    uplift = closed.uplift_angle
    contacts = set()
    for angle in (0.2 * uplift, 0.7 * uplift, 1.5 * uplift, 3.0 * uplift, 6.0 * uplift):
        expected, found = held(closed, side * angle, share), held(numeric, side * angle, share)
        assert found.moment == pytest.approx(expected.moment, rel=AGREEMENT)
        size = closed.settlement + closed.load.body.half_width * angle
        assert found.rise == pytest.approx(expected.rise, rel=AGREEMENT, abs=AGREEMENT * size)
        assert (found.left, found.right) == (expected.left, expected.right)
        weight = closed.load.weight
        assert found.reactions == pytest.approx(
            expected.reactions, rel=AGREEMENT, abs=AGREEMENT * weight
        )
        contacts.add((found.left, found.right))
    assert contacts == {(True, True), (side < 0.0, side > 0.0)}


@pytest.mark.parametrize("base", ["pads", "bed"])
def test_upright_both_ends_bear_alike(base):
    closed, numeric = supports(base)
    expected, found = held(closed, 0.0), held(numeric, 0.0)
    assert found.left
    assert found.right
    assert found.rise == pytest.approx(0.0, abs=AGREEMENT * closed.settlement)
    assert found.moment == pytest.approx(0.0, abs=AGREEMENT * closed.load.weight)
    assert found.reactions == pytest.approx(expected.reactions, rel=AGREEMENT)


@pytest.mark.parametrize("base", ["pads", "bed"])
def test_a_base_too_soft_to_part_has_no_uplift_angle(base):
    soft = {
        "pads": rf.TwoSpringSupport(frequency_ratio=0.9, damping_ratio=0.1),
        "bed": rf.WinklerSoil(stiffness="10 kPa", damping_ratio=0.1),
    }
    with pytest.warns(rf.ModelWarning, match="too soft"):
        closed = rf.System(SQUAT, soft[base]).setting.support
    assert math.isnan(closed.uplift_angle)
    assert math.isnan(ByNumbers(closed.load, closed).uplift_angle)


@pytest.mark.parametrize("restraint", list(Restraint))
def test_a_stack_holds_a_block_the_same(restraint):
    """A stack asks both bases at other inclinations, and under other forces than the weight."""
    cap = rf.CushionCap(width="3.2 m", height="0.4 m", mass="10 t")
    parts = BLOCK, BASES["pads"], cap, BASES["bed"]
    closed = rf.System(*parts, restraint=restraint).setting
    upper, lower = closed.upper.support, closed.lower.support
    numeric = replace(
        closed,
        upper=replace(closed.upper, support=ByNumbers(upper.load, upper)),
        lower=replace(closed.lower, support=OnSoilByNumbers(lower.load, lower)),
    )
    contacts = set()
    for rotation in (0.002, 0.02, -0.02, 0.1, -0.1):
        expected, found = closed.statics(rotation), numeric.statics(rotation)
        contacts.add(found.contact_state)
        assert found.contact_state == expected.contact_state
        assert found.restoring_moment == pytest.approx(expected.restoring_moment, rel=AGREEMENT)
        assert found.base_moment == pytest.approx(expected.base_moment, rel=AGREEMENT)
        assert found.reactions == pytest.approx(expected.reactions, rel=AGREEMENT, abs=1e-3)
        assert found.vertical_displacement == pytest.approx(
            expected.vertical_displacement, rel=AGREEMENT, abs=AGREEMENT * closed.settlement
        )
    assert len(contacts) > 1
    expected, found = closed.equilibrium(), numeric.equilibrium()
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=AGREEMENT)
