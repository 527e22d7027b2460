"""Restrainers between points of bodies and the ground."""

import math

import numpy as np
import pytest
import xarray as xr
from benchmarks.tied_runs import draw_scene
from benchmarks.tied_runs import run as run_drawn
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.events import ContactState, EventKind, LinkState
from rockframe.errors import AssemblyError, ComponentError, ModelWarning, StudyError

BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
TIE = rf.Restrainer(
    on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="200 kN/m", slack="5 mm",
    strength="5 kN", name="upper",
)  # fmt: skip
PRELOADED = rf.Restrainer(
    on=("0.5 m", "3 m"), to=("1.5 m", "3 m"), stiffness="200 kN/m", preload="1 kN"
)
PULSE = rf.GroundMotion.sine_pulse(amplitude="5 m/s^2", frequency="1 Hz")


def mirrored(tie: rf.Restrainer) -> rf.Restrainer:
    on, to = tie.on, tie.to
    return tie.replace(on=(-on[0], on[1]), to=(-to[0], to[1]))


def run(*parts, motion=PULSE, **options) -> xr.Dataset:
    return rf.System(*parts).simulate(motion, free_vibration="1 s", **options)


def imbalance(found: xr.Dataset) -> float:
    stored = found.kinetic_energy + found.potential_energy + found.elastic_energy
    lost = found.dissipated_energy + found.impact_energy + found.repinning_energy
    total = stored + lost - found.input_energy
    return float((total.max() - total.min()) / abs(found.input_energy).max())


def test_what_is_given_comes_back():
    system = rf.System(BLOCK, PADS, TIE, PRELOADED)
    assert rf.System.from_dict(system.to_dict()) == system
    assert system.parts.links == (TIE, PRELOADED)
    assert TIE.replace(brittle=False, to_body=None).brittle is False
    assert TIE.on[1].m_as("m") == 3.0
    assert "breaks at 5000 N" in " ".join(system.describe().split())


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"breaking_elongation": "5 cm"}, "has no strength"),
        (
            {"breaking_elongation": "4 mm", "strength": None},
            "breaking_elongation must exceed the slack",
        ),
        ({"preload": "1 kN"}, "a tie with slack has no preload"),
        ({"compression": True}, "a bar that pushes has no slack"),
        ({"slack": None, "preload": "6 kN"}, "is not below its strength"),
        ({"on": ("1 m",)}, "must be a point"),
        ({"brittle": 2}, "brittle must be True or False"),
        ({"on_body": 0}, "must be a whole number from 1 on"),
    ],
)
def test_what_makes_no_tie_is_refused(changes, words):
    with pytest.raises(ComponentError, match=words):
        TIE.replace(**changes)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((BLOCK, rf.RigidGround(restitution=0.9), TIE), "restitution must not be given"),
        ((BLOCK, PRELOADED.replace(preload="20 kN")), "tip body 1 to the right"),
        ((BLOCK, PADS, TIE, TIE), "two links are called 'upper'"),
        (
            (BLOCK, PADS, TIE.replace(name="restrainer_2"), TIE.replace(name=None)),
            "'restrainer_2' and 'restrainer 2', both restrainer_2 as an axis of a sweep",
        ),
        ((BLOCK, PADS, TIE.replace(on_body=2)), "there is no body 2"),
        ((BLOCK, PADS, TIE.replace(to_body=1)), "both its points are on body 1"),
        (
            (BLOCK, PADS, PRELOADED.replace(to=("0.5 m", "3 m"))),
            "its points meet, so that its preload has no direction",
        ),
        ((BLOCK, rf.Tendon(stiffness="1 MN/m", at="3 m")), "whose base ends 0.5 m beside"),
        (
            (rf.Stack(BLOCK, BLOCK, interfaces=[PADS]), rf.Tendon(stiffness="1 MN/m", depth="5 m")),
            "held in the body below, which is 4 m high; depth is 5 m",
        ),
        ((BLOCK, TIE.replace(to=("-1e200 m", "3 m"))), "larger than a computer's numbers"),
    ],
)
def test_what_makes_no_scene_is_refused(parts, words):
    with pytest.raises(AssemblyError, match=words):
        rf.System(*parts)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rotation": "small"}, "a block with restrainers needs rotation='finite'"),
        ({"inclination": "1 deg"}, "a block with restrainers stands on level ground"),
    ],
)
def test_options_without_equations_are_refused(options, words):
    with pytest.raises(AssemblyError, match=words):
        rf.System(BLOCK, PADS, TIE, **options)


