"""A user-defined base, from the example's file, behaves like a base of the package."""

import importlib
import json
import math
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from plain_python import plain_python
from scipy.optimize import minimize
from user_examples import FILE, example, restored_registrations

import rockframe as rf
from rockframe import extension as ext
from rockframe.compiled import COMPILED, store
from rockframe.components import component_from_dict
from rockframe.errors import AssemblyError, ComponentError, SchemaError
from rockframe.results.schema import SCHEMA
from rockframe.solve.driver import advance
from rockframe.system import parts as parts_of

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
CAP = rf.CushionCap(height="0.5 m", mass="4 t")
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)
GIVEN = {"frequency_ratio": 15, "damping_ratio": 0.05, "strength": 0.6, "hardening": 0.1}
PULSE = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
SCENES = {
    "alone": ((), {}),
    "coupled": ((CAP, SOIL), {"coupling": "coupled"}),
    "cascade": ((CAP, SOIL), {"coupling": "cascade"}),
}
SETS = ("left_set", "right_set")
every_scene = pytest.mark.parametrize("scene", SCENES)
LONG_CASES = {("coupled", "hardening"), ("cascade", "strength")}
"""Scenes and changes that make pads elastic, in plain Python; only in the long tests."""
runs_in_every_scene = pytest.mark.parametrize(  # coupled and cascade scenes in plain Python
    "scene",
    ["alone", *(pytest.param(one, marks=pytest.mark.wide) for one in SCENES if one != "alone")],
)


@pytest.fixture(scope="module", autouse=True)
def yielding():
    """Return the module of the example, its base registered."""
    with example() as module:
        yield module


@pytest.fixture
def pads(yielding):
    return yielding.YieldingPads(**GIVEN)


@pytest.fixture
def system(pads):
    return rf.System(BLOCK, pads)


@pytest.fixture
def response(system):
    return system.simulate(PULSE, duration="2.5 s", outputs="energy")


def in_scene(pads, scene, **options):
    parts, coupling = SCENES[scene]
    return rf.System(BLOCK, pads, *parts, **coupling, **options)


def noise(sign=1.0):
    """Return a motion with content at all frequencies, or its mirror image."""
    rng = np.random.default_rng(12)
    across, upwards = (np.convolve(rng.normal(size=100), np.ones(5) / 5, "same") for _ in "xy")
    return rf.GroundMotion.from_arrays(
        (sign * 6.0 * across, "m/s^2"), "0.02 s", vertical=(3.0 * upwards, "m/s^2")
    )


class TestWords:
    def test_description_lists_model_and_its_numbers(self, system):
        text = system.describe()
        assert text.startswith("Model: yielding pads\n")
        assert repr(system.parts.pads) in text
        strength = 0.6 * 1e4 * 9.80665
        assert f"strength of one pad                {strength:.6g} N" in text
        assert "the set z grows by (1 - r) u'" in text

    @every_scene
    def test_description_of_stack_lists_its_numbers(self, pads, scene):
        assert "strength of one pad" in in_scene(pads, scene).describe()

    def test_the_file_is_short(self):
        lines = FILE.read_text(encoding="utf-8").splitlines()
        assert sum(bool(line.strip()) for line in lines) < 200


class TestComponent:
    def test_equality_and_hash(self, yielding, pads):
        same = yielding.YieldingPads(**GIVEN)
        assert pads == same
        assert hash(pads) == hash(same)
        for name, value in GIVEN.items():
            assert pads != pads.replace(**{name: 1.01 * value})
        assert rf.System(BLOCK, pads) == rf.System(same, BLOCK)

    def test_replace(self, pads):
        stronger = pads.replace(strength=0.9)
        assert stronger.si.strength == 0.9
        assert stronger.si.hardening == pads.si.hardening
        assert pads.si.strength == GIVEN["strength"]

    def test_base_survives_dict_round_trip(self, pads):
        description = json.loads(json.dumps(pads.to_dict()))
        assert description == {"type": "YieldingPads", **GIVEN}
        assert component_from_dict(description) == pads
        assert type(pads).from_dict(description) == pads

    @every_scene
    def test_system_survives_dict_round_trip(self, pads, scene):
        system = in_scene(pads, scene)
        assert rf.System.from_dict(json.loads(json.dumps(system.to_dict()))) == system

    @pytest.mark.parametrize("strength", [0.5, 0.2])
    @every_scene
    def test_pads_too_weak_for_the_weight_are_refused(self, pads, scene, strength):
        weak = pads.replace(strength=strength)
        with pytest.raises(AssemblyError, match=rf"strength above 0\.5, not {strength:g}"):
            in_scene(weak, scene)

    @pytest.mark.parametrize("changed", [{"strength": 0.0}, {"hardening": 0.0}, {"hardening": 1.1}])
    def test_values_out_of_range_are_refused(self, pads, changed):
        with pytest.raises(ComponentError, match=next(iter(changed))):
            pads.replace(**changed)


