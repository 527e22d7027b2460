"""Messages for natural but wrong usage name the argument and show its correct form."""

import gzip
import logging
import re
import runpy
import sys
import zipfile
from inspect import signature
from pathlib import Path
from types import FunctionType

import numpy as np
import pytest

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import (
    OWNERS_BY_ARGUMENT,
    AssemblyError,
    ModelWarning,
    RecordError,
    SchemaError,
    UnitsError,
)

pytestmark = pytest.mark.unit

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PULSE = rf.GroundMotion.sine_pulse("-3 m/s^2")


class Quantity:
    """A quantity as in astropy."""

    __module__ = "astropy.units.quantity"

    def __init__(self, value, unit):
        self.value, self.unit = value, unit


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


def block(**changed):
    return rf.Block(**{"width": "1 m", "height": "4 m", "mass": "5 t", **changed})


def system():
    return rf.System(block(), pads())


MISTAKES = {
    "a system where a comparison is needed": (
        lambda: rf.recommend(system(), 0.1),
        SchemaError,
        ["rockframe.tradeoff(system, motion)"],
    ),
    "a quantity of another library": (
        lambda: block(width=Quantity(1.0, "m")),
        UnitsError,
        ["width", "a Quantity of astropy", "(q.value, str(q.unit))"],
    ),
    "an array of another library": (
        lambda: rf.GroundMotion.from_arrays(Quantity(np.zeros(5), "m/s2"), "0.01 s"),
        UnitsError,
        ["acceleration", "a Quantity of astropy"],
    ),
    "a file for a motion": (
        lambda: system().simulate("x.AT2"),
        AssemblyError,
        ["GroundMotion.read('x.AT2')"],
    ),
    "a path for a motion": (
        lambda: system().simulate(Path("x.AT2")),
        AssemblyError,
        ["GroundMotion.read('x.AT2')"],
    ),
    "samples for a motion": (
        lambda: system().simulate(np.zeros(5)),
        AssemblyError,
        ["GroundMotion.from_arrays("],
    ),
    "an angle for a start": (
        lambda: system().simulate(PULSE, initial="0.1 rad"),
        AssemblyError,
        ["InitialState(rotation='0.1 rad')"],
    ),
    "a period for a frequency": (
        lambda: rf.GroundMotion.sine_pulse(frequency="0.5 s"),
        UnitsError,
        ["a period; its frequency is '2 Hz'"],
    ),
    "samples without a time step": (
        lambda: rf.GroundMotion.from_arrays((np.zeros(5), "m/s^2")),
        UnitsError,
        ["time_step needs a time with a unit", "time_step='0.01 s'"],
    ),
    "samples without anything": (
        lambda: rf.GroundMotion.from_arrays(np.zeros(5)),
        UnitsError,
        ["acceleration=(values, 'm/s^2')"],
    ),
    "damping of a run": (
        lambda: system().simulate(PULSE, damping=0.05),
        TypeError,
        ["'damping'", "TwoSpringSupport(damping_ratio=0.1)"],
    ),
    "the time step of a run": (
        lambda: system().simulate(PULSE, time_step="0.01 s"),
        TypeError,
        ["output_step", "accuracy"],
    ),
    "a subgrade modulus for a stiffness": (
        lambda: rf.WinklerSoil(stiffness="20 MN/m^3", damping_ratio=0.2),
        UnitsError,
        ["WinklerSoil.from_subgrade_modulus("],
    ),
    "a subgrade modulus by its name": (
        lambda: rf.WinklerSoil(subgrade_modulus="20 MN/m^3", damping_ratio=0.2),
        TypeError,
        ["which WinklerSoil.from_subgrade_modulus can take"],
    ),
    "an option of a system as an argument of a part": (
        lambda: rf.RigidGround(inclination="3 deg"),
        TypeError,
        ["'inclination', which System can take"],
    ),
    "an argument of another constructor of the class": (
        lambda: rf.Block(radius="2 m", slenderness=4, mass="1 t"),
        TypeError,
        ["'radius', which Block.from_size can take. It takes width"],
    ),
    "a peak as a factor": (
        lambda: PULSE.scaled("0.3 g_0"),
        UnitsError,
        ["write for example factor=2, or peak='0.3 g_0'"],
    ),
    "an argument of a run as one of a system": (
        lambda: rf.System(rf.Block(width="1 m", height="4 m", mass="1 t"), accuracy="fast"),
        TypeError,
        ["'accuracy', which System.simulate can take"],
    ),
    "an argument of bases as one of a block": (
        lambda: rf.Block(width="1 m", height="4 m", mass="1 t", friction=0.3),
        TypeError,
        ["'friction', which RigidGround, TwoSpringSupport, WinklerSoil"],
    ),
    "an argument of bases as one of a run": (
        lambda: system().simulate(PULSE, friction=0.3),
        TypeError,
        ["'friction', which RigidGround, TwoSpringSupport, WinklerSoil"],
    ),
    "an argument that nothing has": (
        lambda: system().simulate(PULSE, colour="red"),
        TypeError,
        ["unexpected keyword argument 'colour'"],
    ),
}


