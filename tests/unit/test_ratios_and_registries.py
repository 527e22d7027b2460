"""Ratios, quantities of other registries, columns and arrays with units."""

import copy
import math
import os
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pint
import pytest
import xarray as xr
from unit.dimensional_arguments import FOREIGN, make_block, make_pads, make_pulse, refusal, run

import rockframe as rf
from rockframe.errors import ComponentError, UnitsError
from rockframe.reports.values import format_value
from rockframe.units import LENGTH, degrees_text, to_si, to_si_values
from rockframe.units.display import display_units, unit_suffix

pytestmark = pytest.mark.unit


# ratios ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (20, 20.0),
        (np.float32(20.0), 20.0),
        (np.int64(20), 20.0),
        ("20", 20.0),
        ("2000 %", 20.0),
        ("20 mm/mm", 20.0),
        ("20 m/mm", 20000.0),
    ],
)
def test_a_ratio_may_be_bare_or_dimensionless(value, expected):
    assert make_pads(frequency_ratio=value).si.frequency_ratio == pytest.approx(expected)


def test_per_cent_are_not_rounded():
    """35 times the float 0.01 is 0.35000000000000003."""
    for share in range(1, 100):
        assert make_pads(damping_ratio=f"{share} %") == make_pads(damping_ratio=share / 100)


def test_a_ratio_may_be_a_quantity_of_any_registry():
    for registry in (pint.get_application_registry(), FOREIGN):
        for magnitude in (20, 20.0, np.float64(20.0), np.array(20.0)):
            quantity = registry.Quantity(magnitude, "")
            assert make_pads(frequency_ratio=quantity).si.frequency_ratio == 20.0


@pytest.mark.parametrize("kind", [Decimal, Fraction])
def test_registries_may_have_other_numbers_than_floats(kind):
    registry = pint.UnitRegistry(non_int_type=kind)
    block = make_block(width=registry.Quantity("2.5 ft"), shape_factor=registry.Quantity("2.5"))
    assert (block.si.width, block.si.shape_factor) == (0.762, 2.5)


@pytest.mark.parametrize(
    ("maker", "name"),
    [
        (make_block, "shape_factor"),
        (make_pads, "frequency_ratio"),
        (make_pads, "damping_ratio"),
        (make_pads, "restitution"),
        (rf.RigidGround, "restitution"),
        (make_pulse, "cycles"),
    ],
)
def test_invalid_ratios_are_refused(maker, name):
    texts = ["0.1 rad", "5 deg", "1 m", "1 Hz", "x", ""]
    for bad in [*texts, True, np.True_, [0.1], np.array([0.1]), 1 + 0j]:
        message = refusal(maker, **{name: bad})
        assert f"{name} needs a pure ratio" in message
        assert (f"'{bad}'" if isinstance(bad, str) else repr(bad)) in message


@pytest.mark.parametrize("name", ["frequency_ratio", "damping_ratio", "restitution"])
def test_a_ratio_must_be_finite(name):
    for bad in (math.nan, math.inf, -math.inf, "nan", "inf"):
        message = refusal(make_pads, **{name: bad})
        assert name in message
        assert "finite" in message


# the application registry -----------------------------------------------------


def test_application_registry_is_not_modified():
    registry = pint.get_application_registry()
    units = set(registry._units)
    settings = (registry.formatter.default_format, registry.autoconvert_offset_to_baseunit)
    held = registry.get()
    make_block(width="250 cm").width.to("ft")
    make_pulse(amplitude="0.3 g_0")
    make_pulse(amplitude="0.3 g")
    refusal(make_pulse, amplitude="0.3 kg")
    run()
    assert pint.get_application_registry().get() is held
    assert set(registry._units) == units
    after = (registry.formatter.default_format, registry.autoconvert_offset_to_baseunit)
    assert after == settings


@pytest.fixture
def restored_registry():
    held = pint.get_application_registry().get()
    yield held
    pint.set_application_registry(held)


def test_registry_can_be_replaced_during_a_session(restored_registry):
    before = make_block()
    width = before.width
    pint.set_application_registry(FOREIGN)
    after = make_block()
    assert after == before
    assert hash(after) == hash(before)
    assert make_block(width=width) == before
    assert before.width == after.width
    assert copy.deepcopy(before) == after
    first = rf.System(before, make_pads()).simulate(make_pulse(), outputs=None)
    second = rf.System(after, make_pads()).simulate(make_pulse(), outputs=None)
    assert first.drop_attrs().identical(second.drop_attrs())


