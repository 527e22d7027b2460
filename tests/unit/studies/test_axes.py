"""Axes of parameters that a system implies, sizes of blocks, and units of labels."""

import numpy as np
import pint
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, StudyError

PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
BLOCK = rf.Block.from_size(radius="3 m", slenderness=4, mass="10 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)


def test_implied_rigid_ground_takes_a_restitution_axis() -> None:
    runs = rf.sweep(rf.System(BLOCK), PULSE, restitution=[0.8, 0.85], duration="4 s")
    explicit = rf.System(BLOCK, rf.RigidGround(restitution=0.85)).simulate(PULSE, duration="4 s")
    assert float(runs.peak_rotation.sel(restitution=0.85).squeeze()) == float(
        explicit.peak_rotation
    )
    again = rf.case(runs, restitution=0.85).simulate()
    assert float(again.peak_rotation) == float(explicit.peak_rotation)


def test_implied_rigid_ground_takes_a_friction_axis() -> None:
    runs = rf.sweep(rf.System(BLOCK), PULSE, friction=[0.1, 0.3], duration="4 s")
    explicit = rf.System(BLOCK, rf.RigidGround(friction=0.1)).simulate(PULSE, duration="4 s")
    assert float(runs.peak_slip.sel(friction=0.1).squeeze()) == float(explicit.peak_slip) > 0.0


def test_explicit_parts_take_precedence_over_implied_ground() -> None:
    before = rf.System(BLOCK, rf.RearWall(side="left"))
    runs = rf.sweep(before, PULSE, restitution=[-0.5, -0.1], duration="4 s")
    assert rf.case(runs, restitution=-0.1).system.parts.wall.restitution == -0.1
    with pytest.raises(StudyError, match="restitution"):
        rf.sweep(rf.System(BLOCK, rf.WinklerSoil(stiffness="9 MPa", damping=None,
                 damping_ratio=0.1)), PULSE, restitution=[0.8])  # fmt: skip


@pytest.mark.parametrize("base", [(), (PADS,)], ids=["rigid ground", "pads"])
def test_slenderness_axis_preserves_the_radius(base: tuple[rf.TwoSpringSupport, ...]) -> None:
    slender = np.linspace(3.0, 6.0, 20)  # enough for lanes
    runs = rf.sweep(rf.System(BLOCK, *base), PULSE, slenderness=slender, duration="6 s")
    for ratio in slender[[0, 7, 19]]:
        body = rf.Block.from_size(radius="3 m", slenderness=ratio, mass="10 t")
        alone = rf.System(body, *base).simulate(PULSE, duration="6 s", outputs=None)
        found = float(runs.peak_rotation.sel(slenderness=ratio).squeeze())
        assert found == pytest.approx(float(alone.peak_rotation), rel=1e-9)


def test_radius_axis_preserves_slenderness_and_combines_with_it() -> None:
    size = {"radius": ["2 m", "5 m"], "slenderness": [3, 5]}
    runs = rf.sweep(rf.System(BLOCK), PULSE, axes=size, duration="4 s")
    block = rf.case(runs, radius="5 m", slenderness=3).system.parts.block
    assert (block.radius.m_as("m"), block.slenderness) == pytest.approx((5.0, 3.0))
    alone = rf.sweep(rf.System(BLOCK), PULSE, radius=["2 m"], duration="4 s")
    assert rf.case(alone).system.parts.block.slenderness == pytest.approx(4.0)


def test_slenderness_combines_with_width_or_height() -> None:
    runs = rf.sweep(rf.System(BLOCK), PULSE, slenderness=[5], width=["2 m"], duration="2 s")
    block = rf.case(runs).system.parts.block
    assert (block.width.m_as("m"), block.height.m_as("m")) == pytest.approx((2.0, 10.0))
    runs = rf.sweep(rf.System(BLOCK), PULSE, slenderness=[5], height=["2 m"], duration="2 s")
    assert rf.case(runs).system.parts.block.width.m_as("m") == pytest.approx(0.4)


@pytest.mark.parametrize(
    "axes",
    [
        {"radius": ["1 m"], "width": ["1 m"]},
        {"slenderness": [3], "width": ["1 m"], "height": ["3 m"]},
    ],
)
def test_axes_that_determine_size_twice_are_refused(axes: dict[str, list[object]]) -> None:
    with pytest.raises(StudyError, match="determine its size twice"):
        rf.sweep(rf.System(BLOCK), PULSE, axes=axes)


def test_slenderness_of_a_body_with_an_inertia_is_refused() -> None:
    drum = rf.Block.cylinder(diameter="1 m", height="3 m", mass="1 t")
    with pytest.raises(StudyError, match="would leave inertia"):
        rf.sweep(rf.System(drum), PULSE, slenderness=[2, 3])


def test_negative_slenderness_fails_only_its_own_case() -> None:
    with pytest.warns(rf.errors.SolverWarning, match="slenderness must be greater than zero"):
        runs = rf.sweep(rf.System(BLOCK), PULSE, slenderness=[-1.0, 4.0], duration="2 s")
    assert runs.message.values[0, 0].startswith("Block: slenderness")


def test_slenderness_and_restitution_are_spread() -> None:
    found = rf.probability_of_overturning(
        rf.System(BLOCK),
        PULSE.scaled(1.5),
        spread={"slenderness": ("uniform", 3, 7), "restitution": ("uniform", 0.6, 0.8)},
        cases=64,
        free_vibration="8 s",
    )
    assert 0.0 < float(found.overturning_probability) < 1.0
    assert set(found.parameter.values) == {"slenderness", "restitution"}


def test_case_lookup_error_names_the_nearest_value() -> None:
    scales = np.linspace(0.5, 4.0, 20)
    runs = rf.sweep(rf.System(BLOCK), PULSE, scale=scales, duration="1 s", accuracy="fast")
    with pytest.raises(StudyError, match=r"scale has no 2\.0; .*; the nearest is 1\.97"):
        rf.case(runs, scale=2.0)


def test_case_label_without_unit_raises_with_an_example():
    column = rf.System(rf.Block(width="1 m", height="4 m", mass="1 t"))
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz")
    runs = rf.sweep(column, pulse, width=["1 m"], outputs=None, progress=False)
    words = r"got '1' \(no unit\); write for example width='1 m'"
    with pytest.raises(rf.errors.UnitsError, match=words):
        rf.case(runs, width="1")


def test_arrays_are_converted_from_their_units_attribute() -> None:
    """The unit of ratios was once ignored, so that 70 % became 70."""
    system = rf.System(BLOCK, PADS)
    percent = xr.DataArray([20.0, 70.0], attrs={"units": "%"})
    runs = rf.sweep(system, PULSE, scale=percent, duration="2 s")
    assert runs.scale.values.tolist() == [0.2, 0.7]
    runs = rf.sweep(system, PULSE, scale=runs.scale, damping_ratio=percent, duration="2 s")
    assert runs.damping_ratio.values.tolist() == [0.2, 0.7]
    widths = xr.DataArray([60.0, 70.0], attrs={"units": "cm"})
    narrow = rf.System(rf.Block(width="0.5 m", height="3 m", mass="2 t"))
    for arguments in ({"width": widths}, {"cases": {"width": widths}}):
        assert rf.sweep(narrow, PULSE, **arguments, duration="2 s").width.values.tolist() == [
            0.6,
            0.7,
        ]

    def tower(base: object) -> rf.System:
        return rf.System(rf.Block(width=base, height="3 m", mass="2 t"))  # pyright: ignore[reportArgumentType]

    assert rf.sweep(tower, PULSE, base=widths, duration="2 s").base.values.tolist() == [0.6, 0.7]


def test_percent_labels_are_converted_without_rounding_noise() -> None:
    runs = rf.sweep(rf.System(BLOCK, PADS), PULSE, scale=([20, 70.0], "%"), duration="2 s")
    assert runs.scale.values.tolist() == [0.2, 0.7]


def test_conflicting_units_of_an_array_are_refused() -> None:
    system = rf.System(rf.Block(width="0.5 m", height="3 m", mass="2 t"))
    widths = xr.DataArray([60.0, 70.0], attrs={"units": "cm"})
    percent = xr.DataArray([20.0, 70.0], attrs={"units": "%"})
    wrong = "has the unit '(cm|%)', but '(m|1)' is given with it"
    for arguments in (
        {"width": (widths, "m")}, {"cases": {"width [m]": widths}}, {"scale": (percent, "1")}
    ):  # fmt: skip
        with pytest.raises(StudyError, match=wrong):
            rf.sweep(system, PULSE, **arguments, duration="2 s")


@pytest.mark.parametrize("name", ["width [m]", "scale [%]"])
def test_masked_columns_are_refused(name: str) -> None:
    """The hidden value was once used in its place."""
    system = rf.System(rf.Block(width="0.5 m", height="3 m", mass="2 t"))
    column = np.ma.array([0.5, 0.6], mask=[False, True])
    with pytest.raises(StudyError, match="has masked values; fill them in first"):
        rf.sweep(system, PULSE, cases={name: column}, duration="1 s")


def test_masked_quantities_are_refused_and_not_read_as_zero() -> None:
    registry = pint.get_application_registry()
    masked = registry.Quantity(np.ma.array([4.0, 5.0], mask=[False, True]), "m")
    scene = rf.System(BLOCK)
    for axes in ({"height": masked}, {"height": list(masked)}):
        with pytest.raises(StudyError, match="height has masked values"):
            rf.sweep(scene, PULSE, axes=axes)
        with pytest.raises(StudyError, match="height has masked values"):
            rf.sweep(scene, PULSE, cases=axes)
    with pytest.raises(StudyError, match="drop has masked values"):
        rf.sweep(lambda drop: scene, PULSE, axes={"drop": masked})
    with pytest.raises(ComponentError, match="rotation has masked values"):
        rf.InitialState(rotation=registry.Quantity(np.ma.masked, "rad"))


def test_lists_of_quantities_are_accepted_as_columns() -> None:
    registry = pint.get_application_registry()
    heights = [registry.Quantity(400, "cm"), registry.Quantity(5.0, "m")]
    runs = rf.sweep(rf.System(BLOCK), PULSE, cases={"height": heights}, duration="1 s")
    assert runs.height.values.tolist() == [4.0, 5.0]
    with pytest.raises(StudyError, match="as their common unit 'm' is given"):
        rf.sweep(rf.System(BLOCK), PULSE, cases={"height [m]": heights}, duration="1 s")


def test_axis_values_may_come_from_a_generator() -> None:
    made = (f"{height} m" for height in (4, 5))
    runs = rf.sweep(rf.System(BLOCK), PULSE, height=made, duration="1 s")
    assert runs.height.values.tolist() == [4.0, 5.0]
    runs = rf.sweep(
        lambda tall: rf.System(BLOCK.replace(height=tall)), PULSE, duration="1 s",
        tall=(f"{height} m" for height in (4, 5)),
    )  # fmt: skip
    assert runs.tall.values.tolist() == [4.0, 5.0]


@pytest.mark.parametrize(
    "values",
    [np.array([2**63 + 1], dtype=np.uint64), np.array(["2026-01-01"], dtype="M8[D]")],
    ids=["beyond whole numbers", "dates"],
)
def test_dates_and_oversized_integers_are_refused_as_axis_values(values: np.ndarray) -> None:
    with pytest.raises(StudyError, match="drop needs numbers, words or quantities"):
        rf.sweep(lambda drop: rf.System(BLOCK), PULSE, drop=values)


def test_converted_labels_are_read_in_their_own_unit() -> None:
    """Converted labels, as for a figure, were once read as SI units."""
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("1 m/s^2", f"{f} Hz") for f in (1, 2, 3)}
    size = {"height": ["2 m", "2.4 m"], "PGA": ["3 m/s^2", "6 m/s^2", "12 m/s^2"]}
    runs = rf.sweep(system, motions, axes=size, free_vibration="3 s")
    shown = runs.assign_coords(
        height=("height", runs.height.values * 1e3, {"units": "mm"}),
        peak_ground_acceleration=(
            "peak_ground_acceleration", runs.peak_ground_acceleration.values / 9.80665,
            {"units": "g_0"},
        ),
    )  # fmt: skip
    for part, labels in (
        (shown, {"height": "2.4 m", "PGA": "6 m/s^2"}),
        (shown, {"height": 2400, "PGA": 6 / 9.80665}),
        (shown.isel(height=1, peak_ground_acceleration=1), {}),
    ):
        case = rf.case(part, motion="2 Hz", **labels)
        assert case.system.parts.block.height.m == 2.4
        assert case.motion is not None
        assert case.motion.si.peak == pytest.approx(6.0, rel=1e-12)
    limits = {"limits": [0.3], "pooled": ["height"]}
    one, other = (rf.fragility(each, "PGV", **limits) for each in (runs, shown))
    np.testing.assert_allclose(other.median_intensity, one.median_intensity, rtol=1e-9)
    one, other = (rf.fragility(each, "PGA", **limits) for each in (runs, shown))
    np.testing.assert_allclose(9.80665 * other.median_intensity, one.median_intensity, rtol=1e-9)
    assert other.median_intensity.units == "g_0"