@pytest.mark.parametrize(
    "link",
    [TIE.replace(on=("-0.5 m", "4.1 m")), TIE.replace(on=("-5 m", "3 m")),
     rf.Load(at=("0 m", "-0.1 m"), moving_mass="1 t")],
)  # fmt: skip
def test_a_point_outside_of_its_body_is_told(link):
    with pytest.warns(ModelWarning, match="outside of body 1, 1 m wide at its base and 4 m high"):
        rf.System(BLOCK, link)


def test_a_run_shows_each_restrainer(tmp_path):
    found = run(BLOCK, PADS, TIE, PRELOADED, outputs=("energy",))
    assert found.restrainer_force.dims == ("restrainer", "time")
    assert found.restrainer.values.tolist() == ["upper", "restrainer 2"]
    broke = found.event_kind == EventKind.RESTRAINER_FRACTURE
    assert found.event_restrainer[broke].values.tolist() == [1]
    assert int(found.broken_restrainer_count) == 1
    assert int(found.restrainer_state[0, -1]) == LinkState.BROKEN
    assert float(found.restrainer_force[0, -1]) == 0.0
    assert float(found.peak_restrainer_force[0]) == pytest.approx(5000.0, rel=1e-9)
    assert imbalance(found) < 1e-8
    assert float(found.energy_residual) < 1e-8
    found.to_netcdf(tmp_path / "tied.nc")
    with xr.open_dataset(tmp_path / "tied.nc") as stored:
        assert stored.restrainer.values.tolist() == ["upper", "restrainer 2"]
        assert rf.System.from_dataset(stored).parts.links == (TIE, PRELOADED)


def test_the_mirror_image_moves_as_the_mirror_image():
    ties = (TIE.replace(brittle=False), PRELOADED)
    found = run(BLOCK, PADS, *ties)
    other = run(BLOCK, PADS, *map(mirrored, ties), motion=PULSE.scaled(-1.0))
    np.testing.assert_allclose(found.rotation, -other.rotation, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.restrainer_force, other.restrainer_force, atol=1e-3)


def test_on_rigid_ground_a_tie_that_never_pulls_changes_nothing():
    far = TIE.replace(slack="1 km")
    options = {"motion": PULSE.scaled(0.6), "accuracy": "reference", "outputs": ("energy",)}
    free, found = run(BLOCK, **options), run(BLOCK, far, **options)
    np.testing.assert_allclose(found.rotation, free.rotation, rtol=0, atol=1e-10)
    assert int(found.impact_count) == int(free.impact_count) > 1
    assert imbalance(found) < 1e-8


def test_on_rigid_ground_the_mirror_image_moves_as_the_mirror_image():
    ties = (TIE.replace(brittle=False), TIE.replace(on=("0.2 m", "4 m"), name="top"))
    found = run(BLOCK, *ties)
    other = run(BLOCK, *map(mirrored, ties), motion=PULSE.scaled(-1.0))
    np.testing.assert_allclose(found.rotation, -other.rotation, rtol=0, atol=1e-9)
    assert float(abs(found.restrainer_force).max()) == pytest.approx(5000.0)
    yielded = found.event_kind == EventKind.RESTRAINER_YIELD
    assert int(yielded.sum()) > 0


