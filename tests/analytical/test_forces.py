"""Accelerations, reactions, friction demand and points against Newton's law and closed forms."""

import math
import re

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import AssemblyError, ModelWarning, RockframeError
from rockframe.results.forces import EventStates
from rockframe.results.schema import GROUPS, ON_REQUEST

pytestmark = pytest.mark.analytical

G = 9.80665
B, H, MASS = 1.2, 4.8, 50e3
BLOCK = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(width="3.2 m", height="0.4 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)
PULSE = rf.GroundMotion.sine_pulse("-5 m/s^2", "1 Hz").with_vertical(
    rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
)
SCENES = {
    "rigid ground": rf.System(BLOCK),
    "rigid ground, small": rf.System(BLOCK, rotation="small"),
    "pads": rf.System(BLOCK, PADS),
    "pads, small": rf.System(BLOCK, PADS, rotation="small"),
    "soil": rf.System(BLOCK, SOIL),
    "one body": rf.System(BLOCK, CAP, SOIL),
    "coupled": rf.System(BLOCK, PADS, CAP, SOIL),
    "cascade": rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
}
SCENE_VARIABLES = {
    "toe_pressure": ("soil", "one body", "coupled", "cascade"),
    "soil_friction_demand": ("coupled", "cascade"),  # other scenes have only one base
}
POINTS = {"roof": ("0 m", "9.6 m"), "right corner": ("1.2 m", "0 m"), "left": ("-1.2 m", "0 m")}
ALL = (*GROUPS, "friction_demand", "horizontal_velocity")


def mass_of(scene):
    return 60e3 if scene == "one body" else MASS


@pytest.fixture(scope="module", params=SCENES)
def scene(request):
    return request.param


@pytest.fixture(scope="module")
def response(scene):
    return SCENES[scene].simulate(
        PULSE, free_vibration="1 s", outputs=ALL, points=POINTS, output_step="0.25 ms"
    )


def second_derivative(response, history):
    """Differentiate a history twice where no event is near; NaN elsewhere, and at both ends."""
    time, events = response.time.values, np.unique(response.event_time.values)
    found = np.full(time.size, np.nan)
    calm = np.searchsorted(events, time[:-2]) == np.searchsorted(events, time[2:])
    even = np.isclose(np.diff(time, 2), 0.0, atol=1e-12)
    step = time[1] - time[0]
    found[1:-1] = np.where(calm & even, np.diff(history, 2) / step**2, np.nan)
    return found


def assert_close(found, expected, share):
    known = ~np.isnan(found)
    assert known.mean() > 0.5
    error = np.abs(found - expected)[known].max()
    assert error < share * np.abs(expected).max(), error


def test_accelerations_are_the_second_derivatives_of_displacements(response):
    for displacement, acceleration in (
        ("rotation", "angular_acceleration"),
        ("horizontal_displacement", "horizontal_acceleration"),
        ("vertical_displacement", "vertical_acceleration"),
    ):
        slope = second_derivative(response, response[displacement].values)
        assert_close(slope, response[acceleration].values, 1e-3)


def test_points_move_with_the_body(response):
    for name in POINTS:
        point = response.sel(point=name)
        for direction, ground in (
            ("horizontal", response.ground_acceleration),
            ("vertical", response.vertical_ground_acceleration),
        ):
            slope = second_derivative(response, point[f"point_{direction}_displacement"].values)
            assert_close(
                slope + ground.values, point[f"point_{direction}_acceleration"].values, 1e-3
            )
    # a rigid body: its corners stay as far apart as they are
    right, left = response.sel(point="right corner"), response.sel(point="left")
    wide = 2.0 * B + right.point_horizontal_displacement - left.point_horizontal_displacement
    high = right.point_vertical_displacement - left.point_vertical_displacement
    if response.attrs["kinematics"] == "finite":
        np.testing.assert_allclose(np.hypot(wide, high), 2.0 * B, rtol=1e-14)


def test_bearing_corner_on_rigid_ground_does_not_move():
    response = SCENES["rigid ground"].simulate(PULSE, points=POINTS)
    for name, state in (("right corner", 2), ("left", 1)):
        bears = response.contact_state.values == state
        assert bears.any()
        corner = response.sel(point=name).isel(time=bears)
        for direction, ground in (("horizontal", ""), ("vertical", "vertical_")):
            assert np.abs(corner[f"point_{direction}_displacement"]).max() < 1e-14
            np.testing.assert_allclose(
                corner[f"point_{direction}_acceleration"], corner[f"{ground}ground_acceleration"],
                atol=1e-12,
            )  # fmt: skip


def test_reactions_follow_from_newtons_law(scene, response):
    mass = mass_of(scene)
    force = mass * response.absolute_horizontal_acceleration.values
    press = mass * (response.absolute_vertical_acceleration.values + G)
    if scene in ("coupled", "cascade"):
        tilt = response.cap_rotation.values if scene == "coupled" else 0.0
        s, c = np.sin(tilt), np.cos(tilt)
        force, press = c * force - s * press, s * force + c * press
    if scene != "cascade":  # the total of a cascade is a sum of displacements, not of one body
        for found, expected in (("horizontal", force), ("vertical", press)):
            np.testing.assert_allclose(
                response[f"{found}_reaction"], expected, atol=1e-9 * mass * G
            )
    if scene not in ("coupled", "cascade"):
        np.testing.assert_allclose(response.base_shear, force, atol=1e-9 * mass * G)
    shown = response.soil_reaction if scene in ("soil", "one body") else (
        response.left_reaction + response.right_reaction
    )  # fmt: skip
    np.testing.assert_allclose(response.vertical_reaction, shown, atol=1e-9 * mass * G)


TIED = (
    rf.Restrainer(
        on=(f"{-B} m", f"{H} m"), to=(f"{-2 * B} m", f"{0.5 * H} m"), stiffness="20 MN/m",
        preload=f"{0.05 * MASS * G} N",
    ),
    rf.Load(at=("0 m", f"{H} m"), horizontal=f"{0.01 * MASS * G} N"),
)  # fmt: skip
PLINTH = rf.Block(width="3.2 m", height="2.4 m", mass="30 t")
STACK = rf.Stack(BLOCK, PLINTH, interfaces=[PADS])
ON_PADS = {
    "ground": (BLOCK, PADS),
    "ties and a load": (BLOCK, PADS, *TIED),
    "cap": (BLOCK, PADS, CAP, SOIL),
    "cap, cascade": (BLOCK, PADS, CAP, SOIL),
    "plinth": (STACK, SOIL),
    "plinth, tied": (STACK, SOIL, TIED[0].replace(to_body=2, to=("-1.5 m", "1 m")), TIED[1]),
}


@pytest.mark.wide
@pytest.mark.parametrize("where", ON_PADS)
def test_base_overturning_moment_is_that_of_pad_reactions(where):
    """The horizontal reaction at the held middle has no lever about it."""
    coupling = "cascade" if "cascade" in where else "coupled"
    system = rf.System(*ON_PADS[where], restraint="centre", coupling=coupling)
    response = system.simulate(PULSE, outputs="reaction")
    tilt = response.get("rotation_on_cap", response.rotation)
    if "plinth" in where:
        tilt = response.body_rotation_on_base.isel(body=0)
        assert float(abs(tilt - response.rotation).max()) > 1e-3
    arm = B * np.cos(tilt)
    expected = arm * (response.right_reaction - response.left_reaction)
    np.testing.assert_allclose(response.base_overturning_moment, expected, atol=1e-8 * MASS * G * B)


def test_toe_pressure_in_closed_form():
    system = rf.System(BLOCK, rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0))
    response = system.simulate(PULSE, outputs="toe_pressure")
    tilt = response.rotation
    middle = response.vertical_displacement + H * (1.0 - np.cos(tilt))
    lowest = middle - B * np.abs(np.sin(tilt))
    expected = np.maximum(MASS * G / (2.0 * B) - 30e6 * lowest, 0.0)
    np.testing.assert_allclose(response.toe_pressure, expected, rtol=1e-9, atol=1.0)
    assert float(response.toe_pressure.max()) > 1.5 * MASS * G / (2.0 * B)