def test_each_option_of_a_system_is_known_as_one():
    of_systems = {name for name, owners in OWNERS_BY_ARGUMENT.items() if "System" in owners}
    parameters = signature(rf.System).parameters.values()
    assert of_systems == {one.name for one in parameters if one.kind is one.KEYWORD_ONLY}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_error_message_suggests_the_correct_usage(mistake):
    call, kind, words = MISTAKES[mistake]
    with pytest.raises(kind) as caught:
        call()
    for each in words:
        assert each in str(caught.value)


def test_archives_of_several_files_are_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "two.zip", "w") as archive:
        for name in ("a.csv", "b.csv"):
            archive.writestr(name, "time (s),acceleration (g)\n0,0\n0.01,0.1\n0.02,-0.1\n")
    with pytest.raises(RecordError, match=r"several files, a\.csv, b\.csv.*read_suite"):
        rf.GroundMotion.read(tmp_path / "two.zip")
    with zipfile.ZipFile(tmp_path / "one.zip", "w") as archive:
        archive.writestr("a.csv", "time (s),acceleration (g)\n0,0\n0.01,0.1\n0.02,-0.1\n")
    assert len(rf.GroundMotion.read(tmp_path / "one.zip")) == 3
    (tmp_path / "some.gz").write_bytes(gzip.compress(b"\x00\x01binary"))
    with pytest.raises(RecordError) as caught:
        rf.GroundMotion.read(tmp_path / "some.gz")
    assert "some.gz/some" in str(caught.value)


def test_filter_corners_may_be_positional():
    motion = rf.GroundMotion.stochastic(6, "10 km", seed=1)
    assert motion.filtered("0.1 Hz", "25 Hz") == motion.filtered(low="0.1 Hz", high="25 Hz")
    assert motion.filtered("0.1 Hz") != motion.filtered(high="0.1 Hz")


def test_number_and_unit_pairs_are_quantities():
    assert block(width=(1, "m")) == block(width=(np.float32(1.0), "m")) == block()
    assert rf.System(block(), gravity=(0.5, "g_0")) == rf.System(block(), gravity="0.5 g_0")
    assert block(centre_of_mass=((2, "m"), (1, "cm"))) == block(centre_of_mass=("2 m", "1 cm"))
    given, same = (motion.scaled(peak=peak) for motion, peak in
                   ((PULSE, (0.3, "g_0")), (PULSE, "0.3 g_0")))  # fmt: skip
    assert given == same
    for bad in ((1, "kg"), (True, "m"), ("1", "m"), (1, 2), (1, "m", "m"), ([1, 2], "m")):
        with pytest.raises(UnitsError, match="width"):
            block(width=bad)