def test_on_rigid_ground_ties_a_million_times_stiffer_than_the_weight_hold():
    ties = [
        rf.Restrainer(on=(f"{x} m", "0 m"), to=(f"{x} m", "0 m"), stiffness="40 GN/m")
        for x in (-0.5, 0.5)
    ]
    pulse = rf.GroundMotion.sine_pulse(amplitude="5 m/s^2", frequency="20 Hz")
    system = rf.System(BLOCK, *ties)
    options = {"duration": "0.05 s", "accuracy": "reference", "outputs": ("energy",)}
    found = system.simulate(pulse, **options)
    assert 0.0 < float(found.peak_rotation) < 1e-6
    assert float(found.energy_residual) < 1e-8
    # as ties that could break, at an unreachable force
    strong = rf.System(BLOCK, *(one.replace(strength="1e12 N") for one in ties))
    again = strong.simulate(pulse, **options)
    np.testing.assert_array_equal(again.rotation, found.rotation)


def test_ties_on_rigid_ground_add_their_closed_forms():
    b, k, z = 0.5, 2e5, 3.0
    angles = np.array([0.02, 0.1, 0.2])
    free = rf.System(BLOCK).moment_rotation((angles, "rad"))
    corner = rf.Restrainer(on=("-0.5 m", "0 m"), to=("-0.5 m", "0 m"), stiffness=f"{k} N/m")
    tied = rf.System(BLOCK, corner).moment_rotation((angles, "rad"))
    np.testing.assert_allclose(
        tied.restoring_moment - free.restoring_moment, 4.0 * k * b**2 * np.sin(angles), rtol=1e-12
    )
    # the corner bears all vertical load
    np.testing.assert_allclose(tied.base_moment, tied.held_right_reaction * b, rtol=1e-12)
    level = rf.Restrainer(on=("-0.5 m", f"{z} m"), to=("-1e9 m", f"{z} m"), stiffness=f"{k} N/m")
    tied = rf.System(BLOCK, level).moment_rotation((angles, "rad"))
    stretch = 2.0 * b * (1.0 - np.cos(angles)) + z * np.sin(angles)
    moment = k * stretch * (2.0 * b * np.sin(angles) + z * np.cos(angles))
    np.testing.assert_allclose(tied.restoring_moment - free.restoring_moment, moment, rtol=1e-6)


def test_a_preload_raises_the_acceleration_at_which_a_block_uplifts():
    half = [PRELOADED, mirrored(PRELOADED).replace(name="left")]
    down = [
        one.replace(on=(one.on[0], "1 m"), to=(one.on[0], "-2 m"), preload="5 kN") for one in half
    ]
    system = rf.System(BLOCK, *down)
    rest = system.equilibrium()
    weight = 4000.0 * 9.80665
    np.testing.assert_allclose(rest.static_left_reaction, 0.5 * weight + 5000.0)
    assert float(rest.uplift_moment) == pytest.approx(0.5 * (weight + 10000.0))
    threshold = 9.80665 * 0.25 * (1.0 + 10000.0 / weight)
    for scale, starts in ((0.999, False), (1.001, True)):
        motion = rf.GroundMotion.from_arrays(
            ([0.0, scale * threshold, 0.0], "m/s^2"), time_step="0.5 s"
        )
        found = run(BLOCK, *down, motion=motion)
        assert (float(found.peak_rotation) > 0.0) is starts
    assert system.setting.overturning_energy > rf.System(BLOCK).setting.overturning_energy


def test_a_tie_breaks_at_an_elongation_as_at_the_force_there():
    far = TIE.replace(strength=None, breaking_elongation="30 mm")  # 5 kN at 200 kN/m
    found, other = run(BLOCK, far), run(BLOCK, TIE)
    np.testing.assert_allclose(found.rotation, other.rotation, rtol=0, atol=1e-12)
    assert int(found.broken_restrainer_count) == 1


