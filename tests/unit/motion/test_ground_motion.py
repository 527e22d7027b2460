"""Ground motions: construction from arrays, immutability, equality, description."""

import copy
import inspect
import json
import pickle
import re
from time import thread_time

import numpy as np
import pint
import pytest
import xarray as xr

from rockframe.errors import ComponentError, SchemaError, UnitsError
from rockframe.motion import GroundMotion
from rockframe.signals import Motion, Signal

G = 9.80665
UREG = pint.get_application_registry()
VALUES = [0.0, 1.5, -2.25, 0.5, 0.125]


def motion(vertical=None, **options):
    up = None if vertical is None else (vertical, "m/s^2")
    return GroundMotion.from_arrays((VALUES, "m/s^2"), "0.01 s", up, **options)


@pytest.mark.parametrize(
    "acceleration",
    [
        (VALUES, "m/s^2"),
        (tuple(VALUES), "m/s^2"),
        (np.array(VALUES), "m/s^2"),
        (np.array(VALUES, dtype=np.float32), "m s^-2"),
        (np.array(VALUES[::-1])[::-1], "m/s^2"),
        UREG.Quantity(np.array(VALUES), "m/s^2"),
        UREG.Quantity(VALUES, "m/s^2"),
        xr.DataArray(VALUES, dims="time", attrs={"units": "m s^-2"}),
        xr.DataArray(VALUES, dims="time", attrs={"units": "m s-2"}),
        xr.DataArray(VALUES, dims="time", attrs={"units": "m/s2"}),
        xr.DataArray(UREG.Quantity(np.array(VALUES), "m/s^2"), dims="time"),
    ],
)
def test_accepted_arrays(acceleration):
    result = GroundMotion.from_arrays(acceleration, "0.01 s")
    assert result.si.horizontal.samples.tolist() == VALUES
    assert result.si.time_step == 0.01
    assert result == motion()


@pytest.mark.parametrize(
    ("unit", "factor"), [("g_0", G), ("cm/s^2", 0.01), ("Gal", 0.01), ("mm/s**2", 1e-3)]
)
def test_units_are_converted(unit, factor):
    for acceleration in ((VALUES, unit), UREG.Quantity(np.array(VALUES), unit)):
        result = GroundMotion.from_arrays(acceleration, "10 ms")
        assert result.si.horizontal.samples == pytest.approx(np.array(VALUES) * factor, rel=1e-15)


@pytest.mark.parametrize("unit", ["g", "G", "g0"])
def test_g_is_the_acceleration_of_gravity(unit):
    expected = np.array(VALUES) * G
    for acceleration in ((VALUES, unit), xr.DataArray(VALUES, dims="time", attrs={"units": unit})):
        result = GroundMotion.from_arrays(acceleration, "10 ms")
        assert result.si.horizontal.samples == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("acceleration", "words"),
    [
        (VALUES, "a list without a unit"),
        (np.array(VALUES), "a ndarray without a unit"),
        ("1 m/s^2", "which is one value"),
        (VALUES[0], "a float without a unit"),
        (None, "a NoneType without a unit"),
        ((VALUES, 3), "a tuple without a unit"),
        ((VALUES, "gal"), "write for example acceleration=.values, 'cm/s.2'."),
        ((VALUES, "cm/s2"), "write for example acceleration=.values, 'cm/s.2'."),
        ((VALUES, "m/s"), "needs the unit of an acceleration such as m s"),
        ((VALUES, "nonsense"), "got 'nonsense'"),
        (UREG.Quantity(np.array(VALUES), "m"), "needs an acceleration"),
        (xr.DataArray(VALUES, dims="time"), "without a 'units' attribute"),
        (xr.DataArray(VALUES, dims="time", attrs={"units": "kg"}), "got 'kg'"),
    ],
)
def test_arrays_without_a_right_unit_are_refused(acceleration, words):
    with pytest.raises(UnitsError, match=words) as caught:
        GroundMotion.from_arrays(acceleration, "0.01 s")
    assert "GroundMotion.from_arrays: acceleration" in str(caught.value)