class TestDataset:
    def test_own_histories_are_labelled(self, response):
        for side in ("left", "right"):
            history = response[f"{side}_set"]
            assert history.dims == ("time",)
            assert history.dtype == "float64"
            assert history.attrs == {"units": "m", "long_name": f"plastic set of the {side} pad"}
            assert history.values[0] == 0.0
            assert history.values[-1] > 0.0
            assert (np.diff(history.values) >= 0.0).all()
        assert response.attrs["model"] == "yielding pads"

    def test_netcdf_and_back(self, response, system, tmp_path):
        file = tmp_path / "response.nc"
        response.to_netcdf(file)
        with xr.open_dataset(file) as read:
            for name in (*SETS, "rotation", "left_reaction"):
                np.testing.assert_array_equal(read[name], response[name])
                assert read[name].attrs == response[name].attrs
            again = rf.System.from_dataset(read)
        assert again.parts.pads == system.parts.pads
        assert again.parts.block == BLOCK
        assert again.motion == PULSE
        repeated = again.simulate(duration="2.5 s", outputs="energy")
        for name in response.variables:
            np.testing.assert_array_equal(repeated[name], response[name], err_msg=name)

    def test_continued_run_starts_from_plastic_sets(self, system, response):
        first = system.simulate(PULSE, duration="1.5 s")
        continued = system.simulate(initial=first, duration="1 s")
        for name in SETS:
            assert continued[name].values[0] == first[name].values[-1] > 0.0
            assert continued[name].values[-1] == pytest.approx(response[name].values[-1], rel=1e-9)


class TestLadder:
    def test_model_ladder_lists_two_pads_before_yielding_pads(self, system):
        assert list(rf.model_ladder(system)) == [
            "rigid ground, small rotations",
            "rigid ground",
            "two pads, small rotations",
            "two pads",
            "YieldingPads, small rotations",
            "YieldingPads",
        ]

    def test_model_ladder_of_stack_lists_elastic_pads_first(self, pads):
        names = list(rf.model_ladder(in_scene(pads, "coupled")))
        for kind in ("by cascade", "coupled"):
            elastic, own = (
                next(i for i, name in enumerate(names) if name.startswith(who) and kind in name)
                for who in ("pads, cap", "YieldingPads, cap")
            )
            assert elastic < own
        assert names[-1] == "YieldingPads, cap and soil coupled"

    @pytest.mark.long
    def test_tradeoff_reports_effect_of_yielding(self, system):
        study = rf.tradeoff(
            system, PULSE, models=["two pads", "YieldingPads"], accuracies="standard", repeats=1,
            duration="2 s",
        )  # fmt: skip
        assert study.model.values.tolist() == ["two pads", "YieldingPads"]
        errors = study.peak_error.values[:, 0]
        assert errors[0] > 0.01
        assert errors[1] < 1e-6