def test_friction_demand_of_released_block_in_closed_form():
    """Friction demand of a rocking block, from its energy at each angle."""
    start, share, theta, radius = 0.15, 0.75, math.atan2(B, H), math.hypot(B, H)
    system = rf.System(BLOCK)
    response = system.simulate(
        duration="3 s", initial=rf.InitialState(rotation="0.15 rad"), outputs="friction_demand"
    )
    falls = response.isel(time=response.time.values < response.event_time.values[0])
    lean = theta - falls.rotation
    pull = share * G / radius  # over the sine of the lean: minus the angular acceleration
    square = 2.0 * pull * (math.cos(theta - start) - np.cos(lean))
    across = radius * (-pull * np.sin(lean) * np.cos(lean) + np.sin(lean) * square)
    up = G + radius * (-pull * np.sin(lean) ** 2 - np.cos(lean) * square)
    assert falls.time.size > 50
    np.testing.assert_allclose(falls.friction_demand, np.abs(across) / up, rtol=1e-8)
    # the motion of the centre is more horizontal at small rotations: the demand grows to impact
    assert response.peak_friction_demand == pytest.approx(
        share * math.sin(theta) * math.cos(theta) / (1.0 - share * math.sin(theta) ** 2), rel=0.2
    )


def test_impulsive_friction_demand_in_closed_form():
    """Momentum about the new corner: J_x/J_y = h (1 - e)/(b (1 + e))."""
    for e in (0.8, 0.9):
        system = rf.System(BLOCK, rf.RigidGround(restitution=e))
        response = system.simulate(
            duration="3 s", initial=rf.InitialState(rotation="0.1 rad"), outputs="impulse"
        )
        expected = H * (1.0 - e) / (B * (1.0 + e))
        ratio = np.abs(response.event_horizontal_impulse / response.event_vertical_impulse)
        assert response.impact_count > 1
        np.testing.assert_allclose(ratio, expected, rtol=1e-9)
        assert response.peak_impulsive_friction_demand == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("lean", [0.0, 0.1, -0.2])
