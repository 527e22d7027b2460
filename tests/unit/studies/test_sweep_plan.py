"""Axes, tables and motions of a sweep, and refusals before anything runs."""

from concurrent.futures import ThreadPoolExecutor
from functools import wraps

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, StudyError

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
ON_PADS = rf.System(BLOCK, PADS)
CAP = rf.CushionCap(height="0.5 m", mass="2 t", width="1 m")
STACK = rf.System(BLOCK, PADS, CAP, rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2))
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
OTHER = rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s")
RECORD = rf.GroundMotion.from_arrays(([0.0, 1.0, 0.0], "m/s^2"), "0.03 s")
FAST = {"accuracy": "fast", "free_vibration": "1 s"}


def tower(width, height, pads="none", stiff=True):
    block = rf.Block(width=width, height=height, mass="4 t")
    return rf.System(block, *([PADS] if pads == "two" else []), gravity="9.81 m/s^2")


def test_dimensions_are_the_axes_in_their_order_and_the_motions():
    runs = rf.sweep(
        ON_PADS,
        {"one": PULSE, "two": OTHER},
        scale=[0.5, 1.0, 1.5],
        damping_ratio=[0.1, 0.2],
        **FAST,
    )
    assert dict(runs.peak_rotation.sizes) == {"scale": 3, "damping_ratio": 2, "motion": 2}
    assert runs.motion.values.tolist() == ["one", "two"]
    assert runs.scale.attrs == {"units": "1", "long_name": "factor of the ground motion"}
    assert runs.overturned.dtype == bool
    for k, scale in enumerate([0.5, 1.0, 1.5]):
        for motion, name in ((PULSE, "one"), (OTHER, "two")):
            pads = PADS.replace(damping_ratio=0.2)
            alone = rf.System(BLOCK, pads).simulate(motion.scaled(scale), **FAST, outputs=None)
            single = runs.isel(scale=k, damping_ratio=1).sel(motion=name)
            for variable in alone.data_vars:
                if variable in single:
                    np.testing.assert_array_equal(single[variable], alone[variable])


@pytest.mark.parametrize(
    "values",
    [
        ([600.0, 800.0], "mm"),
        (np.array([0.6, 0.8]), "m"),
        ["0.6 m", "80 cm"],
        pint.get_application_registry().Quantity([60.0, 80.0], "cm"),
        ["0.6 m", pint.get_application_registry().Quantity(80.0, "cm")],
        (pd.Series([0.6, 0.8]), "m"),
    ],
)
def test_values_with_units_become_si_whatever_their_form(values):
    runs = rf.sweep(ON_PADS, PULSE, width=values, **FAST)
    np.testing.assert_allclose(runs.width, [0.6, 0.8], rtol=1e-15)
    assert runs.width.attrs["units"] == "m"
    assert "base width" in runs.width.attrs["long_name"].lower()
    again = rf.sweep(lambda width: tower(width, "3.6 m"), PULSE, width=values, **FAST)
    np.testing.assert_array_equal(again.width, runs.width)
    assert again.width.attrs["units"] == "m"


def test_parameters_shared_by_two_parts_need_a_class_prefix():
    with pytest.raises(
        StudyError, match=r"Block and CushionCap.*'Block.mass' or 'CushionCap.mass'"
    ):
        rf.sweep(STACK, PULSE, mass=(["4 t"]), **FAST)
    axes = {"Block.mass": (["4 t", "5 t"]), "CushionCap.mass": ([2.0, 3.0, 4.0], "t")}
    runs = rf.sweep(STACK, PULSE, axes=axes, **FAST)
    assert runs.status.dims == ("Block.mass", "CushionCap.mass", "motion")
    case = rf.case(runs, **{"Block.mass": "5 t", "CushionCap.mass": 3000.0})
    assert case.system.parts.block.mass.m_as("kg") == 5000.0
    assert case.system.parts.cap.mass.m_as("t") == 3.0