@plain_python()
@pytest.mark.parametrize(
    "base", [rf.RigidGround(), pytest.param(PADS, marks=pytest.mark.long)], ids=["ground", "pads"]
)
def test_a_stack_on_rigid_bases_is_tied(base):
    plinth = rf.Block(width="1.4 m", height="1 m", mass="5 t")
    stack = rf.Stack(BLOCK, plinth, interfaces=[rf.RigidGround()])
    anchor = rf.Restrainer(
        on=("-0.5 m", "1 m"), to=("-0.6 m", "0.5 m"), stiffness="1 MN/m", to_body=2,
        slack="1 mm", strength="20 kN", brittle=False, name="anchor",
    )  # fmt: skip
    system = rf.System(stack, base, anchor, TIE)
    found = system.simulate(PULSE, duration="1.4 s", outputs=("energy",))
    assert float(found.peak_restrainer_force.min()) > 0.0
    assert imbalance(found) < 1e-8
    assert system.setting.overturning_energy > 0.0
    free, tied = (
        rf.System(stack, base, *some).moment_rotation(([0.002], "rad"))
        for some in ((), (anchor, TIE))
    )
    assert float(tied.restoring_moment[0]) > float(free.restoring_moment[0])


def test_a_corner_tie_adds_its_closed_form():
    tie = rf.Restrainer(on=("-0.5 m", "0 m"), to=("-0.5 m", "0 m"), stiffness="100 kN/m")
    stiff = rf.TwoSpringSupport(frequency_ratio=3000, damping_ratio=0.1)
    angles = ([0.05, 0.1, 0.2], "rad")
    tied = rf.System(BLOCK, stiff, tie).moment_rotation(angles).restoring_moment.values
    free = rf.System(BLOCK, stiff).moment_rotation(angles).restoring_moment.values
    expected = 4.0 * 1e5 * 0.5**2 * np.sin(angles[0])
    np.testing.assert_allclose(tied - free, expected, rtol=2e-3)


def test_a_horizontal_tie_adds_its_closed_form():
    height, stiffness = 3.0, 2e5
    tie = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1e6 m", "3 m"), stiffness=f"{stiffness} N/m")
    stiff = rf.TwoSpringSupport(frequency_ratio=3000, damping_ratio=0.1)
    angles = np.array([0.02, 0.1])
    tied = rf.System(BLOCK, stiff, tie).moment_rotation((angles, "rad")).restoring_moment.values
    free = rf.System(BLOCK, stiff).moment_rotation((angles, "rad")).restoring_moment.values
    reach = 1.0 * (1.0 - np.cos(angles)) + height * np.sin(angles)
    expected = stiffness * reach * (1.0 * np.sin(angles) + height * np.cos(angles))
    np.testing.assert_allclose(tied - free, expected, rtol=2e-3)


def test_a_tie_changes_rest_frequencies_and_the_energy_to_overturn():
    free, tied = rf.System(BLOCK, PADS), rf.System(BLOCK, PADS, PRELOADED)
    assert tied.frequencies().period[0] < 0.8 * free.frequencies().period[0]
    assert tied.setting.rest_rotation > 0.0
    still = tied.simulate(duration="0.5 s")
    assert abs(still.rotation - tied.setting.rest_rotation).max() < 1e-12
    rest = tied.equilibrium()
    assert 0.0 < float(rest.static_restrainer_force[0]) < 1000.0
    several = rf.System(BLOCK, PADS, PRELOADED, mirrored(PRELOADED))
    assert several.setting.overturning_energy > free.setting.overturning_energy


def test_frequencies_are_those_of_a_small_run():
    tied = rf.System(BLOCK, PADS, PRELOADED, mirrored(PRELOADED))
    start = rf.InitialState(rotation="1e-5 rad")
    found = tied.simulate(duration="2 s", initial=start, output_step="1 ms")
    turns = np.nonzero(np.diff(np.sign(found.rotation.values)))[0]
    period = 2.0 * float(np.diff(found.time.values[turns]).mean())
    first = tied.frequencies().isel(mode=0)
    damped = float(first.period) / math.sqrt(1.0 - float(first.damping_ratio) ** 2)
    assert period == pytest.approx(damped, rel=2e-3)