def test_event_impulses_are_resolved_along_tilted_base(lean):
    """As for forces: along and normal to the cap or body below, for any rotation."""
    system = rf.System(rf.Stack(BLOCK, BLOCK, interfaces=[PADS]), PADS)
    along, normal = 0.3, 2.0
    zero, turned = np.zeros(1), np.array([lean + 0.05])
    before = {
        "rotation": turned, "rotation_on_base": np.array([0.05]), "horizontal_velocity": zero,
        "vertical_velocity": zero,
    }  # fmt: skip
    after = before | {
        "horizontal_velocity": np.array([math.cos(lean) * along + math.sin(lean) * normal]),
        "vertical_velocity": np.array([math.cos(lean) * normal - math.sin(lean) * along]),
    }
    events = EventStates(np.ones(1), np.ones(1, dtype=np.bool_), before, after)
    found = events.impulses_on_base(system.setting.load)
    np.testing.assert_allclose(np.ravel(found), [MASS * along, MASS * normal], rtol=1e-12)


def test_rest_event_is_left_out_of_impulsive_friction_demand():
    """The last event of an endless series ends all motion at once, in its own ratio."""
    response = rf.System(BLOCK, rf.RigidGround(restitution=0.8)).simulate(
        duration="60 s", initial=rf.InitialState(rotation="0.05 rad")
    )
    assert "rest" in response.event_kind.attrs["flag_meanings"]
    assert response.residual_rotation == 0.0
    expected = H * 0.2 / (B * 1.8)
    assert response.peak_impulsive_friction_demand == pytest.approx(expected, rel=1e-8)