def test_system_options_can_be_axes():
    runs = rf.sweep(
        ON_PADS, PULSE, axes={"System.rotation": ["finite", "small"]},
        restraint=["centre", "contact-state"], gravity=(["1 g_0", "3.7 m/s^2"]), **FAST,
    )  # fmt: skip
    assert dict(runs.sizes) == {
        "System.rotation": 2, "restraint": 2, "gravity": 2, "motion": 1,
    }  # fmt: skip
    single = runs.peak_rotation.sel({"System.rotation": "small", "restraint": "centre"}).isel(
        gravity=1
    )
    system = rf.System(BLOCK, PADS, rotation="small", restraint="centre", gravity="3.7 m/s^2")
    assert single.item() == system.simulate(PULSE, **FAST).peak_rotation.item()


def test_alternative_parameter_replaces_the_original():
    runs = rf.sweep(ON_PADS, PULSE, stiffness=["5 MN/m", "9 MN/m"], **FAST)
    pads = rf.TwoSpringSupport(stiffness="9 MN/m", damping_ratio=0.1)
    alone = rf.System(BLOCK, pads).simulate(PULSE, **FAST)
    assert runs.peak_rotation[1, 0].item() == alone.peak_rotation.item()


def test_with_si_equals_replace_with_units():
    for part, values, written in (
        (BLOCK, {"width": 0.1 + 0.2}, {"width": f"{0.1 + 0.2!r} m"}),
        (BLOCK, {"inertia": 5321.7}, {"inertia": "5321.7 kg m^2"}),
        (PADS, {"stiffness": 1e7 / 3.0}, {"stiffness": f"{1e7 / 3.0!r} N/m"}),
        (
            PADS,
            {"restitution": 0.77, "damping": 3.3},
            {"restitution": 0.77, "damping": "3.3 N s/m"},
        ),
    ):
        assert part.with_si(values) == part.replace(**written)
        assert vars(part.with_si(values).given) == vars(part.replace(**written).given)
    with pytest.raises(ComponentError, match="greater than zero"):
        BLOCK.with_si({"width": -1.0})


DRUM = rf.Block.cylinder(diameter="0.5 m", height="2 m", mass="400 kg")


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ({"mass": ["1 t"]}, "axis 'mass' would leave inertia of this Block .* with shape_factor"),
        ({"Block.mass": ["1 t"], "width": ["0.6 m"]}, "axes 'Block.mass' and 'width' would leave"),
        ({"height": ["3 m"]}, "axis 'height' would leave inertia and centre_height of this Bl"),
        ({"height": ["3 m"], "shape_factor": [3.0]}, "axis 'height' would leave centre_height "),
    ],
)
def test_axes_that_would_not_rescale_an_explicit_inertia_are_refused(axes, words):
    system = rf.System(DRUM)
    with pytest.raises(StudyError, match=words):
        rf.sweep(system, PULSE, axes=axes, **FAST)
    with pytest.raises(StudyError, match=words):
        rf.sweep(system, PULSE, cases=pd.DataFrame(axes), **FAST)
    if "mass" in axes:
        spread = {"mass": ("normal", "400 kg", "40 kg"), "scale": ("lognormal", 1.0, 0.3)}
        with pytest.raises(StudyError, match=words):
            rf.probability_of_overturning(system, PULSE, spread=spread, cases=8, **FAST)


def test_mass_has_no_effect_on_rigid_ground_at_fixed_shape_factor():
    scaling = DRUM.replace(shape_factor=DRUM.shape_factor)
    runs = rf.sweep(rf.System(scaling), PULSE.scaled(2.0), mass=([200, 400, 800], "kg"), **FAST)
    single = rf.System(DRUM).simulate(PULSE.scaled(2.0), **FAST).peak_rotation.item()
    assert single != 0.0
    np.testing.assert_allclose(runs.peak_rotation.values.ravel(), single, rtol=1e-12)
    both = {"mass": ["200 kg", "800 kg"], "inertia": ["69.79 kg*m^2", "279.17 kg*m^2"]}
    runs = rf.sweep(rf.System(DRUM), PULSE.scaled(2.0), cases=both, **FAST)
    np.testing.assert_allclose(runs.peak_rotation.values.ravel(), single, rtol=1e-3)


