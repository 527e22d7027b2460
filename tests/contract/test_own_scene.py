"""A user-defined scene, from the example's file, behaves like a scene of the package."""

import json
import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr
from plain_python import plain_python
from user_examples import SCENE_FILE, TABLES, example, restored_registrations

import rockframe as rf
from rockframe import extension as ext
from rockframe.command.files.scenes import read_scene
from rockframe.compiled import COMPILED
from rockframe.errors import AssemblyError, ComponentError, SolverWarning
from rockframe.results.schema import SCHEMA
from rockframe.studies.sweeps import study

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
PULSE = rf.GroundMotion.sine_pulse(amplitude="-3.5 m/s^2", frequency="1 Hz")
RUN = {"free_vibration": "1 s"}


@pytest.fixture(scope="module", autouse=True)
def own():
    """Return the module of the example, its scene registered."""
    with example(SCENE_FILE) as module:
        yield module


@pytest.fixture
def ground(own):
    return own.SlidingGround(friction=0.26)


@pytest.fixture
def system(ground):
    return rf.System(BLOCK, ground)


@pytest.fixture
def response(system):
    return system.simulate(PULSE, **RUN, outputs=["energy", "edge_height"])


class TestSystem:
    def test_description_lists_model_and_friction(self, system, ground):
        text = system.describe()
        assert text.startswith("Model: slide-rock\n")
        assert repr(ground) in text
        assert "friction at rest, and of slip     0.26, 0.26" in text
        assert "jamming" in text
        assert "<svg" in system._repr_html_()

    def test_example_file_is_short_and_imports_only_public_names(self):
        text = SCENE_FILE.read_text(encoding="utf-8")
        assert sum(bool(line.strip()) for line in text.splitlines()) < 350
        assert "from rockframe import extension as ext" in text
        assert "import rockframe." not in text
        assert "from rockframe." not in text

    def test_order_of_parts_does_not_matter(self, system, ground):
        assert rf.System(ground, BLOCK, PULSE).parts.replace(motion=None) == system.parts
        assert hash(rf.System(ground, BLOCK)) == hash(system)
        assert rf.System(BLOCK, ground.replace(friction=0.4)) != system

    def test_system_survives_dict_round_trip(self, system):
        assert rf.System.from_dict(json.loads(json.dumps(system.to_dict()))) == system

    def test_scene_can_be_read_from_toml_file(self, system, tmp_path):
        (tmp_path / "own_scene.py").write_text(SCENE_FILE.read_text(encoding="utf-8"))
        file = tmp_path / "scene.toml"
        file.write_text(
            'modules = ["own_scene.py"]\n[block]\nwidth = "1 m"\nheight = "4 m"\nmass = "10 t"\n'
            "[sliding_ground]\nfriction = 0.26\n"
        )
        assert read_scene(file).system == system

    @pytest.mark.parametrize(
        ("parts", "words"),
        [
            ((), "no Block is given"),
            ((BLOCK, rf.RigidGround()), "no scene is made of Block and RigidGround and Sliding"),
            (
                (BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)),
                "no scene is made of Block and TwoSpringSupport and SlidingGround together",
            ),
        ],
    )
    def test_other_combinations_are_refused_with_list_of_scenes(self, ground, parts, words):
        with pytest.raises(AssemblyError, match=words) as caught:
            rf.System(*parts, ground)
        assert str(caught.value).endswith("\n  Block + SlidingGround (SlidingScene)")
        assert "\n  Block + WinklerSoil" in str(caught.value)

    def test_scene_refuses_unsuitable_block_and_friction(self, own, ground):
        with pytest.raises(AssemblyError, match="needs a symmetric block on level ground"):
            rf.System(BLOCK, ground, inclination="1 deg")
        with pytest.raises(AssemblyError, match="the kinetic friction is above that at rest"):
            rf.System(BLOCK, own.SlidingGround(friction=0.2, kinetic_friction=0.3))

    def test_unsupported_analyses_are_refused(self, system):
        with pytest.raises(AssemblyError, match="slide-rock has no small motion"):
            system.frequencies()
        with pytest.raises(AssemblyError, match="slide-rock has no quasi-static states"):
            system.moment_rotation("0.1 rad")
        with pytest.raises(AssemblyError, match="slide-rock has no state of rest"):
            system.equilibrium()
        start = rf.InitialState(vertical_velocity="1 m/s")
        with pytest.raises(AssemblyError, match="are no start of slide-rock"):
            system.simulate(initial=start, duration="1 s")


