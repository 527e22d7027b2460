"""Sweeps of scenes with restrainers and several bodies: variables and labels of each."""

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.events import LINK_BREAKS
from rockframe.errors import ComponentError, ModelWarning, SchemaError

PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
STATUE = rf.Block(width="0.6 m", height="2.4 m", mass="800 kg")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
ROUGH = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1, friction=0.5)
FOUR = {"free_vibration": "1 s"}


def tie(name: str, side: float, strength: str = "8 kN") -> rf.Restrainer:
    return rf.Restrainer(
        on=(f"{0.3 * side} m", "2 m"), to=(f"{1.3 * side} m", "2 m"), stiffness="500 kN/m",
        slack="5 mm", strength=strength, brittle=True, name=name,
    )  # fmt: skip


def column(drums: int) -> rf.System:
    """Make a column of stacked drums."""
    drum = rf.Block(width="1 m", height="1.5 m", mass="2 t")
    return rf.System(rf.Stack(*[drum] * drums, interfaces=[ROUGH] * (drums - 1)), ROUGH)


TIED = rf.System(STATUE, PADS, tie("west", -1), tie("east", 1, "3 kN"))


@pytest.fixture(scope="module")
def broken():
    """Sweep over the strength of one of two ties, with enough cases for lanes."""
    axes = {"west.strength": (np.linspace(1.0, 30.0, 12), "kN")}
    return rf.sweep(TIED, PULSE, axes=axes, scale=[0.3, 0.6, 1.0], **FOUR)


@pytest.mark.parametrize("scale", [0.3, 0.6, 1.0])
def test_broken_ties_are_counted_in_all_runs(broken, scale):
    assert set(np.unique(broken.broken_restrainer_count)) > {0.0, 2.0}
    for strength in broken["west.strength"].values[[0, 3, 11]]:
        place = {"west.strength": strength, "scale": scale}
        alone = rf.case(broken, **place).simulate()
        breaks = int((alone.event_kind == LINK_BREAKS).sum())
        found = broken.broken_restrainer_count.sel(place).item()
        assert found == breaks == alone.broken_restrainer_count.item()
        verdict = alone.attrs["verdict"]
        assert verdict.count("broke") == (breaks > 0)
        assert ("west and east broke" in verdict) == (breaks == 2)
    cases_with_breaks = int((broken.broken_restrainer_count > 0).sum())
    assert f"; in {cases_with_breaks} a restrainer broke." in broken.attrs["verdict"]


def frame() -> rf.System:
    """Make a frame with a tendon that breaks along each column."""
    pier = rf.Block(width="1.6 m", height="9.6 m", mass="60 t")
    tendon = rf.Tendon(stiffness="10 MN/m", preload="400 kN", strength="600 kN", brittle=True)
    return rf.System(rf.RockingFrame(pier, columns=3, beam_mass="200 t"), tendon)


def stacked() -> rf.System:
    """Make a tied statue on a plinth on rigid ground."""
    plinth = rf.Block(width="0.9 m", height="0.8 m", mass="1500 kg")
    statue = rf.Block(width="0.5 m", height="1.5 m", mass="600 kg")
    wire = rf.Restrainer(
        on_body=1, on=("0 m", "1.4 m"), to=("-1.5 m", "2.2 m"), stiffness="200 kN/m",
        breaking_elongation="1 cm",
    )  # fmt: skip
    return rf.System(rf.Stack(statue, plinth, interfaces=[rf.RigidGround()]), wire)


@pytest.mark.parametrize("scene", [frame, pytest.param(stacked, marks=pytest.mark.long)])
def test_broken_restrainer_count_equals_break_events(scene):
    motion = rf.GroundMotion.type_a_pulse("1.2 m/s", "1.6 s") if scene is frame else PULSE
    scales = [0.3, 1.3333]  # with a peak of 4 m/s^2
    asked = {"accuracy": "fast", "overturning": "continue", "free_vibration": "0.1 s"}
    with plain_python():  # no other test compiles the equations of tied rigid bodies
        runs = rf.sweep(scene(), motion, scale=scales, **asked)
        alone = [scene().simulate(motion.scaled(scale), **asked) for scale in scales]
    counts = runs.broken_restrainer_count.values.ravel().tolist()
    assert counts == [int((one.event_kind == LINK_BREAKS).sum()) for one in alone] == [0, 1]


def test_a_broken_tie_is_a_limit_state(broken):
    found = rf.fragility(broken, limits=[("broken_restrainer_count", 1)], pooled=["west.strength"])
    assert found.trial_count.values.tolist() == [36, 36]
    assert found.stripe_exceedances.isel(limit_state=0).sum() == int(
        (broken.broken_restrainer_count > 0).sum()
    )


def test_restrainers_are_labelled_by_name(tmp_path):
    runs = rf.sweep(TIED, PULSE, scale=[0.3, 1.0], outputs=[], **FOUR)
    assert runs.restrainer.values.tolist() == ["west", "east"]
    limit = ("peak_restrainer_force", "2 kN", "east")
    state = rf.fragility(runs, limits=[limit]).limit_state.values[0]
    assert state == "peak restrainer force east 2000 N"
    with pytest.raises(ComponentError, match="give one of 'west', 'east', got ''"):
        rf.fragility(runs, limits=[limit[:2]])
    one = rf.System(STATUE, PADS, tie("only", -1))
    runs = rf.sweep(one, PULSE, scale=[0.3, 1.0], outputs=[], store=tmp_path / "kept", **FOUR)
    assert rf.fragility(runs, limits=[limit[:2]]).limit_state.size == 2
    for lazy in (False, True):
        stored = rf.open_study(tmp_path / "kept", lazy=lazy)
        assert stored.restrainer.values.tolist() == ["only"]