def test_scaled_copies_of_a_motion_are_labelled_by_factor():
    motions = [PULSE.scaled(2.0), PULSE, PULSE.scaled(2.0), OTHER.scaled(3.0)]
    runs = rf.sweep(ON_PADS, motions, scale=[0.1], **FAST)
    twice = f"2 times {PULSE.name}"
    assert runs.motion.values.tolist() == [twice, PULSE.name, f"{twice} (2)", OTHER.name]


def test_intensity_axes_scale_each_motion_to_the_target():
    motions = [PULSE, OTHER, PULSE]
    for name, target, keywords in (
        ("peak_ground_acceleration", "3 m/s^2", {"peak": "3 m/s^2"}),
        ("peak_ground_velocity", "0.4 m/s", {"peak_velocity": "0.4 m/s"}),
        (
            "pseudo_spectral_acceleration", "3 m/s^2",
            {"spectral_acceleration": "3 m/s^2", "period": "0.5 s"},
        ),
    ):  # fmt: skip
        period = {"period": "0.5 s"} if "spectral" in name else {}
        runs = rf.sweep(ON_PADS, motions, axes={name: [target]}, **period, **FAST)
        assert runs.motion.values.tolist() == [PULSE.name, OTHER.name, f"{PULSE.name} (2)"]
        for k, motion in enumerate(motions):
            alone = ON_PADS.simulate(motion.scaled(**keywords), **FAST)
            assert runs.peak_rotation[0, k].item() == alone.peak_rotation.item()
        assert rf.case(runs, motion=1).motion == OTHER.scaled(**keywords)


def test_a_table_has_a_row_for_each_case():
    rng = np.random.default_rng(7)
    table = pd.DataFrame(
        {
            "width [cm]": rng.uniform(60, 90, 6),
            "damping_ratio": rng.uniform(0.05, 0.3, 6),
            "motion": ["b", "a", "a", "b", 1, 0],
        }
    )
    motions = {"a": PULSE, "b": OTHER}
    runs = rf.sweep(ON_PADS, motions, cases=table, scale=[1.0, 2.0], **FAST)
    assert runs.status.dims == ("case", "scale")
    assert runs.width.dims == runs.damping_ratio.dims == runs.motion.dims == ("case",)
    assert runs.motion.values.tolist() == ["b", "a", "a", "b", "b", "a"]
    np.testing.assert_allclose(runs.width, table["width [cm]"] / 100.0, rtol=1e-15)
    for k in range(6):
        case = rf.case(runs, case=k, scale=2.0)
        assert case.motion == motions[runs.motion[k].item()].scaled(2.0)
        assert case.system.parts.block.si.width == runs.width[k].item()
        assert case.simulate().peak_rotation.item() == runs.peak_rotation[k, 1].item()
    # with motions as a separate dimension
    crossed = rf.sweep(ON_PADS, motions, cases=table.drop(columns="motion"), **FAST)
    assert dict(crossed.status.sizes) == {"case": 6, "motion": 2}
    again = crossed.peak_rotation.sel(motion="b")[[0, 3, 4]]
    np.testing.assert_array_equal(again, runs.peak_rotation.sel(scale=1.0)[[0, 3, 4]])