def test_residual_rotation_of_overturned_block():
    motion = rf.GroundMotion.sine_pulse("-20 m/s^2", "1 Hz")
    response = SCENES["rigid ground"].simulate(motion, overturning="continue", duration="20 s")
    assert response.attrs["overturned"]
    assert response.residual_rotation == response.rotation[-1]
    assert abs(response.residual_rotation) == pytest.approx(math.pi / 2.0, rel=1e-9)
    # a body on its side: its centre lies b above the ground
    fallen = float(response.vertical_displacement[-1])
    assert fallen == pytest.approx(B - H, rel=1e-9)


def test_force_peaks_bound_their_histories(response):
    assert response.peak_base_shear >= np.abs(response.base_shear).max()
    assert response.peak_friction_demand >= response.friction_demand.max()
    at = response.peak_friction_demand_time.item()
    assert 0.0 <= at <= response.time.values[-1]
    assert response.residual_rotation == response.rotation[-1]


@pytest.mark.parametrize("scene", ["rigid ground", "pads"])
def test_residuals_are_taken_at_end_between_samples(scene):
    runs = [
        SCENES[scene].simulate(PULSE, duration="1.3 s", **outputs)
        for outputs in (
            {},
            {"output_step": "0.2 s"},
            {"outputs": None, "points": {"top": ("0 m", f"{H} m")}},
        )
    ]
    assert runs[1].time[-1] == pytest.approx(1.2)
    exact = SCENES[scene].simulate(PULSE, duration="1.3 s", output_step="0.65 s")
    for run in runs:
        assert run.residual_rotation == pytest.approx(exact.rotation[-1].item(), rel=1e-12)
        assert run.residual_settlement == exact.residual_settlement
    assert runs[1].rotation[-1] != exact.rotation[-1]


def test_block_at_rest_has_no_residual_displacement():
    response = rf.System(BLOCK, PADS).simulate(PULSE, duration="300 s", output_step="1 s")
    assert abs(response.residual_rotation) < 1e-6
    assert abs(response.residual_settlement) < 1e-6


def test_output_groups_return_only_requested_variables(scene):
    system = SCENES[scene]
    assert not set(ON_REQUEST) & set(system.simulate(PULSE).variables)
    for group, names in GROUPS.items():
        found = system.simulate(PULSE, duration="0.5 s", outputs=[group])
        assert set(ON_REQUEST) & set(found.variables) == set(names)
    assert "peak_friction_demand" not in system.simulate(PULSE, outputs=None)


@pytest.mark.parametrize("name", ON_REQUEST)
def test_single_output_can_be_requested_by_name(scene, name):
    if scene not in SCENE_VARIABLES.get(name, SCENES):
        pytest.skip("the scene has no such thing")
    assert name in SCENES[scene].simulate(PULSE, duration="0.5 s", outputs=name)


def test_points_survive_netcdf_round_trip(tmp_path):
    response = rf.System(BLOCK, PADS).simulate(PULSE, points=POINTS, outputs="acceleration")
    assert response.point.values.tolist() == list(POINTS)
    assert response.point_y.sel(point="roof") == 9.6
    response.to_netcdf(tmp_path / "points.nc")
    with xr.open_dataset(tmp_path / "points.nc") as again:
        xr.testing.assert_identical(again.load(), response)


def test_unknown_outputs_and_invalid_points_are_refused():
    system = rf.System(BLOCK, PADS)
    for outputs in ("shear", ["rotation", "acelleration"], [3]):
        with pytest.raises(AssemblyError, match=r"outputs has no .*'friction_demand'"):
            system.simulate(PULSE, outputs=outputs)
    for points, words in (
        ({"roof": "18 m"}, "two lengths"),
        ({"roof": ("0 m", "18 m", "0 m")}, "two lengths"),
        ({"roof": (0, 18)}, r"points\['roof'\] needs a length"),
        ({"roof": ("0 m", "18 s")}, r"points\['roof'\] needs a length"),
        ({3: ("0 m", "18 m")}, "needs names"),
        ({"": ("0 m", "18 m")}, "needs names"),
        ([("0 m", "18 m")], "must name places"),
    ):
        with pytest.raises(RockframeError, match=words):
            system.simulate(PULSE, points=points)
    with pytest.raises(
        AssemblyError, match="no 'toe_pressure' in this scene; it needs a WinklerSoil"
    ):
        system.simulate(PULSE, outputs="toe_pressure")