@pytest.mark.wide
def test_registry_of_another_library_is_supported():
    code = """
import rockframe as rf
before = rf.Block(width="2 m", height="8 m", mass="50 t")
width = before.width
import cf_xarray.units, pint
registry = pint.get_application_registry()
assert rf.Block(width=width, height="8 m", mass="50 t") == before
after = rf.Block(width=registry("2 m"), height=registry.Quantity(8.0, "m"), mass="50 t")
assert after == before and after.width == before.width
assert after.width.check("[length]") and after.width.units == registry.metre
pulse = rf.GroundMotion.sine_pulse(amplitude="0.3 g_0", frequency="1 Hz")
assert rf.GroundMotion.sine_pulse(amplitude="0.3 g", frequency="1 Hz").sha256 == pulse.sha256
for wrong in ("5", "5 %"):
    try:
        rf.InitialState(rotation=wrong)
    except rf.errors.UnitsError:
        pass
    else:
        raise AssertionError(wrong)
response = rf.System(after).simulate(pulse, outputs=None)
assert rf.System.from_dataset(response).parts.block == after
"""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, timeout=120,
        env=os.environ | {"ROCKFRAME_COMPILE": "0"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    "unit",
    [
        "mm",
        "km",
        "nautical_mile",
        *(pytest.param(one, marks=pytest.mark.long) for one in ("m", "dm", "Mm")),
    ],
)
def test_column_conversion_equals_scalar_conversion(unit):
    rng = np.random.default_rng(2)
    numbers = [
        *rng.uniform(-10.0, 10.0, 300).tolist(),
        *(rng.integers(0, 999, 100) / 100).tolist(),
        *(10.0 ** rng.uniform(-20, 20, 100)).tolist(),
        0.0, -0.0, 1e22, 5e-324, -7.0,
    ]  # fmt: skip
    found = to_si_values((np.array(numbers), unit), LENGTH, owner="here", name="width")
    size = Fraction(repr(to_si(f"1 {unit}", LENGTH, owner="here", name="width")))
    assert found == [float(Fraction(repr(number)) * size) for number in numbers]
    assert found == [
        to_si((number, unit), LENGTH, owner="here", name="width") for number in numbers
    ]


LONG = {"length": "mm", "stiffness": "kN/mm"}


def test_sentences_are_converted_to_display_units():
    units = display_units({"acceleration": "g", "length": "mm"}, owner="a figure")
    converted = units.convert_text(
        "from 9.80665 to 19.6133 m s^-2, 0.02 m, -1e-3 m; 2 m s^-1, 3 m s^-2."
    )
    assert converted == "from 1 to 2 g, 20 mm, -1 mm; 2 m s^-1, 0.3059 g."
    chosen = {**LONG, "moment": "MN*m", "force": "kN", "angle": "deg", "mass": "t"}
    units = display_units(chosen, owner="a figure")
    for text, expected in (
        ("M_OT 4707 N m, 1e+07 N", "M_OT 0.004707 MN m, 10000 kN"),
        ("1.5e+07 N/m, 80 N s/m", "15 kN mm^-1, 80 N s/m"),
        ("at (-0.5, 3) m, 4 kg m^2", "at (-500, 3000) mm, 4 kg m^2"),
        ("0.0544 m at most, 3 mm, 2 months", "54.4 mm at most, 3 mm, 2 months"),
        ("Block(width='0.6 m', mass='5000.0 kg')", "Block(width='600 mm', mass='5 t')"),
        # a repetition in degrees is dropped; a rounded number has one digit less in degrees
        ("0.244979 rad (14.04°), 0.01663 rad", "14.036°, 0.953°"),
        ("0.5 rad/s", "0.5 rad/s"),
    ):
        assert units.convert_text(text) == expected
    assert display_units(None, owner="a figure").convert_text("4 m") == "4 m"