class TestMechanics:
    @pytest.fixture(autouse=True)
    def stacks_in_plain_python(self, request):
        """Run stacks in plain Python; the law of a single block is compiled."""
        callspec = getattr(request.node, "callspec", None)
        scene = "alone" if callspec is None else callspec.params.get("scene", "alone")
        with nullcontext() if scene == "alone" else plain_python():
            yield

    @runs_in_every_scene
    def test_energy_balances_while_pads_yield(self, pads, scene):
        pads = pads.replace(strength=0.52)
        response = in_scene(pads, scene).simulate(
            noise(), duration="1.2 s", accuracy="reference", outputs="energy"
        )
        for name in SETS:
            assert response[name].values[-1] > 1e-3
        assert float(response.energy_residual) <= 1e-8

    @pytest.mark.parametrize("rotation", [-0.24, -0.1, 0.003, 0.02, 0.05, 0.2])
    def test_statics_of_stack_include_yielding(self, pads, rotation):
        """Bilinear pads at rest have the least energy stored."""
        system = rf.System(BLOCK, pads, CAP, SOIL, coupling="coupled")
        g, weight = 9.80665, 9.80665e4
        stiffness = 0.5e4 * (15 * math.sqrt(3 * g / (4 * math.hypot(0.5, 2.0)))) ** 2
        strength, hardening = 0.6 * weight, 0.1
        settlement, soil_settlement = 0.5 * weight / stiffness, 1.4 * weight / 20e6

        def pressed(height):
            down, at_yield = max(0.0, -height), strength / stiffness
            beyond = max(0.0, down - at_yield)
            return 0.5 * stiffness * (down**2 - (1.0 - hardening) * beyond**2)

        def soil_energy(left, right):  # energy of a bed, by the heights of its ends
            places = (np.arange(4000) + 0.5) / 4000
            down = np.maximum(0.0, -(left + (right - left) * places))
            return 0.5 * 20e6 * np.mean(down**2)

        def energy(held, cap, sunk, press):
            turned = held - cap
            normal = 2.0 * math.cos(turned) - press + settlement
            ends = [-press + side * 0.5 * math.sin(turned) for side in (1.0, -1.0)]
            down = sunk - soil_settlement
            # both pads bear, so that the middle of the base is held
            across = 2.0 * math.sin(turned)
            rise = (0.5 + normal) * math.cos(cap) - across * math.sin(cap) - down
            cap_energy = 4e3 * g * (0.25 * math.cos(cap) - down)
            bed = soil_energy(0.5 * math.sin(cap) - sunk, -0.5 * math.sin(cap) - sunk)
            return weight * rise + cap_energy + bed + sum(pressed(one) for one in ends)

        def minimum(held):
            sizes = np.array([1e-3, 1e-3, 1e-2])
            found = np.array([held / 50.0 / 1e-3, 1.0, 1.0])
            for method in ("Nelder-Mead", "BFGS", "Nelder-Mead"):
                close = {"xatol": 1e-9, "fatol": 1e-9, "maxiter": 4000}
                found = minimize(
                    lambda x: energy(held, *(x * sizes)), found, method=method,
                    options={"gtol": 1e-6} if method == "BFGS" else close,
                ).x  # fmt: skip
            return energy(held, *(found * sizes))

        moment = (minimum(rotation + 1e-4) - minimum(rotation - 1e-4)) / 2e-4
        held = system.moment_rotation(f"{rotation} rad").restoring_moment.item()
        assert held == pytest.approx(moment, rel=1e-4)

    @runs_in_every_scene
    def test_a_mirrored_motion_gives_mirrored_histories(self, pads, scene):
        """Bit for bit on pads; moments of soil are rounded differently on either side."""
        system = in_scene(pads, scene)
        rounding = 0.0 if scene == "alone" else 1e-12
        one, other = (system.simulate(noise(sign), duration="1 s") for sign in (1.0, -1.0))
        exchanged = {
            f"{side}_{quantity}": f"{opposite}_{quantity}"
            for quantity in ("set", "reaction")
            for side, opposite in (("left", "right"), ("right", "left"))
        }
        turned = ("rotation", "horizontal_displacement", "base_shear")
        for name, opposite, sign in [
            *((name, opposite, 1.0) for name, opposite in exchanged.items()),
            *((name, name, -1.0) for name in turned),
        ]:
            mine, theirs = one[name].values, sign * other[opposite].values
            largest = rounding * np.abs(mine).max()
            np.testing.assert_allclose(mine, theirs, rtol=0.0, atol=largest, err_msg=name)
        assert one.left_set.values[-1] > 0.0
        assert one.left_set.values[-1] != one.right_set.values[-1]

    @pytest.mark.parametrize(
        ("scene", "changed"),
        [
            pytest.param(
                scene, changed, marks=[pytest.mark.long] * ((scene, *changed) in LONG_CASES)
            )
            for scene in SCENES
            for changed in ({"strength": 1e6}, {"hardening": 1.0})
        ],
    )
    def test_pads_that_cannot_yield_are_elastic(self, pads, scene, changed):
        pads = pads.replace(**changed)
        motion = noise()
        ours = in_scene(pads, scene).simulate(motion, duration="1.2 s")
        elastic = in_scene(*pads.simpler(), scene).simulate(motion, duration="1.2 s")
        difference = np.abs(ours.rotation - elastic.rotation).max()
        assert difference <= 1e-12 * float(elastic.overturning_angle)
        assert int(ours.impact_count) == int(elastic.impact_count)
        assert elastic.sizes["event"] > 2
        for name in SETS:
            assert (ours[name] == 0.0).all()

    def test_energy_balances_with_landings_on_custom_ground(self, pads):
        """Stage 1 lands on pads under the cap, with the energies of a larger mass."""
        with restored_registrations(), plain_python():
            rf.register(Stilts)
            system = rf.System(
                BLOCK, *pads.simpler(), CAP, Stilts(frequency_ratio=10), coupling="cascade"
            )
            response = system.simulate(
                rf.GroundMotion.sine_pulse(amplitude="-2 m/s^2", frequency="1 Hz"),
                duration="2 s",
                accuracy="reference",
            )
        assert (response.soil_contact_state != 0).any()
        assert float(response.energy_residual) <= 1e-8

    def test_a_start_beyond_the_strength_is_refused(self, system):
        for start in {"rotation": "0.03 rad"}, {"vertical_displacement": "-50 mm"}:
            with pytest.raises(AssemblyError, match="starts in equilibrium, before any yields"):
                system.simulate(initial=rf.InitialState(**start), duration="1 s")

    def test_yielding_force_follows_hardening_line(self, system):
        """While a pad yields, its spring's force is strength + r k z/(1 - r)."""
        quiet = system.parts.pads.replace(damping_ratio=0.0)
        response = rf.System(BLOCK, quiet).simulate(
            PULSE, duration="1 s", output_step="1 ms", accuracy="reference"
        )
        weight = 1e4 * 9.80665
        stiffness = 0.5 * weight / float(rf.System(BLOCK, quiet).equilibrium().pad_settlement)
        for side in ("left", "right"):
            plastic = response[f"{side}_set"].values
            line = 0.6 * weight + 0.1 * stiffness * plastic / 0.9
            force = response[f"{side}_reaction"].values
            assert (force <= line + 1e-8 * weight).all()
            grows = np.flatnonzero((np.diff(plastic[:-1]) > 0.0) & (np.diff(plastic[1:]) > 0.0))
            assert grows.size > 10
            np.testing.assert_allclose(force[grows + 1], line[grows + 1], rtol=1e-8)