def test_scene_function_receives_axis_values():
    arguments = []

    def scene(width, height, storeys, pads, stiff):
        arguments.append((width, height, storeys, pads, stiff))
        return tower(width, height, pads, stiff)

    runs = rf.sweep(
        scene, PULSE, width=["0.8 m"], height=([3.0, 3.6], "m"), storeys=[2], pads=["two", "none"],
        stiff=[True], scale=[1.0, 1.5], **FAST,
    )  # fmt: skip
    assert dict(runs.status.sizes) == {
        "width": 1, "height": 2, "storeys": 1, "pads": 2, "stiff": 1, "scale": 2, "motion": 1,
    }  # fmt: skip
    width, height, storeys, pads, stiff = arguments[0]
    assert width.m_as("m") == 0.8
    assert height.m_as("m") in (3.0, 3.6)
    assert (type(storeys), type(pads), type(stiff)) == (int, str, bool)
    case = rf.case(runs, height="3.6 m", pads="two", scale=1.5)
    assert case.system == tower("0.8 m", "3.6 m", "two")
    single = runs.peak_rotation.sel(height=3.6, pads="two", scale=1.5).item()
    assert case.simulate().peak_rotation.item() == single


def test_the_motion_may_be_a_part_of_the_scene_or_none():
    inside = rf.System(BLOCK, PADS, PULSE)
    runs = rf.sweep(inside, scale=[0.5, 1.0], **FAST)
    assert runs.motion.values.tolist() == [PULSE.name]
    assert runs.peak_rotation[1, 0].item() == inside.simulate(**FAST).peak_rotation.item()
    made = rf.sweep(lambda f: rf.System(BLOCK, rf.GroundMotion.sine_pulse("2 m/s^2", f)),
                    f=["1 Hz", "2 Hz"], scale=[1.0, 2.0], **FAST)  # fmt: skip
    assert made.motion.values.tolist() == ["of the scene"]
    motion = rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz").scaled(2.0)
    single = rf.System(BLOCK).simulate(motion, **FAST).peak_rotation.item()
    assert made.peak_rotation.sel(f=2.0, scale=2.0).item() == single
    leaning = rf.InitialState(rotation="0.05 rad")
    free = rf.sweep(rf.System(BLOCK), initial=leaning, duration="3 s", width=["0.7 m", "0.8 m"])
    assert free.motion.values.tolist() == ["none"]
    assert rf.case(free, width="0.7 m").motion is None
    single = rf.System(BLOCK.replace(width="0.7 m")).simulate(initial=leaning, duration="3 s")
    assert free.impact_count[0].item() == single.impact_count.item() > 0