class TestRun:
    def test_own_variables_of_all_dimensions_are_labelled(self, response):
        assert response.slip.dims == ("time",)
        assert response.event_slip.dims == response.event_time.dims == ("event",)
        assert response.residual_slip.dims == ()
        assert response.residual_slip.attrs == {
            "units": "m", "long_name": "slip of the base at the end of the run"
        }  # fmt: skip
        assert float(response.residual_slip) == float(response.slip[-1]) != 0.0
        at_events = response.slip.sel(time=response.event_time, method="bfill")
        np.testing.assert_allclose(response.event_slip, at_events, atol=1e-2)
        assert response.attrs["model"] == "slide-rock"
        assert response.attrs["cautions"] == "none"
        assert "riction" not in response.attrs["verdict"]

    def test_netcdf_and_back(self, response, system, tmp_path):
        file = tmp_path / "response.nc"
        response.to_netcdf(file)
        with xr.open_dataset(file) as read:
            for name in ("slip", "event_slip", "residual_slip", "edge_height"):
                np.testing.assert_array_equal(read[name], response[name])
                assert read[name].attrs == response[name].attrs
            again = rf.System.from_dataset(read)
        assert again.parts.structural() == system.parts.structural()
        repeated = again.simulate(**RUN, outputs=["energy", "edge_height"])
        for name in response.variables:
            np.testing.assert_array_equal(repeated[name], response[name], err_msg=name)

    def test_run_can_be_continued(self, system, response):
        first = system.simulate(PULSE)
        continued = system.simulate(initial=first, duration="1 s")
        assert float(continued.slip[0]) == float(first.slip[-1])
        assert float(continued.slip[-1]) == pytest.approx(float(response.slip[-1]), rel=1e-9)

    def test_outputs_none_leaves_out_own_variables(self, system):
        bare = system.simulate(PULSE, outputs=None)
        assert not {"slip", "event_slip", "residual_slip"} & set(bare.variables)

    def test_certificate_perturbs_own_parameters(self, system):
        nudged = {
            words for words, _ in rf.simulation.certify.perturbations.parameters(system.assembly)
        }
        assert "friction of the ground" in nudged
        certified = system.simulate(PULSE, **RUN, certify=rf.Certification(runs=60))
        assert bool(certified.verdict_converged)

    @pytest.mark.usefixtures("no_pictures")
    def test_report_and_figures(self, response, system, tmp_path):
        text = rf.report(response, tmp_path / "run.html").read_text(encoding="utf-8")
        assert "slide-rock" in text
        assert "The base does not slide while it is in contact" not in text
        rf.plot.response(response)
        rf.plot.scene(system)


class TestStudies:
    def test_sweep_axes_accept_own_parameters(self, system):
        runs = rf.sweep(
            system, PULSE, friction=[0.2, 0.26], width=["1 m", "1.1 m"], **RUN,
            outputs=["slip", "edge_height"], progress=False,
        )  # fmt: skip
        single = rf.case(runs, friction=0.26, width="1 m").simulate()
        selected = runs.sel(friction=0.26, width=1.0).isel(motion=0)
        for name in ("peak_rotation", "residual_slip", "peak_edge_height"):
            assert float(selected[name]) == float(single[name])
        np.testing.assert_array_equal(selected.slip, single.slip)
        np.testing.assert_array_equal(selected.edge_height, single.edge_height)

    def test_sweep_over_function_that_builds_scene(self, own):
        def scene(mu):
            return rf.System(BLOCK, own.SlidingGround(friction=mu))

        runs = rf.sweep(scene, PULSE, mu=[0.2, 0.26], **RUN, progress=False)
        alone = scene(0.26).simulate(PULSE, **RUN)
        assert float(runs.peak_rotation[1, 0]) == float(alone.peak_rotation) > 0.0

    @pytest.mark.long
    def test_many_sweep_cases_match_single_runs(self, system, monkeypatch):
        """In lanes where it can be compiled; each case ends."""
        monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)
        frictions = np.linspace(0.255, 0.4, 2 * study.MIN_CASES_IN_LANES if COMPILED else 50)
        runs = rf.sweep(system, PULSE, friction=frictions, accuracy="fast", progress=False)
        assert ("side by side" in runs.attrs["driver"]) == COMPILED
        assert int(runs.overturned.sum()) == 0
        assert int(runs.overturned.count()) == len(frictions)
        for k in 0, 5, len(frictions) - 1:
            alone = rf.case(runs, friction=frictions[k]).simulate(second_look=False)
            assert float(runs.peak_rotation[k, 0]) == float(alone.peak_rotation)

    def test_critical_scale_and_ladder(self, system):
        found = rf.critical_scale(system, PULSE, **RUN, progress=False)
        assert 1.0 < float(found.critical_scale) < 4.0
        assert list(rf.model_ladder(system)) == [
            "rigid ground, small rotations", "rigid ground", "slide-rock",
        ]  # fmt: skip