@pytest.mark.skipif(not COMPILED, reason="this run does without compilation")
@pytest.mark.parametrize("scene", ["alone", pytest.param("coupled", marks=pytest.mark.long)])
def test_compiled_and_uncompiled_runs_agree(pads, scene):
    """Complete runs of a single block; of coupled scenes, all equations along a run."""
    system = in_scene(pads, scene)
    with nullcontext() if scene == "alone" else plain_python(advance):
        compiled = system.simulate(PULSE, duration="0.8 s")
    with plain_python():
        plain = system.simulate(PULSE, duration="0.8 s")
    assert max(float(compiled[name][-1]) for name in SETS) > 0.0
    for name in ("rotation", *SETS, "peak_rotation", "left_reaction"):
        np.testing.assert_allclose(compiled[name], plain[name], rtol=1e-12, atol=1e-12)


def test_code_cache_is_separate_for_each_module_name(tmp_path, monkeypatch):
    """As for a script that is run and then imported: numba finds the module by its name."""
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    monkeypatch.syspath_prepend(tmp_path)
    text = (
        "from typing import NamedTuple\n\n"
        "from rockframe.compiled import kernel\n\n\n"
        "class Law(NamedTuple):\n"
        "    slope: float\n\n"
        "    @kernel\n"
        "    def twice(self) -> float:\n"
        "        return 2.0 * self.slope\n"
    )
    files = []
    for name in ("law_as_one", "law_as_another"):
        (tmp_path / f"{name}.py").write_text(text)
        law = importlib.import_module(name).Law
        files.append(store.module_file(restored_registrations, "as is", [law]))
    assert files[0] != files[1]


class Bare(ext.OwnBase):
    """A base without a support."""

    slot = "pads"


class Roof(ext.OwnBase):
    """A base for a place that does not exist."""

    slot = "roof"

    def support(self, load):
        return ext.pads_under(rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1), load)


class Copied(ext.OwnBase):
    """Elastic pads, defined as users define them."""

    slot = "pads"
    frequency_ratio = ext.Ratio(ext.POSITIVE, doc="Vertical over rocking frequency.")

    def support(self, load):
        ratio = self.si.frequency_ratio
        return ext.pads_under(rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.1), load)