REFUSED = [
    (BLOCK, PULSE, {}, ["scene must be a System, or a function"]),
    (ON_PADS, "a.AT2", {"scale": [1.0]}, ["motions must be a GroundMotion"]),
    (ON_PADS, [], {"scale": [1.0]}, ["motions must be a GroundMotion, or several, got none"]),
    (ON_PADS, None, {"width": ["1 m"]}, ["give motions, or a duration"]),
    (
        ON_PADS,
        PULSE,
        {"widht": [1], "width": [0.8, 0.9], "frequency_ratio": ["20 m"], "height": []},
        ["'widht' names no parameter; was 'width'", "width needs a length with a unit, got",
         "frequency_ratio needs a pure ratio", "'height' has no values"],
    ),
    (
        rf.System(rf.Stack(BLOCK, BLOCK, interfaces=[PADS]), PADS), PULSE, {"mass": ["1 t"]},
        ["'mass' is a parameter of a part of the Stack; instead", "a function of the axis"],
    ),
    (
        rf.System(rf.RockingFrame(BLOCK, columns=2, beam_mass="1 t")), PULSE, {"width": ["1 m"]},
        ["'width' is a parameter of a part of the RockingFrame; instead"],
    ),
    (ON_PADS, PULSE, {"scale": [1.0, 2.0, 1.0]}, ["'scale' has the value 1.0 twice"]),
    (ON_PADS, PULSE, {"overturned": [1.0]}, ["'overturned' has the name of a result"]),
    # names of dimensions of datasets and analyses
    *(
        (lambda **_: ON_PADS, PULSE, {name: ["a", "b"]}, [f"'{name}' has the name of a result"])
        for name in ("body", "restrainer", "peak_slip", "limit_state", "stripe", "flip")
    ),
    (ON_PADS, PULSE, {"rotation": ["small"]}, ["write 'System.rotation'"]),
    (ON_PADS, PULSE, {"axes": {"a b": [1.0]}}, ["'a b' cannot be the name"]),
    (ON_PADS, PULSE, {"axes": {"scale": [1.0]}, "scale": [1.0]}, ["'scale' is given twice"]),
    (
        ON_PADS, PULSE, {"axes": {"Block.width": ["1 m"]}, "width": ["1 m"]},
        ["'Block.width' and 'width' are the same parameter"],
    ),
    (
        ON_PADS, PULSE, {"stiffness": ["5 MN/m"], "frequency_ratio": [20]},
        ["'frequency_ratio' and 'stiffness' stand for one another"],
    ),
    (
        ON_PADS, PULSE, {"scale": [1.0], "peak_ground_acceleration": ["1 m/s^2"]},
        ["'scale' and 'peak_ground_acceleration' all scale the motion"],
    ),
    (
        ON_PADS, PULSE, {"pseudo_spectral_acceleration": ["1 m/s^2"]},
        ["needs the period of its oscillator"],
    ),
    (ON_PADS, PULSE, {"scale": [1.0], "period": "1 s"}, ["which is no axis"]),
    (ON_PADS, PULSE, {"restraint": ["middle"]}, ["restraint must be", "middle"]),
    (
        ON_PADS, PULSE, {"cases": {"width": ["1 m", "2 m"], "height": ["3 m"]}},
        ["columns of cases differ in length: width 2, height 1"],
    ),
    (
        ON_PADS, PULSE, {"cases": {"scale": [1.0, 2.0]}, "scale": [3.0]},
        ["'scale' is both an axis and a column"],
    ),
    (ON_PADS, PULSE, {"cases": {"motion": [0, 1]}}, ["no motion 1; expected a name, or a"]),
    (ON_PADS, PULSE, {"cases": [1, 2]}, ["cases must be a DataFrame, or columns"]),
    (
        ON_PADS, PULSE, {"scale": [1.0], "duration": "1 s", "free_vibration": "1 s"},
        ["give duration or free_vibration"],
    ),
    (ON_PADS, PULSE, {"scale": [1.0], "duration": 3}, ["duration needs a time with a unit"]),
    (ON_PADS, PULSE, {"scale": [1.0], "accuracy": "sloppy"}, ["accuracy must be one of"]),
    (ON_PADS, PULSE, {"scale": [1.0], "outputs": ["colour"]}, ["outputs has no 'colour'"]),
    (ON_PADS, PULSE, {"scale": [1.0], "outputs": "impulse"}, ["are no histories"]),
    (
        ON_PADS, PULSE, {"scale": np.arange(1, 9999.0), "outputs": (), "output_step": "1 us"},
        ["histories of 1000001 times", "TB", "are available", "or keep none: outputs=None"],
    ),
    (
        rf.System(BLOCK, rf.Load(at=("0 m", "3 m"), vertical="1 kN")), PULSE, {"at": ["1 m"]},
        ["axis 'at' is neither a number nor a word; give a function"],
    ),
    (
        rf.System(rf.RockingFrame(BLOCK, columns=2, beam_mass="1 t")), PULSE, {"column": [BLOCK]},
        ["axis 'column' is neither a number nor a word"],
    ),
    (lambda width: None, PULSE, {"height": ["1 m"]}, ["do not fit the arguments of <lambda>"]),
    (lambda width: None, PULSE, {"width": ["1 K"]}, ["width has the unit 'K'"]),
    (lambda width: None, PULSE, {"width": [1.0, "a"]}, ["width needs values of one sort"]),
    (lambda width: None, PULSE, {"width": [True, 2]}, ["width needs values of one sort"]),
]  # fmt: skip


def test_invalid_sweeps_are_refused_with_all_faults():
    for scene, motions, arguments, words in REFUSED:
        with pytest.raises(StudyError) as refused:
            rf.sweep(scene, motions, **arguments)
        for word in words:
            assert word in str(refused.value)


