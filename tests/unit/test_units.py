"""Units of arguments: accepted spellings, refusals, and messages."""

import math
import multiprocessing
import sys

import numpy as np
import pint
import pytest
from unit.dimensional_arguments import (
    FOREIGN,
    make_block,
    make_pads,
    make_pulse,
    make_system,
    refusal,
    run,
)

import rockframe as rf
from rockframe.errors import ComponentError, RockframeError
from rockframe.units import LENGTH, to_si_values
from rockframe.units.spelling import pint_spelling

pytestmark = pytest.mark.unit


def make_cap(**changed):
    return rf.CushionCap(**{"height": "1 m", "density": "2 t/m^3", "depth": "4 m", **changed})


# every dimensional argument: maker, name, its description, unit, an accepted value
DIMENSIONAL = [
    (make_block, "width", "length", "m", "2 m"),
    (make_block, "height", "length", "m", "8 m"),
    (make_block, "mass", "mass", "kg", "50 t"),
    (make_block, "inertia", "moment of inertia", "kg m^2", "3e5 kg*m^2"),
    (make_pads, "stiffness", "stiffness", "N m^-1", "12 MN/m"),
    (make_pads, "damping", "damping", "N s m^-1", "80 kN*s/m"),
    (rf.InitialState, "rotation", "angle", "rad", "0.1 rad"),
    (rf.InitialState, "angular_velocity", "angular velocity", "rad s^-1", "0.1 rad/s"),
    (rf.InitialState, "vertical_displacement", "length", "m", "1 mm"),
    (rf.InitialState, "vertical_velocity", "velocity", "m s^-1", "1 mm/s"),
    (make_system, "gravity", "acceleration", "m s^-2", "9.81 m/s^2"),
    (make_pulse, "amplitude", "acceleration", "m s^-2", "-3 m/s^2"),
    (make_pulse, "frequency", "frequency", "Hz", "2 Hz"),
    (run, "duration", "time", "s", "20 s"),
    (run, "free_vibration", "time", "s", "20 s"),
    (run, "output_step", "time", "s", "10 ms"),
]


NAMES = [f"{row[0].__name__}-{row[1]}" for row in DIMENSIONAL]
MUST_BE_POSITIVE = [
    row
    for row in DIMENSIONAL
    if row[0] is not rf.InitialState and row[1] not in ("amplitude", "damping")
]


@pytest.fixture(params=range(len(DIMENSIONAL)), ids=NAMES)
def argument(request):
    """Return a row of the table."""
    maker, name, words, unit, good = DIMENSIONAL[request.param]
    maker(**{name: good})
    return maker, name, words, unit, good


NO_UNIT = [3, 3.5, np.float64(2.0), np.int64(4), math.nan, "3", "3.5e2", "7 %", "2 dimensionless"]
RUBBISH = [
    True, False, b"2 m", object(), {}, "", "   ", "metre please", "4,5 m", "1,000 m", "4 m/",
    "4 (m", "nan", "__import__('os')", "4 +/- 1 m",
]  # fmt: skip


class TestEveryDimensionalArgument:
    def test_a_number_without_a_unit_is_refused(self, argument):
        maker, name, words, unit, _ = argument
        for bad in NO_UNIT:
            message = refusal(maker, **{name: bad})
            assert f"{name} needs" in message
            assert words in message
            assert repr(bad) in message
            assert unit in message or not isinstance(bad, str)
            assert f"{name}=" in message.split("for example")[1]

    def test_unit_of_wrong_dimension_is_refused(self, argument):
        maker, name, words, _, _ = argument
        for bad in ("3 A", "3 m^7", "3 degC"):
            message = refusal(maker, **{name: bad})
            assert f"{name} needs" in message
            assert words in message
            assert bad in message
            assert f"{name}=" in message.split("for example")[1]

    def test_an_array_is_refused(self, argument):
        maker, name, _, _, good = argument
        one = pint.get_application_registry().Quantity(good)
        for bad in (
            one.__class__([one.magnitude] * 2, one.units),
            one.__class__([one.magnitude], one.units),
            [good, good],
            np.array([1.0, 2.0]),
            ([1.0, 2.0], "m"),
        ):
            message = refusal(maker, **{name: bad})
            assert f"{name} needs" in message
            assert f"{name}=" in message.split("for example")[1]

    def test_unreadable_values_are_refused_by_name(self, argument):
        maker, name, _, _, _ = argument
        for bad in RUBBISH:
            message = refusal(maker, **{name: bad})
            assert f"{name} needs" in message, bad
            assert "for example" in message, bad

    def test_a_value_that_is_not_finite_is_refused(self, argument):
        maker, name, _, unit, _ = argument
        symbol = unit.replace(" ", "*")
        for number in ("nan", "inf", "-inf", "1e999"):
            message = refusal(maker, **{name: f"{number} {symbol}"})
            assert name in message
            assert "finite" in message
            assert number in message
            quantity = pint.get_application_registry().Quantity(float(number), symbol)
            assert "finite" in refusal(maker, **{name: quantity})

    def test_a_quantity_of_a_foreign_registry_is_read(self, argument):
        maker, name, _, _, good = argument
        maker(**{name: FOREIGN.Quantity(good)})
        assert f"{name} needs" in refusal(maker, **{name: FOREIGN.Quantity("3 ampere")})