def test_contradictory_depths_warn():
    def soil(depth, **arguments):
        return rf.WinklerSoil.from_subgrade_modulus(
            "20 MN/m^3", depth=depth, damping_ratio=0.2, **arguments
        )

    def frame(depth):
        return rf.FrameEquivalent.from_members(
            storeys=3, width="4 m", height="9 m", depth=depth, column_width="0.25 m",
            beam_height="0.30 m", beam_width="0.25 m", density="2500 kg/m^3",
        )  # fmt: skip

    with pytest.warns(ModelWarning, match="depth of 4 m, but the FrameEquivalent on it is 6 m"):
        rf.System(frame("6 m"), soil("4 m"))
    cap = rf.CushionCap(height="0.9 m", density="2500 kg/m^3", depth="5 m")
    with pytest.warns(ModelWarning, match="the CushionCap on it is 5 m deep"):
        rf.System(frame("6 m"), cap, soil("4 m"))
    rf.System(frame("4 m"), soil("4 m"))  # warnings are errors here
    rf.System(frame("6 m"), cap, soil("5 m"))
    rf.System(block(), soil("4 m"))  # the depth of a block is unknown
    assert soil("4 m").depth.m_as("m") == pytest.approx(4.0)
    assert rf.WinklerSoil(stiffness="80 MPa", damping_ratio=0.2).depth is None


@pytest.mark.parametrize(
    "name",
    [path.stem for path in sorted(EXAMPLES.glob("*.py")) if '"record' in path.read_text()],
)
def test_example_without_its_file_exits_with_one_line(name, tmp_path, monkeypatch, capsys):
    file = str(EXAMPLES / f"{name}.py")
    monkeypatch.setattr(sys, "argv", [file, "none.AT2", "--folder", str(tmp_path)])
    with pytest.raises(SystemExit) as left:
        runpy.run_path(file, run_name="__main__")
    assert left.value.code == 1
    assert re.fullmatch(rf"{name}: none\.AT2: .*\n", capsys.readouterr().err)


@pytest.mark.skipif(not COMPILED, reason="this run does without compilation")
def test_unwritable_cache_folder_is_logged_once(tmp_path, monkeypatch, caplog):
    own = tmp_path / "own_entries.py"
    own.write_text(
        "from rockframe.compiled import Vector, entry\n\n"
        "@entry\ndef add_one(values: Vector) -> None:\n    values[0] += 1.0\n\n"
        "@entry\ndef add_two(values: Vector) -> None:\n    values[0] += 2.0\n"
    )
    taken = tmp_path / "a file"
    taken.write_text("")
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(taken / "code"))
    monkeypatch.syspath_prepend(str(tmp_path))
    values = np.zeros(1)
    with caplog.at_level(logging.WARNING, logger="rockframe"):
        import own_entries

        own_entries.add_one(values)
        own_entries.add_two(values)
    assert values.tolist() == [3.0]
    messages = [one.getMessage() for one in caplog.records]
    assert len(messages) == 1
    assert str(taken) in messages[0]
    assert "ROCKFRAME_CACHE_DIR" in messages[0]


PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
MISSPELT = {
    "a part's parameter": (lambda: rf.Block(widht="1 m"), "'widht'; was 'width' meant?"),
    "a base's": (lambda: rf.TwoSpringSupport(frequency_ration=40), "was 'frequency_ratio' meant?"),
    "of a copy": (lambda: PADS.replace(dampin_ratio=0.2), "was 'damping_ratio'"),
    "of another constructor": (lambda: rf.Block.from_outline([], units="m"), "was 'unit' meant?"),
    "of a stack": (lambda: rf.Stack(interface=[]), "was 'interfaces' meant?"),
    "of a link": (lambda: rf.Restrainer(stiffnes="1 kN/m"), "was 'stiffness' meant?"),
    "of a system": (lambda: rf.System(restrain="centre"), "was 'restraint'"),
    "an option": (lambda: rf.System(BLOCK, restraint="center"), "was 'centre' meant?"),
    "of a run": (lambda: SYSTEM.simulate(SHAKING, accuracies="fast"), "was 'accuracy' meant?"),
    "an output": (lambda: SYSTEM.simulate(SHAKING, outputs=["energis"]), "was 'energy' meant?"),
    "a level": (lambda: SYSTEM.simulate(SHAKING, accuracy="standrad"), "was 'standard' meant?"),
    "of a pulse": (lambda: rf.GroundMotion.sine_pulse(amplitde="1 g"), "was 'amplitude' meant?"),
    "of a record": (lambda: rf.GroundMotion.read("x", units="g"), "was 'unit' meant?"),
    "of an operation": (lambda: SHAKING.scaled(factr=2), "was 'factor' meant?"),
    "of a suite": (lambda: rf.read_suite("x", unti="g"), "was 'unit' meant?"),
    "a measure": (
        lambda: rf.critical_scale(SYSTEM, SHAKING, intensity="peak_ground_acc"),
        "was 'peak_ground_acceleration'",
    ),
    "a table": (lambda: rf.table(None, "scalar"), "was 'scalars' meant?"),
}
BLOCK = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
SYSTEM = rf.System(BLOCK)
SHAKING = rf.GroundMotion.sine_pulse("0.3 g", "1 Hz")


