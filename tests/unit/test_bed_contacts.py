"""The contacts of both ends of a bed in one integer."""

import itertools

import pytest

from rockframe.dynamics.bed import DOWN, RAISED, Bed, both_contacts, end_contact
from rockframe.dynamics.pads import LEAVING

pytestmark = pytest.mark.unit

BED = Bed(stiffness=1e4, damping=10.0, settlement=0.01, width=2.0, by_pressure=False)
ENDS = list(itertools.product((DOWN, RAISED), repeat=2))


def test_each_pair_has_its_number():
    numbers = [both_contacts(*ends) for ends in ENDS]
    assert sorted(numbers) == list(range(BED.contacts()))
    for number, (left, right) in zip(numbers, ENDS, strict=True):
        assert (end_contact(number, True), end_contact(number, False)) == (left, right)


@pytest.mark.parametrize(("left", "right"), ENDS)
def test_bed_interprets_contact_numbers(left, right):
    contact = both_contacts(left, right)
    assert BED.is_held(contact, True) == (left == DOWN)
    assert BED.is_held(contact, False) == (right == DOWN)
    # the sign of the tilt is the side of the raised end
    assert BED.tilt(contact) == right - left
    assert BED.with_end(contact, True, LEAVING) == BED.disturbed(contact) == contact
    assert BED.follows(contact, True) == both_contacts(RAISED, RAISED)


def test_modes_are_numbered_one_to_one():
    from rockframe.dynamics.body import Body
    from rockframe.dynamics.on_base import BodyOnBase, Mode

    body = Body(1.0, 0.5, 0.5, 0.4, 9.81, 0.46, 0, False)
    part = BodyOnBase(body, BED)
    seen = set()
    for contact, pivot, slides in itertools.product(range(4), range(3), (False, True)):
        mode = Mode(contact, pivot, slides)
        number = part.number_of(mode)
        assert part.mode_of(number) == mode
        seen.add(number)
    assert len(seen) == 24
    assert max(seen) < part.modes()
