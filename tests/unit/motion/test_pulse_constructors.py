"""Constructors of analytic motions: arguments, names, recipes."""

import json
import math
from inspect import classify_class_attrs, signature

import pytest
from pages import table

from rockframe.errors import ComponentError, SchemaError, UnitsError
from rockframe.motion import GroundMotion
from rockframe.motion.constructors.analytic import PULSES
from rockframe.motion.description import CONSTRUCTORS

VALUES = {
    "amplitude": "0.31 g_0", "velocity": "-73 cm/s", "frequency": "1.7 Hz", "period": "1.1 s",
    "duration": "1.37 s", "interval": "0.37 s", "pulse_duration": "0.011 s", "phase": "31 deg",
    "cycles": "190 %", "order": 3, "antisymmetric": True,
}  # fmt: skip
"""A value for every argument of the constructors."""


def build_pulse(constructor: str, *, all_arguments: bool) -> GroundMotion:
    """Build a pulse with all arguments, or with the required ones only."""
    build = getattr(GroundMotion, constructor)
    arguments = {
        name: VALUES[name]
        for name, parameter in signature(build).parameters.items()
        if all_arguments or parameter.default is parameter.empty
    }
    return build(**arguments)


MOTIONS = {name: build_pulse(name, all_arguments=True) for name in PULSES}
DEFAULTS = [build_pulse(name, all_arguments=False) for name in PULSES]


def test_every_constructor_is_allowed_in_descriptions():
    members = classify_class_attrs(GroundMotion)
    built = {
        member.name for member in members if member.kind == "class method" and member.name[0] != "_"
    }
    read = {"read", "example", *(name for name in built if name.startswith("from_"))}
    assert built - read == set(CONSTRUCTORS)


def test_manual_lists_every_pulse():
    page, head = "theory/pulses.md", "| constructor of `GroundMotion` | $\\ddot x_g$ | length |"
    rows = table(page, f"{head} final velocity | final displacement |")
    listed = [row[0].strip("`") for row in rows]
    assert listed == PULSES, f"give docs/{page} a row for each pulse, in the order of the code"


@pytest.mark.parametrize("motion", [*MOTIONS.values(), *DEFAULTS])
def test_a_description_builds_the_motion_again(motion):
    description = json.loads(json.dumps(motion.to_dict()))
    rebuilt = GroundMotion.from_dict(description)
    assert rebuilt == motion
    assert rebuilt.to_dict() == motion.to_dict()


@pytest.mark.parametrize("motion", [*MOTIONS.values(), *DEFAULTS])
def test_motion_survives_netcdf_round_trip(motion, tmp_path):
    import xarray as xr

    motion.to_dataset().to_netcdf(tmp_path / "motion.nc")
    with xr.open_dataset(tmp_path / "motion.nc") as stored:
        rebuilt = GroundMotion.from_dataset(stored)
    assert rebuilt == motion
    assert GroundMotion.from_dict(rebuilt.to_dict()) == motion


@pytest.mark.parametrize("constructor", PULSES)
def test_description_rebuilds_processed_motion(constructor):
    motion = MOTIONS[constructor].scaled(peak="0.2 g_0").window("0.1 s", "0.3 s")
    rebuilt = GroundMotion.from_dict(json.loads(json.dumps(motion.to_dict())))
    assert rebuilt.sha256 == motion.sha256
    assert motion.si.horizontal.analytic


NAMES = {
    "sine pulse, 2.94199 m/s^2, 1.7 Hz, cycles: 1.3": GroundMotion.sine_pulse(
        "0.3 g_0", "1.7 Hz", "130 %"
    ),
    "harmonic motion, 3.04006 m/s^2, 1.7 Hz, 1.37 s, phase 0.541052 rad": MOTIONS["harmonic"],
    "type C pulse, -0.73 m/s, 1.1 s, order: 3": MOTIONS["type_c_pulse"],
    "Ricker wavelet, 3.04006 m/s^2, 1.1 s, antisymmetric": MOTIONS["ricker_wavelet"],
    "double impulse, -0.73 m/s, interval 0.37 s, impulses of 0.0108824 s": MOTIONS[
        "double_impulse"
    ],
}


@pytest.mark.parametrize(("name", "motion"), NAMES.items())
def test_name_and_history_describe_pulse(name, motion):
    assert motion.name == name
    (sentence,) = motion.history
    assert sentence.startswith(name.split(",")[0] + ": ")


