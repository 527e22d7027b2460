"""Cases that run together in lanes equal single runs bit for bit."""

import math
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
import xarray as xr
from unit.own_parts import TabulatedPads

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import ModelWarning
from rockframe.studies.sweeps import lanes as in_lanes
from rockframe.studies.sweeps import study
from rockframe.studies.sweeps.planning import plan_study

pytestmark = [
    pytest.mark.skipif(not COMPILED, reason="lanes are compiled"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.5 m", mass="2 t", width="1.2 m")
SOIL = rf.WinklerSoil(stiffness="6 MPa", damping_ratio=0.2)
SLENDER = {"slenderness": [1.5, 3.0, 6.0], "radius": (["0.7 m", "4 m"])}


def record(seed, count=260, step="0.02 s", *, vertical=False):
    rng = np.random.default_rng(seed)
    x, y = (np.convolve(rng.normal(size=count), np.ones(4) / 4, "same") for _ in range(2))
    upwards = (4 * y, "m/s^2") if vertical else None
    return rf.GroundMotion.from_arrays((9 * x, "m/s^2"), step, vertical=upwards, name=f"{seed}")


MOTIONS = [
    record(1),
    record(2, vertical=True),
    record(3, count=150, step="0.01 s"),
    rf.GroundMotion.sine_pulse("-6 m/s^2", "1.5 Hz"),
    rf.GroundMotion.double_impulse("0.8 m/s", "0.6 s"),
]


def on(*parts, **options):
    def scene(slenderness, radius):
        block = rf.Block.from_size(radius=radius, slenderness=slenderness, mass="4 t")
        return rf.System(block, *parts, **options)

    return scene


def run_both_ways(monkeypatch, *arguments, accuracy="fast", **options):
    """Run a sweep in lanes and without."""
    found = []
    monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)
    for fewest in (1, 10**9):
        monkeypatch.setattr(study, "MIN_CASES_IN_LANES", fewest)
        found.append(rf.sweep(*arguments, accuracy=accuracy, **options))
    lanes, alone = found
    assert lanes.attrs["driver"].startswith("cases side by side")
    assert alone.attrs["driver"] == "each case alone"
    return lanes, alone


def assert_same_bits(lanes, alone):
    for name, variable in alone.variables.items():
        xr.testing.assert_identical(lanes.variables[name], variable)
        if variable.dtype.kind == "f":
            assert lanes[name].values.tobytes() == variable.values.tobytes(), name


@pytest.mark.parametrize(
    ("parts", "options"),
    [
        ((), {}),
        ((PADS,), {}),
        pytest.param((PADS,), {"restraint": "leading-corner"}, marks=pytest.mark.wide),
        pytest.param((PADS,), {"rotation": "small"}, marks=pytest.mark.wide),
        # no other test compiles their lanes
        pytest.param((SOIL,), {}, marks=pytest.mark.long),
        pytest.param((PADS, CAP, SOIL), {}, marks=pytest.mark.long),
    ],
    ids=lambda parts: "-".join(str(one).split("(")[0] for one in parts) or "none",
)
def test_lanes_reproduce_single_runs(monkeypatch, parts, options):
    check_scene(monkeypatch, "fast", parts, options)


@pytest.mark.wide
@pytest.mark.parametrize(
    ("parts", "options"),
    [
        ((), {}),
        ((PADS,), {}),
        ((PADS,), {"restraint": "leading-corner"}),
        ((PADS,), {"rotation": "small"}),
        pytest.param((SOIL,), {}, marks=pytest.mark.long),
    ],
    ids=lambda parts: "-".join(str(one).split("(")[0] for one in parts) or "none",
)
@pytest.mark.parametrize("rtol", [1e-4, 2e-8])
def test_adaptive_lanes_reproduce_single_runs(monkeypatch, parts, options, rtol):
    check_scene(monkeypatch, rf.Accuracy(rtol=rtol), parts, options)


def test_lanes_reach_step_limit_like_single_runs(monkeypatch):
    system = rf.System(BLOCK, PADS)
    few = rf.Accuracy(rtol=1e-6, max_steps=700)
    lanes, alone = run_both_ways(
        monkeypatch, system, MOTIONS[:3], accuracy=few, scale=[0.2, 0.9, 1.6]
    )
    assert_same_bits(lanes, alone)
    assert (alone.status == 3).any()


def check_scene(monkeypatch, accuracy, parts, options):
    lanes, alone = run_both_ways(
        monkeypatch, on(*parts, **options), MOTIONS, axes=SLENDER, scale=[0.3, 0.8, 1.5],
        free_vibration="0.7 s", accuracy=accuracy,
    )  # fmt: skip
    assert_same_bits(lanes, alone)
    ran = alone.peak_rotation.notnull()
    assert ran.mean() > 0.3  # wide blocks on narrow caps are refused
    assert 0 < (alone.overturned == 1).sum() < ran.sum()
    assert (alone.impact_count > 0).any() or SOIL in parts


def test_lanes_leave_peaks_inside_polynomials_to_the_driver(monkeypatch):
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    motion = rf.GroundMotion.sine_pulse("0.25 g", "1 Hz", 0.7)  # no sample lies at its peak
    scales = 1.0 + np.array([-1e-6, 1e-8, 1e-6, 1e-5])
    lanes, alone = run_both_ways(monkeypatch, rf.System(block), motion, scale=scales)
    assert_same_bits(lanes, alone)
    assert (lanes.impact_count.values.ravel() > 0).tolist() == [False, True, True, True]


@pytest.mark.parametrize("course", ["stop", "continue"])
def test_lanes_continue_or_stop_after_overturning(monkeypatch, course):
    system = rf.System(BLOCK, PADS, gravity="9.81 m/s^2")
    lanes, alone = run_both_ways(
        monkeypatch, system, MOTIONS[:2], scale=np.linspace(0.2, 3.0, 7), damping_ratio=[0.0, 0.3],
        overturning=course, initial=rf.InitialState(rotation="0.03 rad"),
    )  # fmt: skip
    assert_same_bits(lanes, alone)
    assert (alone.status == (1 if course == "stop" else 2)).any()


def test_failing_cases_have_the_same_reason_in_lanes(monkeypatch):
    system = rf.System(rf.Block(width="1.2 m", height="6 m", mass="20 t"), PADS)
    heights, ratios = ["1e200 m", "1.5 m", "6 m"], [0.1, 50]
    lanes, alone = run_both_ways(
        monkeypatch, system, MOTIONS[:1], height=heights, damping_ratio=ratios
    )
    assert_same_bits(lanes, alone)
    assert (alone.status == 6).any()
    assert (alone.status == 0).any()


def test_lanes_handle_still_ground_and_inclined_bases(monkeypatch):
    lean = rf.InitialState(rotation="0.05 rad")
    lanes, alone = run_both_ways(
        monkeypatch, rf.System(BLOCK, PADS), initial=lean, duration="2 s", width=["0.7 m", "0.8 m"]
    )
    assert_same_bits(lanes, alone)
    system = rf.System(BLOCK, PADS)
    lanes, alone = run_both_ways(
        monkeypatch, system, MOTIONS[0], inclination=["0 deg", "2 deg"], scale=[0.3, 0.6]
    )
    assert_same_bits(lanes, alone)


@pytest.mark.parametrize(
    "chunk", [7, *(pytest.param(size, marks=pytest.mark.long) for size in (1, 1000))]
)
def test_lanes_do_not_depend_on_neighbours_chunks_or_executors(monkeypatch, chunk):
    monkeypatch.setattr(study, "MIN_CASES_IN_LANES", 1)
    monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)
    system = rf.System(BLOCK, PADS)
    axes = {"scale": np.linspace(0.2, 2.0, 12), "damping_ratio": [0.05, 0.2]}

    def swept(**options):
        return rf.sweep(system, MOTIONS[:3], axes=axes, accuracy="fast", **options)

    one_chunk = swept(chunk=1000)
    with ThreadPoolExecutor(8) as pool:
        assert_same_bits(swept(chunk=chunk, executor=pool), one_chunk)
    if chunk == 7:
        with ProcessPoolExecutor(2) as pool:
            assert_same_bits(swept(chunk=chunk, executor=pool), one_chunk)
    backwards = {"scale": axes["scale"][::-1], "damping_ratio": [0.2, 0.05]}
    other = rf.sweep(system, MOTIONS[:3], axes=backwards, accuracy="fast", chunk=chunk)
    assert_same_bits(other.isel(scale=slice(None, None, -1), damping_ratio=[1, 0]), one_chunk)