def test_a_stack_is_tied_between_bodies_and_to_the_ground():
    plinth = rf.Block(width="1.4 m", height="1 m", mass="5 t")
    joint = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
    stack = rf.Stack(BLOCK, plinth, plinth, interfaces=[joint, joint])
    between = rf.Restrainer(
        on=("-0.5 m", "1 m"), to=("-0.6 m", "0.5 m"), stiffness="1 MN/m", to_body=3,
        slack="1 mm", strength="20 kN", brittle=False,
    )  # fmt: skip
    found = run(stack, PADS, between, TIE, outputs=("energy",))
    assert found.sizes["restrainer"] == 2
    assert found.sizes["body"] == 3
    assert imbalance(found) < 1e-8
    assert float(found.peak_restrainer_force.min()) > 0.0


def test_sweeps_name_the_parameters_of_ties():
    runs = rf.sweep(
        rf.System(BLOCK, PADS, TIE), motions={"pulse": PULSE},
        axes={"Restrainer.stiffness": ([1.0, 200.0], "kN/m")}, free_vibration="2 s",
    )  # fmt: skip
    assert runs.sizes["Restrainer.stiffness"] == 2
    assert float(runs.overturning_time.std()) > 0.0


def test_axes_name_ties_in_one_word_and_take_truth_values(tmp_path):
    upper = TIE.replace(name="tie, above", strength="0.5 kN", damping=None)
    system = rf.System(BLOCK, upper, TIE.replace(name=None))
    axes = {"tie__above.brittle": [True, False], "restrainer_2.stiffness": ["1 MN/m", "2 MN/m"]}
    runs = rf.sweep(system, PULSE, axes=axes)
    assert runs.broken_restrainer_count.sum("restrainer_2.stiffness").values.tolist() == [[4], [2]]
    runs.to_netcdf(tmp_path / "runs.nc")
    back = xr.load_dataset(tmp_path / "runs.nc")
    labels = {"tie__above.brittle": True, "restrainer_2.stiffness": "2 MN/m"}
    assert rf.case(back, **labels).system.parts["restrainer"].brittle is True
    with pytest.raises(StudyError, match=r"write 'tie__above\.brittle'"):
        rf.sweep(system, PULSE, axes={"tie, above.brittle": [True]})
    with pytest.raises(StudyError, match=r"was 'restrainer_2\.slack'"):
        rf.sweep(system, PULSE, axes={"restrainer2.slack": ["1 mm"]})
    with pytest.raises(StudyError, match="must be True or False, got 'perhaps'"):
        rf.sweep(system, PULSE, axes={"tie__above.brittle": ["perhaps"]})


@pytest.mark.parametrize("base", [PADS, rf.RigidGround()], ids=["pads", "rigid"])
@pytest.mark.parametrize(
    ("one", "other"),
    [({"slack": "0 m"}, {}), ({"strength": "1e15 N"}, {}), ({"damping": "0 N s/m"}, {})],
    ids=["no slack", "strength without end", "no damping"],
)
def test_what_is_none_or_without_end_is_as_if_not_given(base, one, other):
    tie = TIE.replace(slack=None, strength=None)
    runs = [run(BLOCK, base, tie.replace(**changes)) for changes in (one, other)]
    np.testing.assert_allclose(runs[0].rotation, runs[1].rotation, rtol=0.0, atol=1e-13)
    assert list(runs[0].event_kind) == list(runs[1].event_kind)


def test_on_pads_a_tie_that_never_pulls_changes_nothing():
    slack = rf.System(BLOCK, PADS, TIE.replace(slack="1 km", strength=None))
    found, alone = (one.simulate(PULSE) for one in (slack, rf.System(BLOCK, PADS)))
    peak = float(np.abs(alone.rotation).max())
    assert peak > 0.1
    np.testing.assert_allclose(found.rotation, alone.rotation, rtol=0.0, atol=1e-6 * peak)
    assert not (found.restrainer_force != 0.0).any()