def test_nonpositive_values_are_refused_where_positive_is_required():
    for maker, name, _, unit, _ in MUST_BE_POSITIVE:
        for number in ("0", "-1", "-1e-300"):
            message = refusal(maker, **{name: f"{number} {unit.replace(' ', '*')}"})
            assert name in message
            assert "greater than zero" in message, (name, number)
            assert number in message


def test_a_negative_damping_is_refused_and_a_zero_one_is_not():
    assert "zero or more" in refusal(make_pads, damping="-1 N*s/m")
    assert "zero or more" in refusal(make_pads, damping_ratio=-0.1)
    make_pads(damping="0 N*s/m")
    make_pads(damping_ratio=0)


# single traps -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("maker", "name", "bad", "hint"),
    [
        (make_block, "mass", "99 kN", "'99 kN/g_0'"),
        (make_block, "mass", "88 kip", "'88 kip/g_0'"),
        (make_block, "mass", "88 kip/g", "'g' is the gram there; write '88 kip/g_0'"),
        (make_block, "inertia", "3 kN*m^2", "'3 kN*m^2/g_0'"),
        (make_cap, "density", "25 kN/m^3", "'25 kN/m^3/g_0'"),
        (make_pulse, "amplitude", "30 gal", "Gal"),
        (make_pulse, "amplitude", "30gal", "Gal"),
        (make_pulse, "amplitude", "3 m/s2", "^"),
        (make_block, "width", "4,5 m", "decimal point"),
        (make_block, "mass", "1 ton", "'t'"),
        (make_block, "mass", "10 tons", "'t'"),
        (make_pulse, "frequency", "6 rad/s", "2 pi"),
        (make_pulse, "frequency", "60 rpm", "2 pi"),
        (rf.InitialState, "rotation", "10 rad", "was '10 deg' meant?"),
        (rf.InitialState, "rotation", "-5.5 radian", "was '-5.5 deg' meant?"),
    ],
)
def test_a_known_trap_is_refused_with_a_hint(maker, name, bad, hint):
    message = refusal(maker, **{name: bad})
    assert name in message
    assert bad in message
    assert hint in message


@pytest.mark.parametrize("unit", ["g", "G", "g0", "g_0"])
def test_unit_g_means_gravity_for_accelerations(unit):
    expected = 0.3 * 9.80665
    assert make_pulse(amplitude=f"0.3 {unit}").si.peak == pytest.approx(expected, rel=1e-12)
    assert make_pulse(amplitude=f"0.3{unit}").si.peak == pytest.approx(expected, rel=1e-12)
    assert make_pulse(amplitude=(0.3, unit)).si.peak == pytest.approx(expected, rel=1e-12)
    arrays = rf.GroundMotion.from_arrays(([0.0, 0.3, 0.0], unit), "0.01 s")
    assert arrays.si.peak == pytest.approx(expected, rel=1e-12)
    assert make_block(mass="3000 g").mass.m_as("kg") == pytest.approx(3.0)
    assert "gram" in refusal(make_pulse, amplitude=pint.Quantity(0.3, "g"))


def test_weight_divided_by_g_0_is_accepted_as_mass():
    assert make_block(mass="98.0665 kN/g_0").si.mass == pytest.approx(1e4, rel=1e-14)
    assert make_cap(density="25 kN/m^3/g_0").si.mass_at(1.0) == pytest.approx(1e5 / 9.80665)


def test_large_angle_in_degrees_gets_no_unit_suggestion():
    assert "meant" not in refusal(rf.InitialState, rotation="120 deg")