def test_history_and_description_have_full_precision():
    motion = GroundMotion.type_a_pulse("0.1234567890123 m/s", "1.1 s")
    assert motion.history == ("type A pulse: 0.1234567890123 m/s, 1.1 s",)
    assert motion.to_dict() == {
        "type": "GroundMotion",
        "constructor": "type_a_pulse",
        "velocity": "0.1234567890123 m s^-1",
        "period": "1.1 s",
    }
    plain = GroundMotion.ricker_wavelet("1 m/s^2", "1 s")
    assert plain.name == "Ricker wavelet, 1 m/s^2, 1 s, not antisymmetric"
    assert plain.to_dict()["antisymmetric"] is False


def test_subclass_is_built_and_named_in_errors():
    class Recorded(GroundMotion):
        __slots__ = ()

    assert type(Recorded.type_b_pulse("1 m/s", "1 s")) is Recorded
    with pytest.raises(UnitsError, match=r"^Recorded\.type_b_pulse: velocity"):
        Recorded.type_b_pulse(1.0, "1 s")


# equal pulses with different names ---------------------------------------------------------------


@pytest.mark.parametrize("duration", [0.37, 0.5, 2.0])
def test_half_sine_is_half_a_cycle(duration):
    half = GroundMotion.half_sine_pulse("2 m/s^2", f"{duration!r} s")
    assert (
        half.si.digest
        == GroundMotion.sine_pulse("2 m/s^2", f"{0.5 / duration!r} Hz", 0.5).si.digest
    )
    assert half.si.duration == pytest.approx(duration, rel=1e-15)
    assert half.si.horizontal.samples[[0, -1]].tolist() == [0.0, 0.0]


@pytest.mark.parametrize("period", [0.37, 0.5, 2.0])
def test_type_a_is_one_sine_and_type_b_one_cosine(period):
    frequency = f"{1.0 / period!r} Hz"
    velocity = f"{period / math.pi!r} m/s"
    for build, build_known, size in (
        (GroundMotion.type_a_pulse, GroundMotion.sine_pulse, 1.0),
        (GroundMotion.type_b_pulse, GroundMotion.cosine_pulse, 2.0),
    ):
        ours = build(velocity, f"{period!r} s").si
        theirs = build_known(f"{size} m/s^2", frequency, 1).si
        assert ours.time_step == theirs.time_step
        samples, pieces = theirs.horizontal.samples, theirs.horizontal.pieces
        assert ours.horizontal.samples == pytest.approx(samples, abs=1e-15 * size)
        assert ours.horizontal.pieces == pytest.approx(pieces, abs=1e-14 * size)


def test_cosine_is_a_harmonic_of_a_quarter_turn():
    cosine = GroundMotion.cosine_pulse("2 m/s^2", "1.5 Hz", 3)
    assert cosine.si.digest == GroundMotion.harmonic("2 m/s^2", "1.5 Hz", "2 s", "90 deg").si.digest
    assert cosine.si.horizontal.samples[[0, 64, -1]].tolist() == [2.0, -2.0, 2.0]


@pytest.mark.parametrize("constructor", PULSES)
def test_the_opposite_amplitude_is_the_opposite_motion(constructor):
    recipe = MOTIONS[constructor].to_dict()
    first = "velocity" if "velocity" in recipe else "amplitude"
    number, unit = recipe[first].split(" ", 1)
    turned = GroundMotion.from_dict({**recipe, first: f"{-float(number)!r} {unit}"})
    assert (
        turned.si.horizontal.samples.tolist()
        == (-MOTIONS[constructor].si.horizontal.samples).tolist()
    )


# invalid arguments -------------------------------------------------------------------------------

UNITS = {
    "amplitude": "1 m/s^2", "velocity": "1 m/s", "frequency": "1 Hz", "period": "1 s",
    "duration": "1 s", "interval": "1 s", "cycles": 2,
}  # fmt: skip
REQUIRED = {
    constructor: {
        name: UNITS[name]
        for name, parameter in signature(getattr(GroundMotion, constructor)).parameters.items()
        if parameter.default is parameter.empty
    }
    for constructor in PULSES
}
KINDS = {
    "amplitude": "an acceleration",
    "velocity": "a velocity",
    "frequency": "a cyclic frequency",
    "period": "a time",
    "duration": "a time",
    "interval": "a time",
    "cycles": "a pure ratio",
}
ARGUMENTS = [
    (constructor, name) for constructor, arguments in REQUIRED.items() for name in arguments
]