@pytest.mark.parametrize(
    ("option", "words"),
    [
        ({"executor": 4}, "executor must be a concurrent.futures.Executor"),
        ({"executor": ThreadPoolExecutor}, "executor must be a concurrent.futures.Executor, got"),
        ({"chunk": 0}, "chunk must be a whole number"),
        ({"progress": "yes"}, "progress must be True, False or None"),
    ],
)
def test_invalid_execution_options_are_refused(option, words):
    with pytest.raises(ComponentError, match=words):
        rf.sweep(ON_PADS, PULSE, scale=[1.0], **option)


def test_unusual_values_warn_once():
    with pytest.warns(ModelWarning, match="damping_ratio = 5 is 500 %") as caught:
        rf.sweep(ON_PADS, PULSE, damping_ratio=[0.1, 5.0, 10.0], **FAST)
    assert len(caught) == 1


# abbreviations ----------------------------------------------------------------------------------


def test_measure_abbreviations_are_expanded_to_full_axis_names():
    system, sizes = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg")), [2.0, 4.0]
    for short, full, unit, more in (
        ("PGA", "peak_ground_acceleration", "m/s^2", {}),
        ("PGV", "peak_ground_velocity", "m/s", {}),
        ("SA", "pseudo_spectral_acceleration", "m/s^2", {"period": "0.5 s"}),
    ):
        one, other = (
            rf.sweep(system, PULSE, **{name: (sizes, unit)}, **more, **FAST)
            for name in (short, full)
        )
        xr.testing.assert_identical(one.drop_attrs(), other.drop_attrs())
        assert one.peak_rotation.dims == (full, "motion")
        assert one.sizes[full] == 2
        alone = rf.case(one, **{short: 4.0}).simulate(outputs=None)
        assert alone.peak_rotation.item() == one.peak_rotation.sel({full: 4.0}).item()
    peaks = rf.sweep(system, PULSE, cases={"PGA [m/s^2]": sizes}, **FAST)
    assert peaks.peak_ground_acceleration.values.tolist() == sizes
    spread = {"PGA": ("lognormal", "3 m/s^2", 0.2), "width": ("normal", "0.5 m", "2 cm")}
    sample = rf.probability_of_overturning(
        system, PULSE, spread=spread, correlation={("PGA", "width"): 0.4}, cases=20, **FAST
    )
    assert "peak_ground_acceleration" in sample.parameter
    with pytest.raises(StudyError, match="'peak_ground_acceleration' is given twice"):
        rf.sweep(system, PULSE, PGA=["1 m/s^2"], peak_ground_acceleration=["2 m/s^2"])
    with pytest.raises(StudyError, match="all scale the motion"):
        rf.sweep(system, PULSE, PGA=["1 m/s^2"], scale=[1.0])


def test_scene_function_argument_may_be_named_like_an_abbreviation():
    def scene(PGA):  # noqa: N803
        return rf.System(rf.Block(width="0.5 m", height=f"{PGA} m", mass="400 kg"))

    runs = rf.sweep(scene, PULSE, PGA=[1.0, 2.0], **FAST)
    assert runs.sizes["PGA"] == 2


def test_wrapped_scene_function_has_arguments_of_its_wrapper():
    def scene(width, height):
        return rf.System(rf.Block(width=width, height=height, mass="1 t"))

    @wraps(scene)
    def of_slenderness(slenderness):
        return scene("1 m", f"{slenderness} m")

    @wraps(scene)
    def passing_on(*arguments, **named):
        return scene(*arguments, **named)

    runs = rf.sweep(of_slenderness, PULSE, slenderness=[3.0, 4.0], **FAST)
    again = rf.sweep(passing_on, PULSE, width=["1 m"], height=["3 m", "4 m"], **FAST)
    np.testing.assert_array_equal(runs.peak_rotation, again.peak_rotation[0])
    for function, axes in ((of_slenderness, {"width": ["1 m"]}), (passing_on, {"mass": ["1 t"]})):
        with pytest.raises(StudyError, match="do not fit the arguments of"):
            rf.sweep(function, PULSE, **axes)