@pytest.mark.parametrize(
    ("maker", "name", "example"),
    [
        (
            lambda **bad: rf.GroundMotion.from_arrays(([1.0], "m/s^2"), **bad),
            "time_step",
            "'0.01 s'",
        ),
        (make_pulse().resampled, "time_step", "'0.01 s'"),
        (make_cap, "height", "'0.3 m'"),
        (make_pads, "frequency_ratio", "20"),
        (make_pads, "restitution", "0.9"),
        (make_block, "shape_factor", "3"),
        (
            lambda **bad: rf.Block.from_size(radius="5 m", mass="4 t", **bad),
            "slenderness",
            "4",
        ),
    ],
)
def test_error_message_gives_a_suitable_example(maker, name, example):
    for bad in ("ten", [0.1]):
        assert refusal(maker, **{name: bad}).endswith(f"; write for example {name}={example}")


def test_ratio_error_does_not_request_a_unit():
    message = refusal(make_pads, damping_ratio="ten")
    assert "needs a pure ratio, got 'ten', which is not a number;" in message


@pytest.mark.parametrize(
    ("maker", "name", "bad"),
    [
        (make_pads, "stiffness", "12 t"),
        (make_pads, "stiffness", "12 t/m"),
        (make_pads, "stiffness", "12 kg"),
        (make_pads, "stiffness", "12 MN"),
        (make_pads, "stiffness", "12 MPa"),
        (make_pads, "damping", "80 kN/m"),
        (make_block, "mass", "500 kN"),
        (make_block, "mass", "2500 kg/m^3"),
        (make_block, "inertia", "3e5 m^4"),
        (rf.InitialState, "rotation", "5"),
        (rf.InitialState, "rotation", "5 %"),
        (rf.InitialState, "rotation", "0.1 m/m"),
        (rf.InitialState, "angular_velocity", "1 Hz"),
        (rf.InitialState, "angular_velocity", "1/s"),
        (rf.InitialState, "vertical_displacement", "0.1 rad"),
        (make_pulse, "frequency", "1 s"),
        (run, "duration", "20 m"),
        (run, "duration", "20 Hz"),
    ],
)
def test_similar_but_wrong_units_are_refused(maker, name, bad):
    assert f"{name} needs" in refusal(maker, **{name: bad})


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("rotation", "0.1 sr"),
        ("rotation", "0.1 rad^2"),
        ("rotation", "0.1 / rad"),
        ("angular_velocity", "0.1 rad^2/s"),
        ("angular_velocity", "0.1 sr/s"),
    ],
)
def test_powers_of_the_radian_are_refused_as_angles(name, bad):
    assert f"{name} needs" in refusal(rf.InitialState, **{name: bad})


@pytest.mark.parametrize("value", ["2 1/s", (2, "1/s"), "120 1/min", (2.0, "1 / s"), "2/s"])
def test_units_that_begin_with_one_are_read(value):
    assert make_pulse(frequency=value).recipe["frequency"] == "2.0 Hz"


def test_bits_are_no_ratio_and_no_frequency():
    refusal(make_pads, frequency_ratio="20 bit")
    refusal(make_pulse, frequency="1 bit/s")


@pytest.mark.parametrize(
    ("maker", "name", "bad"),
    [
        (make_block, "mass", "1 500 kg"),
        (make_block, "mass", "1 234 567 kg"),
        (make_block, "width", "4 5 m"),
        (rf.InitialState, "vertical_displacement", "1 000 mm"),
        (make_pulse, "amplitude", "1 2 m/s^2"),
        (make_pulse, "frequency", "2 1/2 Hz"),
        (make_pulse, "frequency", "2 1 Hz"),
        (make_pulse, "frequency", "2 11/s"),
    ],
)
def test_blanks_inside_numbers_are_refused(maker, name, bad):
    assert f"{name} needs" in refusal(maker, **{name: bad})