@pytest.mark.parametrize("name", MISSPELT)
def test_misspelt_names_get_a_suggestion(name):
    misspelt, words = MISSPELT[name]
    with pytest.raises((TypeError, rf.errors.RockframeError)) as caught:
        misspelt()
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "name", ["pga", "Pga", "peak ground acceleration", "Peak Ground Acceleration"]
)
def test_measure_names_are_case_insensitive(name):
    found = rf.critical_scale(SYSTEM, SHAKING, intensity=name, largest=1, scales=2, runs=2)
    assert found.attrs["intensity"] == "peak_ground_acceleration"
    runs = rf.sweep(SYSTEM, [SHAKING, SHAKING.scaled(2)], scale=[1, 2])
    assert rf.fragility(runs, name).sizes["peak_ground_acceleration"] > 1


def _named(owner, name):
    """Return public functions and methods with their names."""
    for one in dir(owner):
        found = None if one.startswith("_") else getattr(owner, one)
        if isinstance(found, FunctionType):
            yield f"{name}.{one}", found


TAKING = dict(
    pair
    for owner, name in (
        (rf, "rf"), (rf.plot, "rf.plot"), (rf.measures, "rf.measures"), (rf.export, "rf.export"),
        (rf.codes, "rf.codes"),
    )
    for pair in _named(owner, name)
)  # fmt: skip
TAKING |= {
    f"{kind.__name__}.{method}": getattr(kind, method)
    for kind, methods in (
        (rf.MotionSuite, "response_spectrum rotated_spectrum sort scaling_to selection_for"),
        (rf.TargetSpectrum, "eurocode_8 asce_7 from_table from_spectrum at with_deviation"),
        (rf.GroundMotion, "read example from_arrays from_frame window scaled filtered to_at2"),
        (rf.Block, "from_density from_size from_outline cylinder"),
        (rf.System, "simulate moment_rotation"),
    )
    for method in methods.split()
}


def _last_argument(function):
    """Return a named argument, or None if the function takes any name."""
    parameters = signature(function).parameters.values()
    if any(one.kind is one.VAR_KEYWORD for one in parameters):
        return None
    named = [
        one.name for one in parameters if one.kind in (one.KEYWORD_ONLY, one.POSITIONAL_OR_KEYWORD)
    ]
    return next((one for one in reversed(named) if len(one) > 4), None)


@pytest.mark.parametrize("name", [one for one in TAKING if _last_argument(TAKING[one])])
def test_every_function_answers_a_misspelt_argument(name):
    meant = _last_argument(TAKING[name])
    with pytest.raises(TypeError) as caught:
        TAKING[name](**{f"{meant[:-2]}{meant[-1]}{meant[-2]}x": 1})
    assert meant in str(caught.value).split(" It takes ")[0].split("meant?")[0]
    assert "meant?" in str(caught.value)


def test_misspelt_keys_of_suites_and_examples_get_a_suggestion():
    suite = rf.MotionSuite({"first": SHAKING, "second": SHAKING.scaled(2.0)})
    assert "frist" not in suite
    for key, words in (
        (lambda: suite["frist"], "was 'first' meant?"),
        (lambda: suite.select(magnitud=(6, 8)), "was 'magnitude' meant?"),
        (lambda: rf.GroundMotion.example("loma-preta"), "was 'loma-prieta' meant?"),
        (
            lambda: rf.overturning_map(
                SYSTEM, "sine_pulse", amplitude=["1 m/s^2"], frequency=["1 Hz"]
            ),
            "such as rf.GroundMotion.sine_pulse",
        ),
    ):
        with pytest.raises((KeyError, rf.errors.RockframeError)) as caught:
            key()
        assert words in str(caught.value)