@pytest.mark.parametrize(("constructor", "name"), ARGUMENTS)
@pytest.mark.parametrize("wrong", ["1 kg", None])
def test_wrong_units(constructor, name, wrong):
    words = rf"^GroundMotion\.{constructor}: {name} needs {KINDS[name]}"
    with pytest.raises(UnitsError, match=words):
        getattr(GroundMotion, constructor)(**{**REQUIRED[constructor], name: wrong})


@pytest.mark.parametrize(("constructor", "name"), ARGUMENTS)
@pytest.mark.parametrize("number", ["nan", "inf", "-1", "0"])
def test_numbers_out_of_range(constructor, name, number):
    unit = REQUIRED[constructor][name].split(" ", 1)[1] if name != "cycles" else ""
    arguments = {**REQUIRED[constructor], name: f"{number} {unit}".strip()}
    if name in ("amplitude", "velocity") and number in ("-1", "0"):
        getattr(GroundMotion, constructor)(**arguments)
        return
    with pytest.raises(ComponentError, match=rf"^GroundMotion\.{constructor}: {name} must be"):
        getattr(GroundMotion, constructor)(**arguments)


@pytest.mark.parametrize(
    ("constructor", "arguments", "words"),
    [
        ("cosine_pulse", {"cycles": 1e12}, "more than can be sampled"),
        ("type_a_pulse", {"period": "1e-320 s"}, "outside what can be sampled"),
        ("type_b_pulse", {"velocity": "1e308 m/s"}, "must be finite"),
        ("type_c_pulse", {"order": 0}, "order must be a whole number from 1 to 1000, got 0"),
        ("type_c_pulse", {"order": 1001}, "order must be a whole number"),
        ("type_c_pulse", {"order": 1.5}, "order must be a whole number"),
        ("type_c_pulse", {"order": True}, "order must be a whole number"),
        ("type_c_pulse", {"order": "2"}, "order must be a whole number"),
        ("ricker_wavelet", {"antisymmetric": 1}, "antisymmetric must be True or False, got 1"),
        ("ricker_wavelet", {"antisymmetric": "no"}, "antisymmetric must be True or False"),
        ("ricker_wavelet", {"period": "1e-320 s"}, "outside what can be sampled"),
        ("mavroeidis_papageorgiou_pulse", {"cycles": 0.99}, "cycles must be at least 1"),
        ("mavroeidis_papageorgiou_pulse", {"cycles": 1e9}, "more than can be sampled"),
        ("double_impulse", {"pulse_duration": "1.01 s"}, "must not exceed interval = 1 s"),
        ("double_impulse", {"pulse_duration": "1e-12 s"}, "too short to be sampled"),
        ("double_impulse", {"pulse_duration": "1e-320 s"}, "too short to be sampled"),
        ("double_impulse", {"pulse_duration": "0 s"}, "pulse_duration must be greater than zero"),
        ("double_impulse", {"velocity": "1e308 m/s"}, "must be finite"),
    ],
)
def test_invalid_values_raise(constructor, arguments, words):
    with pytest.raises(ComponentError, match=words):
        getattr(GroundMotion, constructor)(**{**REQUIRED[constructor], **arguments})


def test_duration_and_phase_without_units_raise():
    with pytest.raises(UnitsError, match="pulse_duration needs a time"):
        GroundMotion.double_impulse("1 m/s", "1 s", 0.01)
    with pytest.raises(UnitsError, match="phase needs an angle"):
        GroundMotion.mavroeidis_papageorgiou_pulse("1 m/s", "1 Hz", 2, 0.5)


def test_a_recipe_of_another_constructor_is_refused():
    with pytest.raises(SchemaError, match=r"expected one of .*type_c_pulse"):
        GroundMotion.from_dict({"constructor": "square_pulse"})


@pytest.mark.parametrize("parts", [*range(1, 60), 333, 1000])
def test_double_impulse_length_is_robust_to_rounding(parts):
    impulse = GroundMotion.double_impulse("1 m/s", "0.37 s", f"{0.37 / parts!r} s")
    assert len(impulse) == 16 * (parts + 1) + 1
    assert GroundMotion.from_dict(impulse.to_dict()) == impulse