@pytest.mark.parametrize(
    ("acceleration", "words"),
    [
        (([0.0, float("nan"), 1.0], "m/s^2"), "finite, got nan at index 1"),
        (([0.0, 1.0, float("inf")], "m/s^2"), "finite, got inf at index 2"),
        (([1e308, 1e308], "km/s^2"), "finite"),
        (([1.0], "m/s^2"), "at least two samples"),
        (([], "m/s^2"), "at least two samples"),
        ((1.0, "m/s^2"), "one-dimensional"),
        ((np.zeros((2, 3)), "m/s^2"), "one-dimensional.*2 dimensions"),
        (([[1.0], [1.0, 2.0]], "m/s^2"), "one-dimensional"),
        ((["a", "b"], "m/s^2"), "real numbers"),
        (([True, False], "m/s^2"), "real numbers"),
        (([1j, 2j], "m/s^2"), "real numbers"),
        (([None, 1.0], "m/s^2"), "real numbers"),
        ((np.ma.masked_array(VALUES, mask=[0, 1, 0, 0, 0]), "m/s^2"), "masked"),
    ],
)
def test_arrays_that_are_no_samples_are_refused(acceleration, words):
    with pytest.raises(ComponentError, match=words):
        GroundMotion.from_arrays(acceleration, "0.01 s")


@pytest.mark.parametrize("time_step", [0.01, "0.01", "0.01 m", "1 Hz", None])
def test_time_step_without_a_right_unit(time_step):
    with pytest.raises(UnitsError, match="time_step needs a time"):
        GroundMotion.from_arrays((VALUES, "m/s^2"), time_step)


@pytest.mark.parametrize("time_step", ["0 s", "-1 s", "nan s", "inf s"])
def test_time_step_out_of_range(time_step):
    with pytest.raises(ComponentError, match="time_step must be"):
        GroundMotion.from_arrays((VALUES, "m/s^2"), time_step)


def test_vertical_of_another_length():
    with pytest.raises(ComponentError, match=r"5 samples, vertical 2.*with_vertical"):
        GroundMotion.from_arrays((VALUES, "m/s^2"), "0.01 s", ([1.0, 2.0], "m/s^2"))


def test_a_time_axis_that_contradicts_the_time_step():
    array = xr.DataArray(
        VALUES, dims="time", coords={"time": np.arange(5) * 0.02}, attrs={"units": "m s-2"}
    )
    assert GroundMotion.from_arrays(array, "0.02 s").si.time_step == 0.02
    with pytest.raises(ComponentError, match=r"step 0\.02 s, but time_step is 0\.01 s"):
        GroundMotion.from_arrays(array, "0.01 s")


def test_public_properties_are_quantities_of_the_application_registry():
    record = motion(vertical=VALUES[::-1])
    assert record.time_step == UREG.Quantity(0.01, "s")
    assert record.duration == UREG.Quantity(0.04, "s")
    assert record.peak_acceleration == UREG.Quantity(2.25, "m/s^2")
    scaled = record.scaled(peak_velocity="0.3 m/s")
    assert scaled.peak_velocity.m_as("m/s") == pytest.approx(0.3, rel=1e-12)
    assert record.acceleration.m_as("cm/s^2") == pytest.approx(np.array(VALUES) * 100.0)
    assert record.vertical_acceleration.m_as("m/s^2").tolist() == VALUES[::-1]
    assert motion().vertical_acceleration is None
    assert len(record) == 5