@pytest.mark.skipif(not COMPILED, reason="this run does without compilation")
def test_compiled_and_uncompiled_runs_agree(system):
    compiled = system.simulate(PULSE, duration="1.5 s")
    with plain_python():
        plain = system.simulate(PULSE, duration="1.5 s")
    for name in ("rotation", "slip", "peak_rotation"):
        np.testing.assert_allclose(compiled[name], plain[name], rtol=1e-9, atol=1e-12)


class Wedge(ext.Component):
    """A part of no scene."""

    friction = ext.Ratio(ext.POSITIVE, doc="Coefficient of friction.", default=0.3)


class Bare(ext.OwnScene):
    """A scene without declarations."""


def column(**changed):
    declaration = {
        "name": "wear",
        "dims": ext.TIME,
        "unit": ext.Unit.METRE,
        "long_name": "wear of it",
    }
    return ext.Variable(**{**declaration, **changed})


class TestRegistration:
    @pytest.fixture(autouse=True)
    def restored(self):
        with restored_registrations():
            yield

    @pytest.fixture
    def wedged(self, own):
        """Return the example's scene with another part, not registered."""

        class Wedged(own.SlidingScene):
            """The same equations on a wedge."""

            made_of: ClassVar = {"block": rf.Block, "wedge": Wedge}

            @property
            def frictions(self):
                return (self.parts["wedge"].si.friction,) * 2

        return Wedged

    def test_part_of_unregistered_scene_is_refused(self):
        with pytest.raises(AssemblyError, match="no scene that is registered is made of it"):
            rf.System(BLOCK, Wedge())

    def test_a_registered_scene_is_simulated(self, wedged, system):
        rf.register(wedged)
        rf.register(wedged)  # again, as when a notebook's cell is repeated
        response = rf.System(BLOCK, Wedge(friction=0.26)).simulate(PULSE)
        np.testing.assert_array_equal(response.slip, system.simulate(PULSE).slip)
        with pytest.raises(AssemblyError) as caught:
            rf.System(Wedge())
        assert str(caught.value).count("(Wedged)") == 1

    def test_columns_can_have_own_dimensions(self, wedged):
        class Layered(wedged):
            """Has an additional table."""

            def answers(self, histories, before, after):
                slip = histories["slip"]
                return {**super().answers(histories, before, after), "level": ["low", "high"],
                        "wear": [np.abs(slip).max(), 0.0], "wear_along": [slip, 0.0 * slip],
                        "slips": int((slip != 0.0).any())}  # fmt: skip

        rf.register(
            Layered,
            columns=[
                column(dims=("level",)),
                column(name="wear_along", dims=("level", "time")),
                column(name="level", dims=("level",), unit=None, dtype="str"),
                column(name="slips", dims=(), unit="1", dtype="int64"),
            ],
        )
        response = rf.System(BLOCK, Wedge(friction=0.26)).simulate(PULSE)
        assert response.wear.sel(level="low") == np.abs(response.slip).max() > 0.0
        assert response.wear_along.dims == ("level", "time")
        assert response.slips.dtype == "int64"
        assert response.attrs["cautions"] == "none"

    @pytest.mark.parametrize(
        ("answer", "words"),
        [
            ({"residual_slip": np.zeros(3)}, "'residual_slip' over () has the shape (3,)"),
            ({"event_slip": np.zeros(99)}, "'event_slip' over ('event',) has the shape (99,), exp"),
            ({"worn": 1.0}, "'worn' is not in the schema"),
            (None, "AttributeError"),
        ],
    )
    def test_wrong_answers_warn_without_losing_run(self, wedged, answer, words):
        class Wrong(wedged):
            """Returns undeclared outputs."""

            def answers(self, histories, before, after):
                return answer if answer is None else dict(answer)

        rf.register(Wrong)
        with pytest.warns(SolverWarning, match="the results of Wrong could not be"):
            response = rf.System(BLOCK, Wedge(friction=0.26)).simulate(PULSE)
        assert words in response.attrs["cautions"]
        assert "slip" in response
        assert "residual_slip" not in response

    def test_all_faults_are_reported_and_nothing_is_registered(self):
        before = [dict(table) for table in TABLES]
        with pytest.raises(ComponentError) as caught:
            rf.register(Bare, columns=[column(dims=("layer",)), column(name="2nd", dims=()), 3])
        message = str(caught.value)
        for fault in (
            "Bare has no name model", "Bare has no method contact_model()",
            "Bare has no method words()",
            "Bare.made_of must name slots", "nothing labels 'layer'", "a column is called '2nd'",
            "columns must be Variables, got 3", "Bare has no method answers(",
        ):  # fmt: skip
            assert fault in message
        assert before == [dict(table) for table in TABLES]

    @pytest.mark.parametrize(
        ("made_of", "words"),
        [
            ({"wedge": Wedge}, "has no Block among its parts"),
            ({"block": rf.Block}, "is made of rockframe's own parts alone"),
            ({"body": rf.Block, "wedge": Wedge}, "Block fills the slot 'block'"),
            ({"block": rf.Block, "pads": Wedge}, "the slot is one of rockframe's own parts"),
            ({"block": rf.Block, "the wedge": Wedge}, "a slot is called by a name such as"),
            ({"block": rf.Block, "wedge": 3}, "must be a class of components, got 3"),
            ((rf.Block, Wedge), "must name slots and classes of parts"),
            ({"block": rf.Block, "sliding_ground": None}, "is made of the same parts as"),
        ],
    )
    def test_wrong_parts_are_refused(self, own, wedged, made_of, words):
        if isinstance(made_of, dict) and made_of.get("sliding_ground", 0) is None:
            made_of = {**made_of, "sliding_ground": own.SlidingGround}
        wedged.made_of = made_of
        with pytest.raises(ComponentError, match=words):
            rf.register(wedged)

    def test_inconsistent_table_sizes_are_reported_together(self, wedged):
        class Odd(wedged):
            """Has the sizes of another system."""

            def contact_model(self):
                model = super().contact_model()
                columns = model.columns[1:]
                return replace(
                    model, scales=np.ones(3), guard_tolerance=np.ones(2), columns=columns
                )

        rf.register(Odd)
        with pytest.raises(AssemblyError) as caught:
            rf.System(BLOCK, Wedge())
        for fault in (
            "scales has 3 numbers, but there must be 4", "guard_tolerance has 2 numbers, but",
            "columns must begin with BODY_COLUMNS", "observe has 16 numbers, but there must be 15",
        ):  # fmt: skip
            assert fault in str(caught.value)

    def test_own_base_can_declare_columns(self):
        @dataclass(frozen=True)
        class Support(ext.PadSupport):
            """Elastic pads."""

        class Counted(ext.OwnBase):
            """Pads that count how often they were left."""

            slot = "pads"

            def support(self, load):
                given = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
                pads = ext.pads_under(given, load)
                return Support(load, pads.stiffness, pads.damping, pads.restitution)

            def answers(self, histories, before, after):
                lifted = after["time"].size
                return {"left_often": float(lifted), "event_lean": before["rotation"]}

        rf.register(
            Counted,
            columns=[
                column(name="left_often", dims=(), unit="1"),
                column(name="event_lean", dims=ext.EVENT, unit="rad"),
            ],
        )
        response = rf.System(BLOCK, Counted()).simulate(PULSE, **RUN)
        assert float(response.left_often) == response.sizes["event"] > 0
        np.testing.assert_allclose(response.event_lean, response.event_rotation, atol=1e-12)