def test_verdict_reports_friction_demand():
    response = SCENES["rigid ground"].simulate(PULSE)
    needed = response.peak_friction_demand.item()
    lasted = response.peak_friction_demand_duration.item()
    sentence = f"Friction needed: {needed:.3g}, more than half of it for {lasted:.3g} s in all."
    assert response.attrs["verdict"].endswith(sentence)
    at_rest = SCENES["rigid ground"].simulate(PULSE.scaled(0.0))
    assert at_rest.peak_friction_demand == 0.0
    for other in (at_rest, SCENES["rigid ground"].simulate(PULSE, outputs=None)):
        assert "Friction" not in other.attrs["verdict"]
    assert "friction to rock, at least b/h    0.25\n" in rf.System(BLOCK).describe()


TENDON = rf.Tendon(stiffness="2 MN/m", preload="40 kN")
FRAME = rf.RockingFrame(BLOCK, columns=2, beam_mass="80 t")
DRUM = rf.Block(width="2.8 m", height="3 m", mass="60 t")
DRY = rf.RigidGround()


@pytest.mark.parametrize(
    "system",
    [
        rf.System(BLOCK, TENDON),
        rf.System(BLOCK, rf.Load(at=("-0.2 m", "9.6 m"), vertical="90 kN", horizontal="-4 kN")),
        rf.System(
            BLOCK,
            rf.Restrainer(
                on=("-1.2 m", "8 m"), to=("-4 m", "1 m"), stiffness="2 MN/m", preload="15 kN"
            ),
        ),
        rf.System(FRAME, TENDON),
        rf.System(rf.Stack(BLOCK, DRUM, interfaces=[DRY]), DRY),
    ],
    ids=["tendon", "load", "tie", "frame", "stack"],
)
def test_described_friction_to_rock_is_demand_at_uplift(system):
    text = " ".join(system.describe().split())
    least = min(map(float, re.findall(r"friction to rock, at least (?:b/h )?([\d.]+)", text)))
    found = re.findall(r"as one at xg'' of ([\d.]+)|preload holds, ([\d.]+)", text)
    starts = min(float(one or other) for one, other in found)
    for share, rocks in ((0.998, False), (1.002, True)):
        level = share * starts
        motion = rf.GroundMotion.from_arrays(([0.0, level, level], "m/s^2"), time_step="0.2 s")
        run = system.simulate(motion, points={"foot": ("0 m", "0 m")})
        rotation = np.max(run.get("peak_body_rotation", run.peak_rotation))
        assert (rotation > 0.0) == rocks
        if not rocks and "body" not in run.dims:
            assert run.peak_friction_demand.item() == pytest.approx(least, rel=4e-3)


def test_description_lists_friction_to_rock_of_each_base_and_free_side():
    text = " ".join(rf.System(rf.Stack(BLOCK, DRUM, interfaces=[DRY]), DRY).describe().split())
    height = (50.0 * (3.0 + H) + 60.0 * 1.5) / 110.0
    for words in (
        "body 1: overturning angle theta, Eq. (1) 0.244979 rad",
        "base 1: friction to rock, at least b/h 0.25 ",
        f"base 2: friction to rock, at least b/h {1.4 / height:.6g} ",
        f"base 2: rigid, all above rocks as one at xg'' of {G * 1.4 / height:.4g} m s^-2",
    ):
        assert words in text
    leaning = rf.Block(
        width="1 m", height="4 m", mass="4 t", inertia="5 t*m^2", centre_of_mass=("2 m", "0.2 m")
    )
    for side, least in (("left", 0.15), ("right", 0.35)):
        wall = rf.RearWall(side=side, restitution=-0.3)
        assert f"at least b/h    {least}\n" in rf.System(leaning, wall).describe()
    on_pads = rf.System(BLOCK, PADS, rf.Load(at=("0 m", "9 m"), vertical="9 kN"))
    assert "friction to rock" not in on_pads.describe()