def test_decaying_impacts_with_ties_end_at_rest():
    """Contacts are sought at the position of the body, not of its restrainer."""
    block = rf.Block(width="0.75 m", height="1.04 m", mass="1556 kg")
    ties = [
        rf.Restrainer(
            on=("0.375 m", "0.522 m"), to=("1.125 m", "0.202 m"), stiffness="330 kN/m",
            preload="760 N",
        ),
        rf.Restrainer(
            on=("-0.375 m", "0.294 m"), to=("-1.125 m", "0.427 m"), stiffness="58 kN/m",
            damping="470 N s/m",
        ),
    ]  # fmt: skip
    found = rf.System(block, *ties).simulate(
        PULSE.scaled(0.1), initial=rf.InitialState(rotation="0.16 rad")
    )
    assert int(found.status) == 0
    assert EventKind(int(found.event_kind[-1])) is EventKind.REST


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
def test_unloaded_corner_is_held_with_ties():
    """If released, it would return at once by its acceleration at that position."""
    width, height = 1.49, 3.32
    block = rf.Block(width=f"{width} m", height=f"{height} m", mass="9880 kg")
    tie = rf.Restrainer(on=("0.745 m", "2.13 m"), to=("2.23 m", "2.75 m"), stiffness="362 kN/m")
    rng = np.random.default_rng(5)
    rough = rf.GroundMotion.from_arrays(
        (4.0 * rng.normal(size=100), "m/s^2"),
        "0.02 s",
        vertical=(9.0 * rng.normal(size=100), "m/s^2"),
    )
    found = rf.System(block, tie).simulate(rough, initial=rf.InitialState(rotation="0.15 rad"))
    assert int(found.status) in (0, 1)
    assert len(found.event_kind) < 300


def test_ties_add_what_they_store_to_the_energy_that_overturns_a_mixed_stack():
    upper, lower = (rf.Block(width=w, height="2 m", mass="2 t") for w in ("0.6 m", "1.2 m"))
    stack = rf.Stack(upper, lower, interfaces=[rf.RigidGround()])
    tie = rf.Restrainer(
        on=("-0.3 m", "1 m"), to=("-0.6 m", "1.5 m"), to_body=2, stiffness="2 kN/m",
        compression=True,
    )  # fmt: skip
    free, tied = (rf.System(stack, PADS, *some).setting for some in ((), (tie,)))
    weight = 2e3 * free.gravity
    assert free.overturning_energy == pytest.approx(weight * (math.hypot(0.3, 1.0) - 1.0), rel=1e-9)
    # rotating about its left corner, the left face moves away from the tie's other point
    angle, tie_vector = math.atan2(0.3, 1.0), np.array([-0.3, 1.0]) - np.array([-0.6, -0.5])

    def stored(side):
        pivot = np.array([0.3 * side, 0.0])
        turn = np.array([[math.cos(angle), side * math.sin(angle)],
                         [-side * math.sin(angle), math.cos(angle)]])  # fmt: skip
        now = pivot + turn @ (np.array([-0.3, 1.0]) - pivot) - np.array([-0.6, -0.5])
        return 0.5 * 2e3 * (math.hypot(*now) - math.hypot(*tie_vector)) ** 2

    added = tied.overturning_energy - free.overturning_energy
    assert added == pytest.approx(min(stored(1.0), stored(-1.0)), rel=0.05)


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(
    "number",
    [
        755,  # a tie of 2e10 N/m, where the last bit of length exceeds the rounding of weights
        # ties between stacked bodies, taut or slack by the last bit
        pytest.param(508, marks=pytest.mark.long),
        pytest.param(2074, marks=pytest.mark.long),
        # a corner held without pressing while the body below is held on the ground
        pytest.param(170, marks=pytest.mark.long),
        # a corner whose separation would let another fall, at once and after an impact
        pytest.param(841, marks=pytest.mark.long),
        pytest.param(1333, marks=pytest.mark.long),
        # a corner that can neither pull nor separate
        pytest.param(1312, marks=pytest.mark.long),
        # ends that re-pinning would throw up, or hold and release, endlessly
        pytest.param(8453, marks=pytest.mark.long),
        pytest.param(8031, marks=pytest.mark.long),
        pytest.param(5943, marks=pytest.mark.long),
        pytest.param(18451, marks=pytest.mark.long),
        14161,  # a corner of a squat body after flight
        # impulses that stop a slip throw the corner up, ever less
        pytest.param(18363, marks=pytest.mark.long),
        219,  # not for an upright block
        # a corner that pulls, and without which the other corner falls
        pytest.param(19677, marks=pytest.mark.long),
        pytest.param(19797, marks=pytest.mark.long),
        # bodies that fall with their ground from the start
        pytest.param(13059, marks=pytest.mark.long),
        pytest.param(14323, marks=pytest.mark.long),
        # a body that bounces under a tie a million times stiffer than its weight
        pytest.param(15785, marks=pytest.mark.long),
        # an end that waits for its pad while the body below approaches
        pytest.param(17543, marks=pytest.mark.long),
    ],
)
def test_changes_of_contact_beside_ties_come_to_an_end(number):
    _, ended, _ = run_drawn(number)
    assert ended in ("completed", "overturned", "toppled")