@pytest.mark.parametrize(
    ("maker", "name", "bad", "why"),
    [
        (make_block, "height", "2'500 mm", "without separators"),
        (make_block, "height", "2\u2019500 mm", "without separators"),
        (make_block, "height", "2·500 mm", "without separators"),
        (make_block, "height", "2:500 mm", "without separators"),
        (make_block, "height", "2;500 mm", "without separators"),
        (make_block, "height", "12'345'678 mm", "without separators"),
        (make_block, "height", "6'8 ft", "without separators"),
        (make_block, "height", "2·10³ mm", "without separators"),
        (make_block, "height", "2½ m", "'½' occurs in no number and in no unit"),
        (make_block, "height", "2 m₂", "'₂' occurs in no number and in no unit"),
        (make_block, "height", "2 m #3", "'#' occurs in no number and in no unit"),
        (make_block, "height", "2\u200b500 mm", "without separators"),
        (make_block, "height", "\u22122 m", "'\u2212' occurs in no number and in no unit"),
        (make_block, "height", "2² m", "not one number and a unit"),
        (make_block, "height", "2\xd73 m", "without separators"),
        (make_block, "height", "2\xd710^3 mm", "without separators"),
        (make_block, "height", "2 m+3 m", "not one number and a unit"),
        (make_block, "height", "6 ft-2 in", "not one number and a unit"),
        (make_block, "height", "2 m.5", "not one number and a unit"),
        (make_block, "height", "2 (m)5", "not one number and a unit"),
        (make_block, "height", "2 m^2²/m^3", "not one number and a unit"),
        (make_pulse, "amplitude", "3 m/-s^2", "not one number and a unit"),
        (make_pulse, "amplitude", "3 m/⁻s^2", "not one number and a unit"),
        (make_pads, "damping_ratio", "5 $", "'$' occurs in no number and in no unit"),
        (make_pads, "damping_ratio", "5 %2", "not a number"),
    ],
)
def test_notations_misread_by_pint_are_refused(maker, name, bad, why):
    message = refusal(maker, **{name: bad})
    assert f"{name} needs" in message
    assert repr(bad) in message
    assert why in message
    assert f"write for example {name}=" in message


@pytest.mark.parametrize(
    ("maker", "name", "text", "attribute", "expected"),
    [
        (make_block, "width", "2_500 mm", "width", 2.5),
        (make_block, "width", "1e-3 km", "width", 1.0),
        (make_block, "width", "2.5e3mm", "width", 2.5),
        (make_block, "width", "50 in.", "width", 1.27),
        (make_block, "width", "2 [m]", "width", 2.0),
        (make_block, "width", "2\xa0m", "width", 2.0),
        (make_block, "width", "2 * m", "width", 2.0),
        (make_block, "width", "2 m^3 / m ** 2", "width", 2.0),
        (make_block, "width", "2 m^(-1)*m^+2", "width", 2.0),
        (make_block, "width", "2 square m per m", "width", 2.0),
        (make_block, "inertia", "5 t·m²", "inertia", 5e3),
        (make_block, "inertia", "5 t.m^2", "inertia", 5e3),
        (make_block, "inertia", "5 t\xd7m²", "inertia", 5e3),
        (make_pads, "damping", "1 kN·s/m", "damping", 1e3),
        (make_pads, "damping", "1 kN⋅s⋅m⁻¹", "damping", 1e3),
        (make_pads, "damping", "1 kN/(m/s)", "damping", 1e3),
        (rf.InitialState, "vertical_displacement", "-.5 mm", "vertical_displacement", -5e-4),
        (rf.InitialState, "vertical_displacement", "+5. µm", "vertical_displacement", 5e-6),
    ],
)
def test_one_number_and_a_unit_are_read_in_all_their_spellings(
    maker, name, text, attribute, expected
):
    assert getattr(maker(**{name: text}).si, attribute) == pytest.approx(expected, rel=4e-16)


@pytest.mark.parametrize("bad", ["m", "kilometre"])
def test_unit_without_a_number_is_refused(bad):
    assert "width needs" in refusal(make_block, width=bad)


@pytest.mark.parametrize("bad", ["1 kton", "1 Mton", "3 kilotons"])
def test_prefixed_tons_are_refused_as_ambiguous(bad):
    assert "mass needs" in refusal(make_block, mass=bad)


def _build(text):
    try:
        make_block(mass=text)
    except RockframeError:
        sys.exit(7)
    sys.exit(0)


def test_tower_of_powers_is_refused_quickly():
    worker = multiprocessing.get_context("fork").Process(target=_build, args=("9**9**9 kg",))
    worker.start()
    worker.join(5.0)
    alive = worker.is_alive()
    if alive:
        worker.kill()
        worker.join()
    assert not alive
    assert worker.exitcode == 7


def test_a_negative_power_without_its_sign_is_explained():
    """As UDUNITS writes it."""
    assert "powers need '^'" in refusal(make_block, width="1 J N-1")


@pytest.mark.parametrize("text", ["1e3 A", "2.5e6 s"])
def test_exponent_notation_is_not_reported_as_missing_power_sign(text):
    assert "powers need" not in refusal(make_block, width=text)