def test_arrays_are_own_read_only_contiguous_float64():
    source = np.array(VALUES)
    record = GroundMotion.from_arrays((source, "m/s^2"), "0.01 s", (source, "m/s^2"))
    pulse = GroundMotion.sine_pulse()
    source[:] = 7.0
    assert record.si.horizontal.samples.tolist() == VALUES
    for array in (
        record.si.horizontal.samples,
        record.si.vertical.samples,
        pulse.si.horizontal.pieces,
        record.si.horizontal.pieces,
    ):
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_changing_a_quantity_leaves_the_motion_alone():
    record = motion()
    record.acceleration.magnitude[:] = 7.0
    assert record == motion()


def test_the_motion_cannot_be_changed():
    record = motion()
    with pytest.raises(AttributeError, match="immutable"):
        record.name = "other"
    with pytest.raises(AttributeError, match="immutable"):
        record.anything = 1
    with pytest.raises(AttributeError, match="immutable"):
        del record.si
    with pytest.raises(TypeError):
        record.metadata["event"] = "other"
    with pytest.raises(AttributeError):
        record.si.time_step = 1.0


def test_equality_and_hash_go_by_content():
    assert motion() == motion()
    assert hash(motion()) == hash(motion())

    class Measured(GroundMotion):
        __slots__ = ()

    assert Measured(motion().si, name="one") == GroundMotion(motion().si, name="one")
    assert hash(Measured(motion().si, name="one")) == hash(motion())
    others = [
        motion(name="other"),
        motion(vertical=VALUES),
        motion().scaled(1),
        GroundMotion.from_arrays((VALUES, "m/s^2"), "0.02 s"),
        GroundMotion.from_arrays(([*VALUES, 0.0], "m/s^2"), "0.01 s"),
    ]
    assert all(other != motion() for other in others)
    assert motion() != "a motion"
    assert len({motion(), motion(), *others}) == 6


def test_digest_depends_only_on_simulated_motion():
    assert motion().sha256 == motion(name="other").sha256
    assert len(motion().sha256) == 64
    pulse = GroundMotion.sine_pulse()
    sampled = Motion.of_samples(pulse.si.time_step, pulse.si.horizontal.samples)
    digests = {
        motion().sha256,
        motion(vertical=VALUES).sha256,
        pulse.sha256,
        GroundMotion(sampled).sha256,
        GroundMotion(Motion.of_samples(0.02, motion().si.horizontal.samples)).sha256,
        GroundMotion(Motion.of_samples(0.01, np.append(VALUES, 0.0))).sha256,
    }
    assert len(digests) == 6


def test_digest_does_not_depend_on_the_run():
    assert motion().sha256 == ("e232ee31eab2dfa149347365be71da80d71c66dbc14dae1317ce3a83174ff732")


def _pickled(original):
    return pickle.loads(pickle.dumps(original))  # noqa: S301


@pytest.mark.parametrize("twin", [copy.copy, copy.deepcopy, _pickled])
@pytest.mark.parametrize("original", [motion(vertical=VALUES, name="x"), GroundMotion.sine_pulse()])
def test_copies_are_equal_and_read_only(original, twin):
    other = twin(original)
    assert other == original
    assert other.to_dict() == original.to_dict()
    assert not other.si.horizontal.samples.flags.writeable
    with pytest.raises(AttributeError, match="immutable"):
        other.name = "other"


def test_only_public_names_are_shown():
    import rockframe.motion

    inner = [name for name in dir(GroundMotion) if name.startswith("_")]
    assert all(name.endswith("__") for name in inner if name != "_repr_html_")  # for notebooks
    assert dir(rockframe.motion) == [
        "GroundMotion",
        "HorizontalPair",
        "VelocityPulse",
        "formats",
        "register",
        "unregister",
    ]


def test_help_shows_constructors_and_operations():
    assert list(inspect.signature(GroundMotion).parameters)[:2] == ["si", "name"]
    assert list(inspect.signature(GroundMotion.sine_pulse).parameters) == [
        "amplitude", "frequency", "cycles",
    ]  # fmt: skip
    assert list(inspect.signature(motion().window).parameters) == ["start", "end", "taper"]
    for name, member in vars(GroundMotion).items():
        if not name.startswith("_"):
            assert inspect.getdoc(member), name