class Stilts(ext.OwnBase):
    """Pads in the place of soil."""

    slot = "soil"
    frequency_ratio = ext.Ratio(ext.POSITIVE, doc="Vertical over rocking frequency.")

    def support(self, load):
        ratio = self.si.frequency_ratio
        pads = ext.pads_under(rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.1), load)
        return StiltSupport(load, pads.stiffness, pads.damping, pads.restitution)


class StiltSupport(ext.PadSupport):
    """Pads whose reactions have other names than under the block."""

    def law(self, body, mass, load_mass):
        names = "soil_reaction", "contact_length"  # borrowed names
        columns = tuple(ext.Column(name, per_mass=True) for name in names)
        return replace(super().law(body, mass, load_mass), columns=columns)


class Doubled(rf.TwoSpringSupport):
    """Pads with an unregistered support."""

    def support(self, load):
        return ext.pads_under(self.replace(frequency_ratio=40), load)


@ext.point_law
class TiedPad(NamedTuple):
    """An elastic pad that includes the tie of its pair."""

    stiffness: float
    damping: float
    tie: float  # per unit mass, for the difference in height of both ends

    def spring(self, point, own):
        return self.stiffness * point.pressed

    def energy(self, point, own):
        return 0.5 * self.stiffness * point.pressed**2

    def force(self, state, point, own):
        return self.spring(point, own) + self.damping * point.speed

    def force_rate(self, state, point, own):
        return self.stiffness * point.speed + self.damping * point.acceleration

    def return_rate(self):
        return self.stiffness / self.damping


pad_force = ext.Pads.force


class TiedPair(ext.Pads):
    """Pads and a rotational spring, in contact or not."""

    __slots__ = ()

    @ext.inlined
    def force(self, contact, line, own):
        found = pad_force(self, contact, line, own)
        moment = found.moment - self.law.tie * (line.left - line.right)
        return ext.BaseForce(found.upward, moment, found.dissipated)


@dataclass(frozen=True)
class TiedSupport(ext.PadSupport):
    """Pads and a tie, whose support defines only its law."""

    tie: float

    def law(self, body, mass, load_mass):
        pads = super().law(body, mass, load_mass)
        tied = TiedPad(self.stiffness / mass, self.damping / mass, self.tie / mass)
        found = ext.pads_over(tied, pads)
        return replace(found, law=TiedPair(*found.law))