class TestDiagnostics:
    @pytest.fixture(autouse=True)
    def restored(self):
        with restored_registrations():
            yield

    @pytest.mark.parametrize(
        "parts",
        [
            (),
            (rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),),
            (rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2),),
        ],
    )
    def test_diagnostics_work_in_any_scene(self, parts):
        rf.register(
            rf.extension.Diagnostic(
                lambda state: 2.0 * state["rotation"], "twice", "rad", "twice the rotation"
            )
        )
        rf.register(
            rf.extension.Diagnostic(pushed, "pushed", "m/s^2", "absolute acceleration, otherwise")
        )
        response = rf.System(BLOCK, *parts).simulate(
            PULSE, **RUN, outputs=["twice", "pushed", "absolute_horizontal_acceleration"]
        )
        np.testing.assert_array_equal(response.twice, 2.0 * response.rotation)
        assert response.twice.attrs == {"units": "rad", "long_name": "twice the rotation"}
        peak = 2.0 * float(response.peak_rotation)
        assert float(response.peak_twice) == pytest.approx(peak, rel=1e-5)
        absolute = response.absolute_horizontal_acceleration
        np.testing.assert_allclose(response.pushed, absolute, rtol=1e-12)
        assert float(response.peak_pushed) >= float(np.abs(absolute).max())

    def test_diagnostic_cannot_change_histories(self):
        def halved(state):
            state["rotation"] *= 0.5
            return state["rotation"]

        rf.register(halved, unit="rad", long_name="half of the rotation")
        unchanged = rf.System(BLOCK).simulate(PULSE, **RUN)
        with pytest.warns(SolverWarning, match="'halved' could not be computed: .* read-only"):
            response = rf.System(BLOCK).simulate(PULSE, **RUN, outputs=["halved"])
        np.testing.assert_array_equal(response.rotation, unchanged.rotation)

    def test_diagnostic_on_slope_uses_ground_acceleration_of_histories(self):
        rf.register(
            lambda state: state["ground_acceleration"], name="pushed_by", unit="m/s^2",
            long_name="horizontal acceleration of the ground",
        )  # fmt: skip
        response = rf.System(BLOCK, inclination="2 deg").simulate(PULSE, outputs=["pushed_by"])
        np.testing.assert_array_equal(response.pushed_by, response.ground_acceleration)
        assert float(response.peak_pushed_by) == pytest.approx(3.5, rel=1e-4)

    def test_peaks_are_found_between_samples(self):
        rf.register(
            rf.extension.Diagnostic(pushed, "pushed", "m/s^2", "absolute acceleration, otherwise")
        )
        fine, coarse = (
            rf.System(BLOCK).simulate(PULSE, outputs=["pushed"], output_step=step)
            for step in ("1 ms", "0.2 s")
        )
        assert float(coarse.peak_pushed) == float(fine.peak_pushed)
        assert float(fine.peak_pushed) >= float(np.abs(fine.pushed).max())

    def test_unknown_diagnostic_is_refused(self, system):
        with pytest.raises(AssemblyError, match=r"no 'edge_hight'; .*'edge_height'"):
            system.simulate(PULSE, outputs="edge_hight")
        assert "edge_height" not in system.simulate(PULSE)

    @pytest.mark.parametrize(
        ("function", "words"),
        [
            (lambda state: state["cap_rotation"], "KeyError: 'cap_rotation'"),
            (lambda _: 3.0, "the diagnostic 'odd' gave an array of shape (), for"),
        ],
    )
    def test_failing_diagnostic_warns_without_losing_run(self, system, function, words):
        rf.register(function, name="odd", unit="1", long_name="what is not there")
        with pytest.warns(SolverWarning, match="the diagnostic 'odd' could not be computed"):
            response = system.simulate(PULSE, outputs=["odd", "edge_height"])
        assert words in response.attrs["cautions"]
        assert "odd" not in response
        assert "edge_height" in response

    @pytest.mark.parametrize(
        ("declaration", "words"),
        [
            ({"name": "rotation"}, "there is a variable 'rotation' of another meaning"),
            ({"name": "base_shear"}, "there is a variable 'peak_base_shear' of another meaning"),
            ({"name": "energy"}, "there is a variable 'energy' of another meaning"),
            ({"name": "an edge"}, "a diagnostic is called 'an edge'"),
            ({"name": 3}, "the name of a diagnostic must be a word, got 3"),
            ({"unit": "metros"}, "has the unit 'metros', which pint cannot read"),
            ({"unit": None}, "diagnostic 'edge' needs a unit"),
            ({"long_name": ""}, "needs a long_name, or a docstring"),
            ({"columns": [column()]}, "columns are for bases and scenes"),
        ],
    )
    def test_wrong_declarations_are_refused(self, declaration, words):
        right = {"name": "edge", "unit": "m", "long_name": "height of the edge"}
        with pytest.raises(ComponentError, match=words):
            rf.register(pushed, **{**right, **declaration})
        assert "edge" not in SCHEMA

    def test_name_and_unit_are_refused_for_scenes_and_diagnostics(self, own):
        with pytest.raises(ComponentError, match="unit is for functions of the state"):
            rf.register(own.SlidingScene, unit="m")
        with pytest.raises(ComponentError, match="a Diagnostic has its name"):
            rf.register(rf.extension.Diagnostic(pushed, "pushed", "m/s^2", "of it"), name="other")


def pushed(state):
    """Absolute horizontal acceleration."""
    return state["horizontal_acceleration"] + state["ground_acceleration"]