def test_a_subclass_may_have_its_own_constructor():
    class Measured(GroundMotion):
        __slots__ = ()

        def __init__(self, si, station="", **given):
            super().__init__(si, **{"metadata": {"station": station}, **given})

    record = Measured(motion().si, "A", name="own")
    assert record.metadata["station"] == "A"
    assert type(record.scaled(2)) is Measured
    assert type(Measured.sine_pulse()) is Measured
    assert list(inspect.signature(Measured).parameters) == ["si", "station", "given"]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (GroundMotion, "write GroundMotion.read(path), GroundMotion.from_arrays("),
        (
            lambda: GroundMotion(acceleration=[0.0, 1.0], time_step="0.01 s"),
            "GroundMotion: it is not built by calling the class; write GroundMotion.read(path)",
        ),
        (
            lambda: GroundMotion.stochastic(6.5, "5 km"),
            "stochastic() missing 1 required positional argument: 'seed'",
        ),
        (lambda: GroundMotion.sine_pulse(cycle=1), "sine_pulse() got"),
        (lambda: GroundMotion.sine_pulse().resampled(), "resampled() missing"),
    ],
)
def test_invalid_calls_raise_type_error(call, words):
    with pytest.raises(TypeError, match=re.escape(words)):
        call()


def test_path_in_place_of_motion_or_dataset_raises():
    with pytest.raises(ComponentError, match=r"found 'x\.AT2'; write GroundMotion\.read\(path\)"):
        GroundMotion("x.AT2")
    words = r"GroundMotion\.from_dataset: found 'run\.nc'; .*xr\.open_dataset first"
    with pytest.raises(SchemaError, match=words):
        GroundMotion.from_dataset("run.nc")


def test_methods_survive_pickling():
    for method in (GroundMotion.resampled, GroundMotion.stochastic):
        assert _pickled(method) == method


def test_repr_summarises_motion():
    assert repr(motion(name="test")) == (
        "<GroundMotion 'test': 5 samples at 0.01 s, 0.04 s long, peak 2.25 m/s^2>"
    )
    assert "with vertical" in repr(motion(vertical=VALUES))
    assert repr(motion(name="test").scaled(-2.0)).startswith("<GroundMotion '-2 times test': ")


def test_names_and_history_stay_on_one_line():
    record = GroundMotion(motion().si, name=" two\nlines\x00", history=("a\nb",))
    assert record.name == "two lines"
    assert record.history == ("a b",)
    assert GroundMotion(motion().si, name="\n").name == "unnamed motion"


def test_processing_time_does_not_grow_with_history():
    def least(history):
        record = GroundMotion(motion().si, history=history)
        times = []
        for _ in range(20):
            began = thread_time()
            for factor in range(50):
                record.scaled(1.0 + factor)
            times.append(thread_time() - began)
        return min(times)

    long = tuple(f"step {k} of what was done to the samples of a record" for k in range(30))
    assert least(long) < 2.0 * least(())


@pytest.mark.parametrize("value", [None, True, [1], {"a": 1}])
def test_metadata_are_strings_and_numbers(value):
    with pytest.raises(ComponentError, match="metadata 'key' must be"):
        GroundMotion(motion().si, metadata={"key": value})