class TiedPads(ext.OwnBase):
    """Pads and a tie."""

    slot = "pads"
    tie = ext.Ratio(ext.NOT_NEGATIVE, doc="Over the weight.")

    def support(self, load):
        pads = ext.pads_under(rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1), load)
        numbers = pads.stiffness, pads.damping, pads.restitution
        return TiedSupport(load, *numbers, self.si.tie * load.weight)


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

    def test_registered_base_works_in_scenes(self):
        rf.register(Copied, columns=[column()])
        assert SCHEMA["wear"] == column()
        own = rf.System(BLOCK, Copied(frequency_ratio=20))
        elastic = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
        one, other = (each.simulate(PULSE, duration="1 s") for each in (own, elastic))
        np.testing.assert_array_equal(one.rotation, other.rotation)
        rf.register(Copied, columns=[column()])  # again, as when a notebook's cell is repeated

    def test_unregistered_base_is_refused(self):
        words = (
            r"(?s)Copied\(frequency_ratio=20\.0\) is not a par.*call .*register\(Copied\) beside"
        )
        with pytest.raises(AssemblyError, match=words):
            rf.System(BLOCK, Copied(frequency_ratio=20))

    @pytest.mark.parametrize("kind", [rf.TwoSpringSupport, rf.Block, int, 3, "pads", None])
    def test_registering_other_types_is_refused(self, kind):
        with pytest.raises(ComponentError, match=r"OwnBase or OwnScene, .* got"):
            rf.register(kind)

    def test_an_instance_is_refused(self):
        with pytest.raises(ComponentError, match=r"OwnBase or .*, got Copied"):
            rf.register(Copied(frequency_ratio=20))

    def test_a_wrong_slot_is_refused(self):
        with pytest.raises(
            ComponentError, match=r"Roof\.slot must be 'pads' or 'soil', got 'roof'"
        ):
            rf.register(Roof)

    def test_a_missing_support_is_refused(self):
        with pytest.raises(ComponentError, match=r"Bare has no method support\(load\)"):
            rf.register(Bare)

    @pytest.mark.parametrize(
        ("wrong", "words"),
        [
            ("wear", "columns must be Variables, got 'wear'"),
            (column(name="the wear"), "a column is called 'the wear'"),
            (column(dims=("event",)), r"Copied has no method answers\(.*, which gives 'wear'"),
            (column(dims=()), r"Copied has no method answers\(.*, which gives 'wear'"),
            (column(dims=("layer",)), r"'wear' over \('layer',\): nothing labels 'layer'"),
            (column(name="rotation"), "there is a variable 'rotation' of another meaning"),
            (column(name="left_set"), "there is a variable 'left_set' of another meaning"),
            (column(unit="metros"), "'wear' has the unit 'metros', which pint cannot read"),
        ],
    )
    def test_wrong_columns_are_refused(self, wrong, words):
        with pytest.raises(ComponentError, match=words):
            rf.register(Copied, columns=[wrong])

    def test_columns_of_one_name_are_refused(self):
        with pytest.raises(ComponentError, match="two columns are called 'wear'"):
            rf.register(Copied, columns=[column(), column(long_name="other wear")])

    def test_all_faults_are_reported_and_nothing_is_registered(self):
        class Nowhere(ext.OwnBase):
            """Neither a slot nor a support."""

        rows, kinds = dict(SCHEMA), dict(parts_of._KINDS)
        with pytest.raises(ComponentError) as caught:
            rf.register(
                Nowhere,
                columns=[column(), column(name="2nd", dims=("mode",), unit="metros"), None],
            )
        message = str(caught.value)
        assert message.startswith("register: ")
        for fault in ("Nowhere.slot", "no method support", "'2nd'", "('mode',)", "metros", "None"):
            assert fault in message
        assert rows == SCHEMA
        assert kinds == parts_of._KINDS

    def test_unregistered_support_is_refused(self):
        words = r"(?s)Doubled carries a body in its own way, but is.*derive it from .*OwnBase, and"
        with pytest.raises(AssemblyError, match=words):
            rf.System(BLOCK, Doubled(frequency_ratio=20, damping_ratio=0.1))

    def test_a_subclass_with_another_support_needs_its_own_registration(self, yielding):
        class SofterPads(yielding.YieldingPads):
            """Pads with another stiffness."""

            def support(self, load):
                return yielding.YieldingPads(**{**GIVEN, "frequency_ratio": 10}).support(load)

        with pytest.raises(AssemblyError, match=r"call rockframe\.register\(SofterPads\) beside"):
            rf.System(BLOCK, SofterPads(**GIVEN))
        rf.register(SofterPads)
        assert rf.System(BLOCK, SofterPads(**GIVEN)).setting.settlement == pytest.approx(
            rf.System(BLOCK, yielding.YieldingPads(**GIVEN)).setting.settlement * 2.25
        )

    def test_unregistered_history_raises(self, pads):
        for name in SETS:
            del SCHEMA[name]
        with pytest.raises(SchemaError, match="'left_set' is not in the schema of results"):
            rf.System(BLOCK, pads).simulate(PULSE, duration="0.1 s")

    def test_bases_with_same_outputs_in_one_stack_are_refused(self, pads):
        class Twins(Stilts):
            """Pads under the cap with the outputs of those under the block."""

            def support(self, load):
                return ext.pads_under(*pads.simpler(), load)

        rf.register(Twins)
        parts = BLOCK, *pads.simpler(), CAP, Twins(frequency_ratio=10)
        with pytest.raises(AssemblyError, match="both show left_reaction and right_reaction"):
            rf.System(*parts)

    def test_soil_without_reaction_output_runs_without_friction_demand(self, pads):
        names = "near_reaction", "far_reaction"

        class UnseenSupport(StiltSupport):
            """Pads with outputs under user-defined names."""

            def law(self, body, mass, load_mass):
                columns = tuple(ext.Column(name, per_mass=True) for name in names)
                return replace(super().law(body, mass, load_mass), columns=columns)

        class Unseen(Stilts):
            """Pads in the place of soil, without an output of their sum."""

            friction = ext.Ratio(ext.POSITIVE, doc="Of the cap.", default=None)

            def support(self, load):
                support = super().support(load)
                return UnseenSupport(load, support.stiffness, support.damping, support.restitution)

        rf.register(Unseen, columns=[column(name=name, unit=ext.Unit.NEWTON) for name in names])
        soil = Unseen(frequency_ratio=10, friction=0.01)
        system = rf.System(BLOCK, *pads.simpler(), CAP, soil, coupling="cascade")
        with plain_python():
            response = system.simulate(PULSE, duration="0.2 s", outputs="friction_demand")
        assert set(names) < set(response.variables)
        assert response.attrs["cautions"] == "none"
        with pytest.raises(AssemblyError, match="no 'soil_friction_demand' in this scene"):
            system.simulate(PULSE, duration="0.2 s", outputs="soil_friction_demand")

    @pytest.mark.parametrize("rotation", [-0.1, 0.001, 0.05])
    def test_statics_include_moment_added_by_base(self, rotation):
        rf.register(TiedPads)
        pads, tied = (
            rf.System(BLOCK, base).moment_rotation(f"{rotation} rad").restoring_moment.item()
            for base in (
                rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
                TiedPads(tie=0.1),
            )
        )
        lift = 0.1 * 1e4 * 9.80665 * 2 * 0.5 * math.sin(rotation)
        assert tied - pads == pytest.approx(lift, rel=1e-9)

    def test_stiffer_tie_raises_moment_frequency_and_energy(self):
        rf.register(TiedPads)
        for parts in ((), (CAP, SOIL)):
            systems = [rf.System(BLOCK, TiedPads(tie=tie), *parts) for tie in (0, 0.1, 1)]
            for answer in (
                [system.moment_rotation("0.1 rad").restoring_moment.item() for system in systems],
                [system.frequencies().angular_frequency.values[0] for system in systems],
                [system.setting.overturning_energy for system in systems],
            ):
                assert answer == sorted(set(answer))