def test_pair_with_a_quantity_is_not_read_as_number_and_unit():
    metre = pint.Quantity(1.0, "m")
    assert to_si_values([metre, "20 cm"], LENGTH, owner="here", name="width") == [1.0, 0.2]
    assert to_si_values([[1, 2], "cm"], LENGTH, owner="here", name="width") == [0.01, 0.02]
    # integers of a generator, and an array without dimensions
    each = to_si_values(((k for k in (1, 2)), "cm"), LENGTH, owner="here", name="width")
    assert each == [0.01, 0.02]
    assert to_si_values((np.array(7.0), "cm"), LENGTH, owner="here", name="width") == [0.07]
    with pytest.raises(rf.errors.UnitsError, match="got None"):
        to_si_values([None, "20 cm"], LENGTH, owner="here", name="width")


QUANTITY = pint.get_application_registry().Quantity


@pytest.mark.parametrize(
    ("values", "unit", "read"),
    [
        (xr.DataArray([50.0, 70.0], attrs={"units": "cm"}), "m", None),
        (xr.DataArray([50.0, 70.0], attrs={"units": "cm"}), "cm", [0.5, 0.7]),
        (xr.DataArray([50.0, 70.0], attrs={"units": "cm"}), "centimetre", [0.5, 0.7]),
        (xr.DataArray([50.0, 70.0], attrs={"units": "whatever"}), "m", None),
        (xr.DataArray([50.0, 70.0], attrs={"long_name": "width"}), "cm", [0.5, 0.7]),
        (xr.DataArray(QUANTITY(np.array([50.0, 70.0]), "cm")), "m", None),
    ],
)
def test_conflicting_unit_of_an_array_is_refused(values, unit, read):
    if read is None:
        with pytest.raises(UnitsError, match=r"x has the unit '\w+', but 'm' is given with it"):
            to_si_values((values, unit), LENGTH, owner="one", name="x")
    else:
        assert to_si_values((values, unit), LENGTH, owner="one", name="x") == read


def test_conflicting_units_of_accelerations_and_times_are_refused():
    array = xr.DataArray([0.0, 1.0], dims="x", attrs={"units": "m s-2"})
    for value in (array, (array, "m/s^2")):
        assert rf.GroundMotion.from_arrays(value, "0.01 s").si.peak == 1.0
    for own in (array, QUANTITY(np.array([0.0, 1.0]), "cm/s^2")):
        with pytest.raises(UnitsError, match=r"acceleration has the unit .*, but 'g' is given"):
            rf.GroundMotion.from_arrays((own, "g"), "0.01 s")
    times = xr.DataArray([0.0, 10.0], dims="x", attrs={"units": "ms"})
    with pytest.raises(UnitsError, match="times has the unit 'ms', but 's' is given"):
        rf.GroundMotion.from_times((times, "s"), array, "0.01 s")


def test_masked_values_are_refused():
    held = np.ma.array([0.5, 0.7], mask=[False, True])
    with pytest.raises(ComponentError, match="x has masked values; fill them in first"):
        to_si_values((held, "m"), LENGTH, owner="one", name="x")
    assert to_si_values((np.ma.array([0.5, 0.7]), "cm"), LENGTH, owner="one", name="x") == [
        0.005,
        0.007,
    ]


def test_degree_sign_has_no_preceding_space():
    """ISO 80000-1: a space before every unit, but none before the sign of degrees."""
    assert [unit_suffix(unit) for unit in ("1", "", "m s^-1", "°", "° s^-1")] == [
        "", "", " m s^-1", "°", "° s^-1"]  # fmt: skip
    assert (degrees_text(math.pi / 7), degrees_text(math.pi / 7, 2)) == ("25.71°", "26°")
    angle = xr.DataArray(0.25, attrs={"units": "rad"})
    units = display_units({"angle": "deg"}, owner="a page")
    assert format_value(angle) == "0.25 rad (14.3°)"
    assert format_value(angle, units) == "14.32°" == units.convert_text("0.25 rad")
    block = rf.Block(width="0.5 m", height="2 m", mass="1 t")
    text = rf.System(block, inclination="2 deg").describe()
    assert "(12.04°)" in text
    assert "(16.04°)" in text
    assert " deg" not in text.replace("2 deg", "")


def test_first_quantities_of_several_threads_are_read():
    script = """
from concurrent.futures import ThreadPoolExecutor
import rockframe as rf
masses = [f"{number} t" for number in range(1, 9)]
with ThreadPoolExecutor(8) as pool:
    blocks = pool.map(lambda mass: rf.Block(width="0.8 m", height="3 m", mass=mass), masses)
    print([round(block.mass.to("t").magnitude) for block in blocks])
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == (f"{[*range(1, 9)]}\n", "")