@pytest.mark.parametrize("accuracy", ["fast", "standard"])
@pytest.mark.parametrize(
    "parts",
    [
        (BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, friction=0.5)),
        (rf.Stack(BLOCK, BLOCK, interfaces=[rf.RigidGround(friction=0.5)]), PADS),
    ],
    ids=["friction on pads", "stack"],
)
def test_list_based_equations_are_not_prepared_for_lanes(parts, accuracy):
    """Their lanes cannot be compiled: an attempt takes some seconds, and warns."""
    planned = plan_study(rf.System(*parts), MOTIONS[0], {"scale": [1.0]}, None, accuracy=accuracy)
    case = in_lanes.CasesOfJob(planned.job(range(1)))
    assert in_lanes.prepare_lanes(*case.plan(0)) is None


@pytest.mark.parametrize("accuracy", ["fast", "standard"])
def test_small_sweeps_run_alone(accuracy):
    few = rf.sweep(rf.System(BLOCK, PADS), MOTIONS[0], scale=[0.5, 1.0], accuracy=accuracy)
    assert few.attrs["driver"] == "each case alone"


@pytest.mark.parametrize("worth", [0.0, math.inf])
def test_a_law_that_cannot_be_compiled_runs_in_plain_python(monkeypatch, fallbacks, worth):
    monkeypatch.setattr(study, "COMPILING_SHARE", worth)
    rf.register(TabulatedPads)
    system = rf.System(BLOCK, TabulatedPads(frequency_ratio=20, damping_ratio=0.1))
    options = {"accuracy": "fast", "duration": "0.03 s"}
    scales = np.linspace(2.0, 9.0, 60)
    runs = rf.sweep(system, MOTIONS[0], scale=scales, **options)
    assert runs.attrs["driver"] == "each case alone, in plain Python"
    for scale in scales[::12]:
        alone = system.simulate(MOTIONS[0].scaled(scale), outputs=None, **options)
        picked = runs.sel(scale=scale).squeeze()
        for name in ("peak_rotation", "overturned", "energy_residual", "status"):
            assert picked[name].item() == alone[name].item()
    assert all("could not be compiled" in text for text in fallbacks)
    fallbacks.clear()
    plain = rf.sweep(rf.System(BLOCK, PADS), MOTIONS[0], scale=scales, **options)
    assert plain.attrs["driver"] != runs.attrs["driver"]
    np.testing.assert_allclose(plain.peak_rotation, runs.peak_rotation, rtol=1e-9)


