"""Figures and reports of cases selected from sweeps, and of derived sweeps."""

import pytest

import rockframe as rf
from rockframe.errors import SchemaError, StudyError
from rockframe.plot._checks import system_of_run
from rockframe.studies.sweeps import study as studies_at_hand

BLOCK = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
PULSE = rf.GroundMotion.sine_pulse("5 m/s^2", "1 Hz")
QUIET = {"accuracy": "fast", "progress": False}


@pytest.fixture(scope="module")
def overturned_case():
    """A case that ends before the other one, with NaN in its histories after its end."""
    runs = rf.sweep(rf.System(BLOCK), PULSE, scale=[0.5, 1.6], outputs=[], **QUIET)
    case = runs.isel(scale=1, motion=0)
    assert case.rotation.isnull().any()
    return case


@pytest.mark.parametrize("draw", [rf.plot.response, rf.plot.phase, rf.plot.state])
def test_overturned_case_can_be_plotted(overturned_case, draw):
    axes = draw(overturned_case)
    figure = axes.figure if hasattr(axes, "figure") else axes[0].figure
    figure.canvas.draw()


def test_case_title_states_its_own_outcome(overturned_case):
    time = overturned_case.overturning_time.item()
    expected = f"{{}}scale 1.6: overturned at {time:.4g} s"
    motion_words = f"motion {overturned_case.motion.item()}, "
    panel = rf.plot.response(overturned_case, panels="rotation")
    assert panel.figure.get_suptitle() == expected.format(motion_words)
    assert expected.format(motion_words) in rf.plot.player(overturned_case).to_html()
    runs = rf.sweep(rf.System(BLOCK), PULSE, scale=[0.3, 0.5], outputs=[], **QUIET)
    standing = runs.isel(scale=1, motion=0)
    share, peak = standing.peak_relative_rotation.item(), standing.peak_rotation.item()
    title = rf.plot.phase(standing).figure.get_suptitle()
    assert " ".join(title.split()) == (
        f"{motion_words}scale 0.5: did not overturn, peak rotation {peak:.4g} rad, "
        f"{100 * share:.3g} % of the overturning angle"
    )
    (legend,) = [
        axes.get_legend()
        for axes in rf.plot.phase([standing, runs.isel(scale=0, motion=0)]).figure.axes
    ]
    assert [text.get_text().split("scale ")[1] for text in legend.get_texts()] == ["0.5", "0.3"]


def test_player_and_animation_end_with_the_case(overturned_case):
    end = float(overturned_case.time[overturned_case.rotation.notnull()][-1])
    assert f"player of {end:.1f} s" in repr(rf.plot.player(overturned_case))
    assert "animation of 13 frames" in repr(rf.plot.animation(overturned_case))
    assert "nan" not in overturned_case.rockframe._repr_html_()


def test_a_case_is_drawn_with_its_own_block():
    wide = BLOCK.replace(width="1.2 m")
    runs = rf.sweep(
        rf.System(BLOCK), PULSE, width=["0.8 m", "1.2 m"], scale=[0.5, 1.0], outputs=[], **QUIET
    )
    for dataset, width in ((runs.isel(width=1, scale=0, motion=0), 1.2), (runs, 0.8)):
        assert system_of_run(dataset, "state").parts.block_si.width == width
    selected, alone = (
        rf.plot.state(case, "0.2 s").get_xlim()
        for case in (
            runs.isel(width=1, scale=1, motion=0),
            rf.System(wide).simulate(PULSE, accuracy="fast"),
        )
    )
    assert selected == pytest.approx(alone, rel=1e-6)


def test_a_case_without_a_result_is_refused(overturned_case):
    with pytest.raises(SchemaError, match="got a case without a result"):
        rf.plot.response(
            overturned_case.assign(
                relative_rotation=overturned_case.relative_rotation * float("nan")
            )
        )


@pytest.mark.wide
def test_case_of_a_stack_without_body_histories_is_refused():
    stone = rf.RigidGround()
    system = rf.System(rf.Stack(BLOCK, BLOCK, interfaces=[stone]), stone)
    runs = rf.sweep(system, PULSE, scale=[0.5], outputs=[], duration="0.1 s", **QUIET)
    with pytest.raises(SchemaError, match=r"lacks 'body_rotation'.*rf\.case"):
        rf.plot.state(runs.squeeze())


@pytest.mark.parametrize("outputs", [["energy"], None])
def test_error_for_case_without_histories_suggests_a_working_call(outputs):
    runs = rf.sweep(rf.System(BLOCK), PULSE, scale=[0.5, 0.6], outputs=outputs, **QUIET)
    case = runs.isel(scale=1, motion=0)
    advice = r"got a Dataset with a case of a sweep without .*; rf\.case\(dataset\)\.simulate\(\)"
    for draw in (rf.plot.response, rf.plot.state, rf.plot.phase, rf.plot.player):
        with pytest.raises(SchemaError, match=advice):
            draw(case)
        draw(rf.case(case).simulate())
    with pytest.raises(SchemaError, match=r"no function .* a case of a sweep without .*rf\.case"):
        case.rockframe.plot()
    with pytest.raises(
        SchemaError, match=r"many runs; rf\.plot\.sweep.*, rf\.case\(dataset, \.\.\."
    ):
        rf.plot.response(runs)
    with pytest.raises(SchemaError, match=r"many runs; rf\.plot\.sweep draws it$"):
        rf.plot.fragility(runs)
    with pytest.raises(SchemaError, match=r"got a case of a sweep; rf\.plot\.response\(case\.sim"):
        rf.plot.response(rf.case(case))