def built_with(yielding, monkeypatch, **methods):
    """Build the pads of the example with other methods of their law."""
    for name, method in methods.items():
        monkeypatch.setattr(yielding.YieldingPad, name, method)
    return rf.System(BLOCK, yielding.YieldingPads(**GIVEN))


NOTHING = {name: lambda *_: 0.0 for name in ("force_rate", "power")}


@pytest.mark.parametrize(
    ("methods", "words"),
    [
        ({"energy": lambda self, point, own: math.nan}, "energy must be a finite number, got nan"),
        ({"force_rate": lambda *_: None}, "force_rate must be a finite number, got None"),
        (
            {
                "force": lambda self, state, point, own: (
                    point.pressed if point.rise == 0 else math.nan
                )
            },
            "YieldingPad.force at 0.99 of the settlement must be a finite number, got nan",
        ),
        ({"spring": lambda self, point: 1.0}, "takes 2 positional arguments but 3 were given"),
        (
            {"rates": lambda *_: (0.0, 0.0), **NOTHING},
            r"rates must be a tuple of 1 numbers, got \(0.0, 0.0\)",
        ),
        ({"return_rate": lambda self: -1.0}, "return_rate must be a finite number from 0 up"),
        ({"states": lambda self: 0}, "states must be a whole number from 1 up, got 0"),
        ({"guard": lambda *_: 1.0}, "guard must be a tuple of 2 numbers, got 1.0"),
        ({"seen": lambda *_: ()}, r"seen for 2 columns must be a tuple of 1 numbers, got \(\)"),
        (
            {"variables": lambda self: 2, "rates": lambda *_: (0.0, 0.0), **NOTHING},
            "variable_scales of YieldingPad must be a tuple of 2 numbers",
        ),
    ],
)
def test_law_is_tried_when_its_scene_is_built(yielding, monkeypatch, methods, words):
    with pytest.raises(AssemblyError, match=words):
        built_with(yielding, monkeypatch, **methods)


@pytest.mark.parametrize(
    "spring",
    [
        lambda *_: 0.0,
        lambda *_: -1.0,
        # half the weight at most, which overflows where its denominator does not
        lambda self, point, own: 1e9 * point.pressed / (1.0 + 1e9 / 2.4 * point.pressed),
        lambda self, point, own: 1e3 * (point.pressed + 1.0),  # more than the weight at once
    ],
)
def test_base_without_force_is_refused(yielding, monkeypatch, spring):
    words = "YieldingPad: no compression of the base carries the weight"
    with pytest.raises(AssemblyError, match=words):
        built_with(yielding, monkeypatch, spring=spring).describe()