def imbalance_at_rest(system: rf.System) -> float:
    """Return the greatest unbalanced force at rest over the weight, or moment likewise."""
    chain, poses = system.setting.standing.chain, system.setting.standing.rest
    loads, weights = chain.link_loads(poses), chain.weights(poses)
    upward = [
        one.force.upward + weight + load
        for one, (_, weight), load in zip(poses, weights, loads[1::2], strict=True)
    ]
    height = sum(link.part.body.height for link in chain.bodies)
    moments = [moment / height for moment in chain.moments(poses)]
    return float(max(map(abs, [*upward, *moments]))) / chain.weight


@pytest.mark.parametrize("stiffness", [5e6, 5e8, 5e10, 5e12])
def test_ties_of_any_stiffness_between_bodies_on_pads_let_them_find_rest(stiffness):
    upper = rf.Block(width="0.63 m", height="2.4 m", mass="3 t", eccentricity="1 cm")
    lower = rf.Block(width="0.87 m", height="0.88 m", mass="1.5 t")
    pads = rf.TwoSpringSupport(frequency_ratio=22, damping_ratio=0.1)
    ties = [
        rf.Restrainer(
            on=("-0.43 m", on), to=("0.31 m", to), on_body=2, to_body=1,
            stiffness=f"{stiffness} N/m", compression=True,
        )
        for on, to in (("0.2 m", "2.355 m"), ("0.59 m", "0.21 m"))
    ]  # fmt: skip
    system = rf.System(rf.Stack(upper, lower, interfaces=[pads]), pads, *ties)
    assert imbalance_at_rest(system) < 1e-12 * max(1.0, stiffness / 1e8)


@pytest.mark.parametrize("offset", ["0 m", "2 cm"])
def test_too_soft_pads_with_slack_links_are_refused(offset):
    # forces balance upright, and at an unstable lean
    soft, firm = PADS.replace(frequency_ratio=3), PADS
    slack = TIE.replace(slack="5 cm")
    stack = rf.Stack(BLOCK, rf.Block(width="2 m", height="1 m", mass="4 t"), interfaces=[soft],
                     offsets=[offset])  # fmt: skip
    for standing in (stack, BLOCK):
        with pytest.raises(AssemblyError, match="too soft for them, or their restrainers"):
            rf.System(standing, firm if standing is stack else soft, slack)


@pytest.mark.parametrize("number", [pytest.param(802, marks=pytest.mark.long), 1929])
def test_links_that_begin_to_answer_within_a_step_are_found_on_the_way(number):
    system, *_ = draw_scene(number)
    chain = system.setting.standing.chain
    upper = chain.bodies[0].part.body
    turned = 0.5 * math.atan2(upper.right, upper.height)
    places = [share * turned for share in (0.001, 0.02, 0.3, -0.02, -0.3)]
    for rotation, poses in zip(places, chain.curve(places), strict=True):
        assert poses is not None
        assert sum(one.state.rotation for one in poses) == pytest.approx(rotation, rel=1e-9)
        moments = chain.moments(poses)  # a single couple holds all bodies
        assert max(moments) - min(moments) < 1e-6 * chain.weight * upper.height