def test_error_for_case_without_energies_suggests_a_working_call(overturned_case):
    with pytest.raises(SchemaError, match=r"rf\.case\(dataset\)\.simulate\(outputs=\('energy',\)"):
        rf.plot.energies(overturned_case)
    rf.plot.energies(rf.case(overturned_case).simulate(outputs=("energy",)))


def tower(width):
    return rf.System(BLOCK.replace(width=f"{width} m"))


NEEDS_SYSTEM = {
    "rf.plot.state": lambda case, path: rf.plot.state(case),
    "rf.plot.player": lambda case, path: rf.plot.player(case),
    "rf.plot.animation": lambda case, path: rf.plot.animation(case),
    "report": lambda case, path: rf.report(case, path / "report.html", certify=False),
    "case": lambda case, path: rf.case(case),
}


@pytest.fixture(scope="module")
def case_of_function():
    runs = rf.sweep(tower, PULSE, width=[0.8, 1.0], outputs=[], **QUIET)
    return runs.isel(width=1, motion=0)


@pytest.mark.parametrize("owner", NEEDS_SYSTEM)
def test_case_without_axis_coordinate_is_refused_naming_the_caller(owner, tmp_path):
    runs = rf.sweep(rf.System(BLOCK), PULSE, width=["0.8 m", "1 m"], outputs=[], **QUIET)
    case = runs.isel(width=1, motion=0).drop_vars("width")
    with pytest.raises(
        SchemaError, match=f"^{owner}: found a sweep without its coordinate 'width'"
    ):
        NEEDS_SYSTEM[owner](case, tmp_path)


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize("owner", NEEDS_SYSTEM)
def test_case_of_an_unknown_scene_function_is_refused_naming_the_caller(
    owner, tmp_path, case_of_function, monkeypatch
):
    NEEDS_SYSTEM[owner](case_of_function, tmp_path)
    monkeypatch.setattr(studies_at_hand, "_cache", {})  # as in another process
    hint = "give it as scene=" if owner == "case" else r"give rf\.case\(dataset, scene=\.\.\.\)"
    with pytest.raises(StudyError, match=f"^{owner}: the scene was the function .*tower; {hint}"):
        NEEDS_SYSTEM[owner](case_of_function, tmp_path)


def test_system_of_a_function_sweep_is_obtained_from_a_case(case_of_function):
    with pytest.raises(SchemaError, match=r"sweep over width, .*rf\.case\(dataset\)\.system"):
        rf.System.from_dataset(case_of_function)
    assert rf.case(case_of_function).system == tower(1.0)


@pytest.mark.usefixtures("no_pictures")
def test_report_accepts_cases_and_derived_sweeps(overturned_case, tmp_path):
    system, path = rf.System(BLOCK), tmp_path / "report.html"
    runs = rf.sweep(system, PULSE, scale=[0.5], outputs=["energy"], **QUIET)
    other = rf.sweep(system, PULSE, scale=[0.6], duration="1 s", **QUIET)
    datasets = {
        "in a row": rf.concat([runs, other], "scale"),
        "of one index": runs.stack(both=("scale", "motion")),
        "with energies alone": runs.squeeze(),
        "a case": overturned_case,
    }
    for name, dataset in datasets.items():
        text = rf.report(dataset, path, certify=False, overwrite=True).read_text("utf-8")
        assert all(
            words in text for words in ("Provenance", "data:image/svg", "5500 kg", "</html>")
        ), name


@pytest.mark.usefixtures("no_pictures")
def test_report_without_motion_describes_only_its_case(tmp_path):
    record = rf.GroundMotion.from_arrays(([0.0, 5.0, 5.0, -5.0, 0.0], "m/s^2"), "0.2 s", name="r")
    runs = rf.sweep(rf.System(BLOCK), record, width=["0.8 m", "1.2 m"], scale=[0.1, 1.0], **QUIET)
    studies_at_hand._cache.clear()  # as in another process
    case, path = runs.isel(width=1, scale=0, motion=0), tmp_path / "report.html"
    text = rf.report(case, path).read_text("utf-8")
    assert "Of 1 of the 4 cases of the sweep 0 overturned and 1 did not" in text
    assert "0.8 m" not in text
    assert "1.2 m" in text
    text = rf.report(case, path, motion=record, certify=False).read_text("utf-8")
    assert "1.2 m" in text
    assert "0.1 times r" in text
    with pytest.raises(StudyError, match="not among those given"):
        rf.report(case, path, motion=PULSE)


def test_fragility_requires_motion_coordinate():
    runs = rf.sweep(rf.System(BLOCK), PULSE, scale=[0.5, 1.6], **QUIET)
    with pytest.raises(SchemaError, match="without the coordinate 'motion'"):
        rf.fragility(runs.mean("motion", keep_attrs=True), "PGA")