def test_critical_scale_works_for_an_uncompilable_law(fallbacks):
    rf.register(TabulatedPads)
    pulse = rf.GroundMotion.sine_pulse("-6 m/s^2", "2 Hz")
    found, elastic = (
        rf.critical_scale(
            rf.System(BLOCK, pads), pulse, largest=4.0, scales=4, runs=6, bracket_width=0.1,
            accuracy="fast", duration="1.2 s",
        )
        for pads in (TabulatedPads(frequency_ratio=20, damping_ratio=0.1), PADS)
    )  # fmt: skip
    assert all("could not be compiled" in text for text in fallbacks)
    fallbacks.clear()
    assert 2.0 < elastic.critical_scale < 4.0
    for name in ("critical_scale", "scale_below", "scale_above", "peak_rotation"):
        np.testing.assert_allclose(found[name], elastic[name], rtol=1e-9)
    np.testing.assert_array_equal(found.outcome, elastic.outcome)


@pytest.mark.long
def test_chunks_of_a_law_that_cannot_be_compiled_are_small(monkeypatch, fallbacks):
    rf.register(TabulatedPads)
    calls = []

    def size(self, workers, *, as_python):
        calls.append((as_python, chunk_size(self, workers, as_python=as_python)))
        return 10

    chunk_size = study.Study.chunk_size
    monkeypatch.setattr(study.Study, "chunk_size", size)
    monkeypatch.setattr(study, "processors", lambda: 1)
    for pads in (TabulatedPads(frequency_ratio=20, damping_ratio=0.1), PADS):
        for scene in (rf.System(BLOCK, pads), on(pads)):
            axes = {"slenderness": [4.0], "radius": ["4 m"]} if callable(scene) else {}
            scales = np.linspace(0.01, 0.02, 10)
            rf.sweep(scene, MOTIONS[0], axes=axes, scale=scales, duration="0.03 s")
    fallbacks.clear()
    assert [as_python for as_python, _ in calls] == [True, True, False, False]
    long = plan_study(
        rf.System(BLOCK, PADS), MOTIONS[0], {"scale": np.linspace(0.1, 2.0, 9000)}, None
    )
    assert chunk_size(long, 1, as_python=True) < 0.1 * chunk_size(long, 1, as_python=False)