@pytest.mark.parametrize(
    ("maker", "name", "text", "attribute", "expected"),
    [
        (make_block, "width", "250 cm", "width", 2.5),
        (make_block, "width", "2.5m", "width", 2.5),
        (make_block, "width", " 2.5  metre ", "width", 2.5),
        (make_block, "height", "30 ft", "height", 9.144),
        (make_block, "mass", "50 t", "mass", 5e4),
        (make_block, "mass", "50 tonne", "mass", 5e4),
        (make_block, "mass", "50 Mg", "mass", 5e4),
        (make_block, "mass", "1e4 lb", "mass", 4535.9237),
        (make_pads, "stiffness", "12 kN/mm", "stiffness", 1.2e7),
        (make_pads, "stiffness", "12 MN/m", "stiffness", 1.2e7),
        (make_pads, "damping", "80 kN*s/m", "damping", 8e4),
        (rf.InitialState, "rotation", "5 deg", "rotation", math.radians(5.0)),
        (rf.InitialState, "rotation", "5 °", "rotation", math.radians(5.0)),
        (rf.InitialState, "rotation", "100 mrad", "rotation", 0.1),
        (rf.InitialState, "rotation", "-0.01 turn", "rotation", -0.02 * math.pi),
        (rf.InitialState, "angular_velocity", "1 rpm", "angular_velocity", math.pi / 30.0),
        (rf.InitialState, "angular_velocity", "90 deg/s", "angular_velocity", 0.5 * math.pi),
        (rf.InitialState, "vertical_displacement", "-3 mm", "vertical_displacement", -0.003),
        (rf.InitialState, "vertical_velocity", "36 km/h", "vertical_velocity", 10.0),
    ],
)
def test_other_units_are_converted(maker, name, text, attribute, expected):
    assert getattr(maker(**{name: text}).si, attribute) == pytest.approx(expected, rel=4e-16)


@pytest.mark.parametrize("unit", ["cm", "centimeter", "cm * m/m"])
def test_unit_conversion_adds_no_rounding_noise(unit):
    """The product of the floats 70 and 0.01 is 0.7000000000000001."""
    numbers = 70, 70.0, np.float64(70.0), np.array(70.0)  # some registries make arrays of numbers
    for value in (f"70 {unit}", (70.0, unit), *(pint.Quantity(one, unit) for one in numbers)):
        assert make_block(width=value) == make_block(width="0.7 m")
    assert "width='0.7 m'" in repr(make_block(width=f"70 {unit}"))
    feet = make_block(height="8 ft", mass="2500 lb")  # 1 ft is 0.30479999999999996 m to pint
    assert (feet.si.height, feet.si.mass) == (2.4384, 1133.980925)
    assert to_si_values(([8.0], "ft"), LENGTH, owner="sweep", name="height") == [2.4384]
    held = rf.System(make_block()).moment_rotation(([70.0, 7.0], "mrad"))
    assert held.angle.values.tolist() == [0.07, 0.007]


@pytest.mark.parametrize(
    ("text", "words"), [("1e306 km", "must be finite"), ("nan cm", "finite"), ("-inf cm", "finite")]
)
def test_numbers_beyond_all_bounds_are_refused_in_any_unit(text, words):
    with pytest.raises(ComponentError, match=words):
        make_block(width=text)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.3 g_0", 0.3 * 9.80665),
        ("0.3 gravity", 0.3 * 9.80665),
        ("300 Gal", 3.0),
        ("300 cm/s^2", 3.0),
        ("300 cm/s**2", 3.0),
        ("3 m/s²", 3.0),
        ("3 m s^-2", 3.0),
    ],
)
def test_accelerations_are_converted(text, expected):
    assert make_pulse(amplitude=text).si.peak == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("text", ["60 /min", "1 Hz", "1000 mHz", "1/s"])
def test_frequencies_are_converted(text):
    assert make_pulse(frequency=text).si.duration == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("50 in.", "50.0 in"),
        ("5 t.m^2", "5.0 t*m^2"),
        ("3 lb.in.", "3.0 lb*in"),
        ("2 m^0.5", "2.0 m^0.5"),
        ("3 ft./s", "3.0 ft/s"),
    ],
)
def test_dots_in_units_are_products_or_abbreviations(written, read):
    """Versions of pint read dots differently, or not at all."""
    assert pint_spelling(written) == read