def test_restrainer_names_of_a_function_are_used_if_all_cases_agree():
    def alike(strength: float) -> rf.System:
        return rf.System(STATUE, PADS, tie("upper", -1, f"{strength} kN"))

    def unlike(number: int) -> rf.System:
        return rf.System(STATUE, PADS, tie(f"tie {number}", -1))

    options = {"outputs": ["energy"], **FOUR}
    assert rf.sweep(alike, PULSE, strength=[1.0, 9.0], **options).restrainer.values == ["upper"]
    assert rf.sweep(unlike, PULSE, number=[7, 8], **options).restrainer.values == ["1"]


@pytest.mark.wide
def test_case_with_other_restrainer_names_warns():
    def scene(number: int) -> rf.System:  # too many to be examined in advance
        names = ("east", "west") if number == 5 else ("west", "east")
        return rf.System(STATUE, PADS, *(tie(name, -1) for name in names))

    options = {"outputs": ["rotation"], "duration": "0.02 s", "accuracy": "fast"}
    with plain_python(), pytest.warns(ModelWarning, match="its restrainers are east, west, not as"):
        runs = rf.sweep(scene, PULSE, number=range(40), **options)
    assert runs.restrainer.values.tolist() == ["west", "east"]
    assert np.flatnonzero(runs.message != "none").tolist() == [5]


@pytest.mark.parametrize(
    "outputs", [None, *(pytest.param(one, marks=pytest.mark.long) for one in ([], ["energy"]))]
)
def test_sweep_pads_cases_with_fewer_bodies(tmp_path, outputs):
    options = {"drums": [3, 2, 4], "scale": [0.5, 1.0], "outputs": outputs, **FOUR}
    runs = rf.sweep(column, PULSE, chunk=1, store=tmp_path / "kept", **options)
    assert runs.body.values.tolist() == [1, 2, 3, 4]
    slips = runs.peak_body_slip
    assert np.isfinite(slips).sum("body").squeeze().values.tolist() == [[3, 3], [2, 2], [4, 4]]
    alone = rf.case(runs, drums=2, scale=1.0, scene=column).simulate()
    picked = slips.sel(drums=2, scale=1.0).squeeze()
    np.testing.assert_array_equal(picked[:2], alone.peak_body_slip)
    assert alone.peak_slip == alone.peak_body_slip[0]
    xr_again = rf.open_study(tmp_path / "kept", lazy=True)
    np.testing.assert_array_equal(xr_again.peak_body_slip.values, slips.values)
    in_memory = rf.sweep(column, PULSE, **options)
    np.testing.assert_array_equal(in_memory.peak_body_slip, slips)


@pytest.mark.filterwarnings("ignore:.*beyond the edge")
def test_slips_of_a_body_are_a_limit_state():
    runs = rf.sweep(column(2), PULSE, friction=[0.2, 0.3], scale=[0.5, 1.0, 2.0], **FOUR)
    found = rf.fragility(runs, limits=[("peak_body_slip", "1 cm", 2)], pooled=["friction"])
    most = int(((runs.peak_body_slip.sel(body=2) >= 0.01) | runs.overturned).sum())
    assert int(found.stripe_exceedances.isel(limit_state=0).sum()) == most > 0


def test_missing_variables_raise_with_a_remedy():
    runs = rf.sweep(rf.System(STATUE, PADS), PULSE, scale=[0.3, 1.0], **FOUR)
    for wrong, kind, match in (
        (("peak_settlement", "1 cm"), SchemaError, r"a sweep has it with points=\{...\}"),
        (("peak_setlement", "1 cm"), ComponentError, "'peak_settlement' or"),
        (("peak_point_vertical_displacement", "1 cm"), SchemaError, "has it with points"),
        (("peak_body_slip", "1 cm", 1), SchemaError, "the runs have no 'peak_body_slip"),
    ):
        with pytest.raises(kind, match=match):
            rf.fragility(runs, limits=[wrong])


def test_sequences_have_the_slip_of_each_body():
    drums, ends = column(2), {"pause": "1 s", "progress": False}
    sequences = {"both": [PULSE, PULSE.scaled(1.6)], "one": [PULSE.scaled(1.6)]}
    slips = rf.earthquake_sequences(drums, sequences, **ends).peak_body_slip
    assert slips.dims == ("sequence", "earthquake", "body")
    assert slips.body.values.tolist() == [1, 2]
    for name, motion in (("both", PULSE), ("one", PULSE.scaled(1.6))):
        single = drums.simulate(motion, free_vibration="1 s").peak_body_slip
        assert float(single.max()) > 0.0
        np.testing.assert_allclose(slips.sel(sequence=name, earthquake=1), single, rtol=1e-6)
    both = slips.sel(sequence="both")
    assert (both.sel(earthquake=2) >= both.sel(earthquake=1)).all()
    assert np.isnan(slips.sel(sequence="one", earthquake=2)).all()