def test_failure_in_preparing_lanes_warns_and_falls_back(monkeypatch):
    system = rf.System(BLOCK, PADS)
    axes = {"scale": np.linspace(0.2, 1.0, 3), "damping_ratio": [0.05, 0.2]}

    def swept():
        return rf.sweep(system, MOTIONS[0], axes=axes, accuracy="fast")

    alone = swept()

    def fails(*_, **__):
        msg = "no such lane"
        raise ZeroDivisionError(msg)

    monkeypatch.setattr(study, "MIN_CASES_IN_LANES", 1)
    monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)
    monkeypatch.setattr(in_lanes, "run_start", fails)
    message = r"in lanes failed \(ZeroDivisionError: no such lane\).*error in rockframe"
    with pytest.warns(ModelWarning, match=message):
        runs = swept()
    assert runs.attrs["driver"] == "each case alone"
    for name in ("peak_rotation", "status", "impact_count"):
        xr.testing.assert_identical(runs[name].variable, alone[name].variable)

    # an exception of a user's function is reported for its case alone
    def scene(width):
        if width > 0.9:
            raise ZeroDivisionError
        return rf.System(rf.Block(width=f"{width} m", height="3.6 m", mass="4 t"), PADS)

    monkeypatch.undo()
    monkeypatch.setattr(study, "MIN_CASES_IN_LANES", 1)
    monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)
    runs = rf.sweep(scene, MOTIONS[0], width=[0.8, 1.0], accuracy="fast")
    assert runs.status.values.ravel().tolist() == [1, 6]
    assert not any("error in rockframe" in text for text in runs.message.values.ravel())


def test_lanes_are_compiled_only_if_they_save_time(monkeypatch):
    system, calls = rf.System(BLOCK, PADS), []
    shaking = rf.GroundMotion.from_arrays((np.ones(1501), "m/s^2"), "0.02 s")

    def patience(count, **options):
        axes = {"scale": np.linspace(0.1, 2.0, count)}
        planned = plan_study(system, shaking, axes, None, **options)
        return planned.compile_timeout

    monkeypatch.setattr(study, "processors", lambda: 2)
    assert patience(15, accuracy="fast") is None
    assert patience(500, accuracy="standard", outputs=["rotation"]) is None
    assert patience(500, accuracy="fast") < 1.0
    assert patience(500, accuracy="standard") < 2.0
    assert patience(100_000, accuracy="fast") > 20.0

    def never(run, seconds):
        calls.append(seconds)
        return False

    monkeypatch.setattr(in_lanes, "can_run_in_lanes", never)
    scales = np.linspace(0.1, 0.2, 500)
    runs = rf.sweep(system, MOTIONS[3], scale=scales, accuracy="fast", duration="0.1 s")
    assert calls
    assert max(calls) < 1.0
    assert runs.attrs["driver"] == "each case alone"