@pytest.mark.parametrize("times", [1e3, 1e6, 1e9])
def test_nearly_rigid_bar_carries_the_force_required_by_equilibrium(times):
    offset, half = 0.05, 0.5
    upper = rf.Block(width="1 m", height="2 m", mass="2 t", eccentricity=f"{offset} m")
    lower = rf.Block(width="1.2 m", height="1 m", mass="3 t")
    weight = 2e3 * 9.80665
    bar = rf.Restrainer(
        on=("0.5 m", "0 m"), to=("0.5 m", "0.5 m"), to_body=2, compression=True,
        stiffness=f"{times * weight / 2.0} N/m",
    )  # fmt: skip
    stiff = rf.TwoSpringSupport(frequency_ratio=300, damping_ratio=0.1)
    rest = rf.System(rf.Stack(upper, lower, interfaces=[stiff]), stiff, bar).equilibrium()
    # the corner above the bar stays: the bar takes W e / 2 b from the other pad
    share = float(rest.static_restrainer_force[0]) / (-weight * offset / (2.0 * half))
    assert 0.0 < share < 1.0
    if times > 1e7:
        assert share == pytest.approx(1.0, rel=2e-3)


@pytest.mark.long
def test_bodies_that_stiff_ties_join_move_as_those_that_softer_ones_nearly_join():
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    stack = rf.Stack(
        rf.Block(width="1 m", height="2 m", mass="2 t"),
        rf.Block(width="1.2 m", height="1 m", mass="3 t"), interfaces=[pads],
    )  # fmt: skip
    peaks = []
    for times in (1e4, 1e5, 1e6):  # over weight by height
        bar = rf.Restrainer(
            on=("0.5 m", "1.5 m"), to=("0.5 m", "0.5 m"), to_body=2, compression=True,
            stiffness=f"{times * 5e3 * 9.80665 / 3.0} N/m",
        )  # fmt: skip
        found = rf.System(stack, pads, bar).simulate(PULSE, duration="1 s", outputs=("energy",))
        assert imbalance(found) < 1e-6
        peaks.append(float(abs(found.rotation).max()))
    # the remainder is proportional to the compliance
    assert abs(peaks[2] - peaks[1]) < 0.5 * abs(peaks[1] - peaks[0]) < 0.01 * peaks[0]


def test_a_body_that_its_tie_lifts_off_its_pads_loads_them_no_more():
    tie = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1.5 m", "4 m"), stiffness="1 GN/m")
    held = rf.System(BLOCK, PADS, tie).moment_rotation(([0.02], "rad"))
    assert held.held_left_reaction.item() == held.held_right_reaction.item() == 0.0
    assert held.base_moment.item() == 0.0
    assert held.held_contact_state.item() == ContactState.FLIGHT
    # the couple balances the tie force: mg along the vertical, about the centre of mass
    assert held.restoring_moment.item() > 4e3 * 9.80665 * 0.5


@pytest.mark.parametrize("speed", ["0.1 m/s", "-0.1 m/s"])
def test_damper_tilts_vertically_moving_upright_body(speed):
    """At no rotation and no rate of it: the leading corner is that of the rotation to come."""
    damper = TIE.replace(to=("-2.5 m", "0 m"), slack="20 cm", damping="2 kN*s/m")
    start = rf.InitialState(vertical_velocity=speed)
    with plain_python():
        found, other = (
            rf.System(BLOCK, PADS, damper, restraint=rule).simulate(duration="0.1 s", initial=start)
            for rule in ("leading-corner", "contact-state")
        )
    assert found.attrs["verdict"].startswith("Did not overturn")
    np.testing.assert_allclose(found.rotation, other.rotation, atol=1e-3 * other.peak_rotation)