def test_too_little_friction_warns_with_time_and_duration():
    reference = SCENES["rigid ground"].simulate(PULSE, outputs="friction_demand")
    demand, time = reference.friction_demand.values, reference.time.values
    ground = rf.RigidGround(friction=0.25)
    with pytest.warns(ModelWarning, match="the block would slide") as caught:
        response = rf.System(BLOCK, ground, sliding="checked").simulate(PULSE)
    text = str(caught[0].message)
    first = time[demand > 0.25][0]
    lasted = (demand > 0.25).sum() * (time[1] - time[0])
    stated = float(text.split(" from ")[1].split(" s on")[0])
    assert response.would_slide
    assert response.sliding_time == pytest.approx(stated, rel=1e-3)
    assert first - (time[1] - time[0]) <= stated <= first
    assert float(text.split("for ")[1].split(" s in all")[0]) == pytest.approx(lasted, rel=0.05)
    assert f"needs a friction of {reference.peak_friction_demand.item():.3g}, has 0.25, " in text
    statement = text.removeprefix("the block ").removesuffix("; this model keeps it in place")
    assert response.attrs["verdict"].endswith(f"; 1 impact. {statement[0].upper()}{statement[1:]}.")
    assert response.attrs["cautions"] == text
    np.testing.assert_array_equal(response.rotation, reference.rotation)
    most = reference.peak_friction_demand.item()
    enough = rf.RigidGround(friction=1.01 * most)
    holds = rf.System(BLOCK, enough, sliding="checked").simulate(PULSE)
    assert holds.attrs["cautions"] == "none"
    assert not holds.would_slide
    assert np.isnan(holds.sliding_time)
    assert holds.sliding_duration == 0
    assert holds.attrs["verdict"].endswith(
        f"Would not slide: needs a friction of {most:.3g}, has {1.01 * most:.3g}."
    )
    with pytest.warns(ModelWarning, match="the frame would slide from"):
        rf.System(FRAME, ground).simulate(PULSE)
    # similar numbers are printed with enough digits to distinguish them
    almost = rf.RigidGround(friction=(1.0 - 1e-6) * most)
    with pytest.warns(ModelWarning, match="needs a friction of 0.33[0-9]{4,}, has 0.33[0-9]{4,},"):
        rf.System(BLOCK, almost, sliding="checked").simulate(PULSE)


def test_friction_of_stack_is_checked_at_both_bases():
    pads, soil = PADS.replace(friction=0.05), SOIL.replace(friction=0.05)
    with pytest.warns(ModelWarning) as caught:
        response = rf.System(BLOCK, pads, CAP, soil, sliding="checked").simulate(PULSE)
    words = [str(each.message) for each in caught]
    assert any(word.startswith("the block would slide") for word in words)
    assert any(word.startswith("the cap would slide") for word in words)
    assert "The block would slide from " in response.attrs["verdict"]
    assert "; the cap would slide from " in response.attrs["verdict"]
    with pytest.warns(ModelWarning, match="the block would slide"):
        rf.System(BLOCK, soil, sliding="checked").simulate(PULSE)


@pytest.mark.parametrize("values", [(0.09, -0.2), (-0.2, 0.2), (0.0, 0.15, -0.2, 0.05)])
def test_duration_above_level_counts_force_reversal_within_step(values):
    system = rf.System(BLOCK, rf.RigidGround(friction=0.08), sliding="checked")
    motion = rf.GroundMotion.from_arrays((values, "g_0"), "0.02 s")
    with pytest.warns(ModelWarning, match="would slide"):
        response = system.simulate(motion, accuracy="fast")
    # at rest the demand is |xg''|/g, linear between samples on either side of zero
    fine = np.linspace(0.0, len(values) - 1.0, 400_001)
    needed = np.abs(np.interp(fine, np.arange(len(values)), values))
    length = 0.02 * (len(values) - 1)
    for name, level in (("peak_friction_demand_duration", 0.1), ("sliding_duration", 0.08)):
        lasted = length * np.mean(needed > level)
        assert response[name].item() == pytest.approx(lasted, rel=1e-4)