def test_base_that_needs_no_compression_is_refused(yielding, monkeypatch):
    raised = {"sunk": lambda *_: -1.0, "spring": lambda self, point, own: point.pressed + 1e3}
    with pytest.raises(AssemblyError, match=r"YieldingPad: .* carries the weight .* without"):
        built_with(yielding, monkeypatch, **raised).describe()


@pytest.mark.parametrize("sunk", [0.03, 1.0])
def test_unloaded_level_below_the_settlement_is_refused(yielding, monkeypatch, sunk):
    words = r"YieldingPad\.sunk must be less than the settlement at rest, 0.012\d* m.* got"
    with pytest.raises(AssemblyError, match=words):
        built_with(yielding, monkeypatch, sunk=lambda *_: sunk)


def test_support_must_return_a_support():
    class Empty(ext.OwnBase):
        slot = "pads"

        def support(self, load):
            return None

    with restored_registrations():
        rf.register(Empty)
        with pytest.raises(AssemblyError, match=r"Empty\.support must return a Support, got None"):
            rf.System(BLOCK, Empty())


@ext.point_law
class CubicPad(NamedTuple):
    """A pad with the force k u + h u^3 + c u', per unit mass."""

    stiffness: float
    cubic: float
    damping: float

    def spring(self, point, own):
        return (self.stiffness + self.cubic * point.pressed**2) * point.pressed

    def energy(self, point, own):
        square = point.pressed**2
        return (0.5 * self.stiffness + 0.25 * self.cubic * square) * square

    def force(self, state, point, own):
        return self.spring(point, own) + self.damping * point.speed

    def force_rate(self, state, point, own):
        tangent = self.stiffness + 3.0 * self.cubic * point.pressed**2
        return tangent * point.speed + self.damping * point.acceleration

    def power(self, state, point, own):
        return self.damping * point.speed**2

    def return_rate(self):
        return self.stiffness / self.damping


@dataclass(frozen=True)
class CubicSupport(ext.PadSupport):
    """Pads that harden before they carry the weight."""

    hardening: float  # h delta^2/k, with the settlement delta of elastic pads

    def law(self, body, mass, load_mass):
        elastic = super().law(body, mass, load_mass)
        stiffness, damping = self.stiffness / mass, self.damping / mass
        cubic = self.hardening * stiffness / elastic.settlement**2
        return ext.pads_over(CubicPad(stiffness, cubic, damping), elastic)


class CubicPads(ext.OwnBase):
    """Pads that harden before they carry the weight."""

    slot = "pads"
    hardening: ext.Ratio = ext.Ratio(ext.NOT_NEGATIVE, doc="Of the weight.")

    def support(self, load):
        pads = ext.pads_under(rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1), load)
        return CubicSupport(load, pads.stiffness, pads.damping, pads.restitution, self.si.hardening)


@pytest.fixture
def cubic():
    """Make systems on cubic pads of any hardening."""
    rf.register(CubicPads)
    return lambda hardening: rf.System(BLOCK, CubicPads(hardening=hardening))


def test_settlement_is_that_of_the_law(cubic):
    elastic = float(cubic(0.0).equilibrium().pad_settlement)
    (share,) = (root.real for root in np.roots([2.0, 0.0, 1.0, -1.0]) if not root.imag)
    system = cubic(2.0)
    rest = system.equilibrium()
    assert float(rest.pad_settlement) == pytest.approx(share * elastic, rel=1e-12)
    assert f"settlement delta                   {share * elastic:.6g} m" in system.describe()
    held = system.moment_rotation(([0.0], "rad"))
    assert held.held_vertical_displacement.item() == pytest.approx(0.0, abs=1e-12 * elastic)
    run = system.simulate(PULSE, duration="2.5 s", accuracy="reference", outputs=("energy",))
    assert run.vertical_displacement[0] == 0.0
    assert float(run.energy_residual) < 1e-9


def test_pads_without_hardening_are_elastic_to_the_last_bit(cubic):
    pads = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1)
    runs = [
        system.simulate(PULSE, duration="2.5 s") for system in (cubic(0.0), rf.System(BLOCK, pads))
    ]
    np.testing.assert_array_equal(runs[0].rotation, runs[1].rotation)


def test_dashpot_without_a_return_rate_is_refused(cubic, monkeypatch):
    monkeypatch.setattr(CubicPad, "return_rate", lambda self: 0.0)
    words = (
        r"CubicPad\.return_rate must be positive: a point that rises fast enough loses its force"
    )
    with pytest.raises(AssemblyError, match=words):
        cubic(0.5)