@pytest.mark.parametrize("value", [np.int64(30), np.float32(30.5), np.float64(30.5)])
def test_numbers_of_arrays_are_metadata(value):
    """As taken from a table."""
    record = GroundMotion(motion().si, metadata={"azimuth": value})
    assert record.metadata["azimuth"] == value
    assert GroundMotion.from_dataset(record.to_dataset()) == record


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"time_step": 0.0}, "time_step"),
        ({"time_step": float("nan")}, "time_step"),
        ({"samples": [0.0]}, "acceleration needs at least two samples, got 1"),
        ({"samples": np.zeros((4, 2))}, "acceleration needs one dimension, got the shape"),
        ({"polynomials": np.zeros((5, 6))}, "GroundMotion: pieces needs the shape"),
        ({"polynomials": np.zeros((4, 5))}, "GroundMotion: pieces needs the shape"),
        ({"polynomials": np.full((4, 6), np.nan)}, "pieces must be finite"),
        ({"samples": [0.0, np.inf], "name": "vertical"}, "vertical must be finite"),
        ({"polynomials": np.zeros((5, 6)), "name": "vertical"}, "vertical_pieces needs the shape"),
    ],
)
def test_inconsistent_signal_arguments_raise(arguments, words):
    with pytest.raises(ComponentError, match=words):
        Signal(**{"time_step": 0.01, "samples": np.array(VALUES), **arguments})


@pytest.mark.parametrize(
    ("vertical", "words"),
    [
        (Signal(0.01, np.zeros(4)), r"vertical needs the shape \(5,\), got the shape \(4,\)"),
        (Signal(0.02, np.zeros(5)), "vertical needs the time step 0.01 s, got 0.02 s"),
    ],
)
def test_inconsistent_components_raise(vertical, words):
    with pytest.raises(ComponentError, match=words):
        Motion(Signal(0.01, np.array(VALUES)), vertical)


def test_acceleration_is_linear_between_samples_and_zero_outside():
    si = motion(vertical=VALUES[::-1]).si
    assert si.at([0.0, 0.005, 0.01, 0.0125, 0.04]) == pytest.approx(
        [0.0, 0.75, 1.5, 0.5625, 0.125], abs=1e-14
    )
    assert si.at([-1e-9, 0.04 + 1e-9, 7.0]).tolist() == [0.0, 0.0, 0.0]
    assert si.vertical.at(0.005) == pytest.approx(0.3125)
    assert motion().si.vertical is None
    assert si.vertical.peak == 2.25


def test_description_without_samples_requires_record():
    record = motion(name="test")
    description = json.loads(json.dumps(record.to_dict()))
    assert description == {
        "type": "GroundMotion",
        "constructor": None,
        "name": "test",
        "sha256": record.sha256,
    }
    with pytest.raises(SchemaError, match=f"test.*{record.sha256}.*read the record"):
        GroundMotion.from_dict(description)


PULSE = GroundMotion.sine_pulse()
SAMPLED = [
    GroundMotion(motion().si, name="test", metadata={"station": "A", "azimuth": 30.0}),
    motion(vertical=VALUES[::-1]).scaled(0.5),
    GroundMotion(PULSE.si, name="without its recipe"),
    GroundMotion(Motion(PULSE.si.horizontal, PULSE.scaled(0.3).si.horizontal)),
]


@pytest.mark.parametrize("original", SAMPLED)
def test_a_record_described_with_its_samples_is_built_again(original):
    description = json.loads(json.dumps(original.to_dict(samples=True), allow_nan=False))
    rebuilt = GroundMotion.from_dict(description)
    assert rebuilt == original
    assert rebuilt.to_dict(samples=True) == original.to_dict(samples=True)
    assert description.items() >= original.to_dict().items()
    assert GroundMotion.sine_pulse().to_dict(samples=True) == GroundMotion.sine_pulse().to_dict()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"time_step": 0.02}, "samples that differ from those of the digest 'sha256'"),
        ({"time_step": None}, "holds no ground motion"),
        ({"horizontal": None}, "holds no ground motion"),
        ({"horizontal": {}}, "holds no ground motion"),
        ({"horizontal": {"samples": ["much", "little"]}}, "holds no ground motion"),
        ({"vertical": {"samples": [0.0, 1.0]}}, "vertical needs the shape"),
        ({"metadata": {"key": None}}, "metadata 'key' must be"),
        ({"history": 3}, "holds no ground motion"),
    ],
)
def test_samples_that_were_damaged_are_refused(changes, words):
    with pytest.raises(SchemaError, match=words):
        GroundMotion.from_dict({**motion().to_dict(samples=True), **changes})


@pytest.mark.parametrize(
    "original",
    [
        GroundMotion.sine_pulse(),
        GroundMotion.sine_pulse("0.3 g_0", "0.7 Hz", 2.5),
        GroundMotion.harmonic("10 cm/s^2", "0.3 Hz", "7.1 s"),
        GroundMotion.harmonic("10 cm/s^2", "0.3 Hz", "7.1 s", "30 deg"),
    ],
)
def test_description_of_a_pulse_builds_it_again(original):
    description = json.loads(json.dumps(original.to_dict()))
    assert GroundMotion.from_dict(description) == original


@pytest.mark.parametrize(
    "changed",
    [
        lambda m: m.scaled(2),
        lambda m: m.scaled(peak="0.2 g_0"),
        lambda m: m.window("0 s", "0.5 s"),
        lambda m: m.resampled("0.003 s"),
        lambda m: m.filtered(low="0.2 Hz", high="20 Hz", order=2),
        lambda m: m.resampled("0.003 s", interpolation="linear"),
        lambda m: m.window(taper="0.1 s"),
        lambda m: m.filtered(high="20 Hz", causal=True),
        lambda m: m.scaled(peak_velocity="1 m/s"),
        lambda m: m.scaled(spectral_acceleration="1 m/s^2", period="0.5 s"),
        lambda m: m.scaled(
            spectral_acceleration="1 m/s^2", period="0.333333333 s", damping_ratio=0.2
        ),
        lambda m: m.scaled(0.5).resampled("0.02 s").resampled("0.003 s", interpolation="linear"),
        lambda m: m.rotated(m.scaled(2), "10 deg"),
        lambda m: m.baseline_corrected(0),
        lambda m: m.baseline_corrected(2, fit="velocity"),
        lambda m: m.scaled(0.1).with_vertical(m.scaled(0.3).window("0 s", "0.5 s")).scaled(2),
        lambda m: m.with_vertical(m.scaled(0.3)).with_vertical(None).scaled(2),
    ],
)
def test_description_rebuilds_processed_pulse(changed):
    motion = changed(GroundMotion.sine_pulse())
    description = json.loads(json.dumps(motion.to_dict()))
    assert GroundMotion.from_dict(description) == motion
    assert GroundMotion.from_dataset(motion.to_dataset()).to_dict() == motion.to_dict()


def test_pulse_with_recorded_vertical_has_no_constructor():
    record = GroundMotion.from_arrays(([0.0, 1.0, 0.0], "m/s^2"), "0.0078125 s")
    motion = GroundMotion.sine_pulse().with_vertical(record)
    assert motion.to_dict()["constructor"] is None


@pytest.mark.parametrize(
    "description",
    [
        {},
        {"constructor": "read", "path": "/etc/passwd"},
        {"constructor": "sine_pulse", "colour": "red"},
        {"constructor": "harmonic"},
        {"constructor": "sine_pulse", "operations": [{"to_dataset": {}}]},
        {"constructor": "sine_pulse", "operations": [{"scaled": {"colour": "red"}}]},
        {"constructor": "sine_pulse", "operations": ["scaled"]},
        {"constructor": "sine_pulse", "operations": {"scaled": {"factor": 2}}},
        {"constructor": "sine_pulse", "operations": [{"scaled": {"factor": 2}, "window": {}}]},
        {"constructor": "sine_pulse", "operations": [{"scaled": [2]}]},
    ],
)
def test_invalid_descriptions_are_refused(description):
    words = (
        "^found (only a description|the (constructor|operation) ['{]|(the )?arguments (that do not "
        "fit|of the operation))"
    )
    with pytest.raises(SchemaError, match=words):
        GroundMotion.from_dict(description)
