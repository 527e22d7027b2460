"""Blocks with an eccentric centre of mass: mirror images, energy, limits."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from property import test_soil, test_symmetry
from property.checks import check_energy_at_events
from property.scenarios import CASE as PADS_CASE
from property.scenarios import RULES, SOIL_SCENES, SoilScenario
from property.test_energy import energy_scale

import rockframe as rf
from rockframe.results.schema import GROUPS

pytestmark = [pytest.mark.wide, pytest.mark.property]

ALONE = ("rigid", "pads")
SCENES = (*ALONE, *SOIL_SCENES)
ON_REQUEST = (*GROUPS, "friction_demand", "horizontal_velocity")


@dataclass(frozen=True)
class Eccentric(SoilScenario):
    """A scene with an eccentric block; `sign` mirrors the block, too."""

    eccentricity: float = 0.3  # over half the width
    level: float = 0.45  # of the centre of mass, over the height
    starts_upright: bool = False  # the block starts upright, though it leans at rest

    @property
    def block(self):
        size = super().block.si
        offset = self.sign * self.eccentricity * size.half_width
        return rf.Block(
            width=f"{size.width!r} m",
            height=f"{size.height!r} m",
            mass=f"{self.mass!r} kg",
            centre_of_mass=(f"{self.level * size.height!r} m", f"{offset!r} m"),
        )

    @property
    def system(self):
        if self.scene in SOIL_SCENES:
            return super().system
        pads = rf.TwoSpringSupport(frequency_ratio=self.beta, damping_ratio=self.xi)
        parts = (pads,) if self.scene == "pads" else ()
        return rf.System(self.block, *parts, restraint=self.base, rotation=self.rotation)

    @property
    def initial(self):
        given = super().initial
        return given if self.starts_upright or self.start else given.replace(rotation=None)

    @property
    def points(self):
        size = self.block.si
        offset = self.sign * 0.5 * size.half_width
        return {"shelf": (f"{offset!r} m", f"{0.7 * size.height!r} m")}


CASE = Eccentric(**vars(PADS_CASE), firmness=30.0, cap_width=1.3)


def every(**changes):
    """Return a scene of each kind, of finite and of small rotation."""
    for scene in SCENES:
        for rotation in ("finite", "small"):
            yield replace(CASE, scene=scene, rotation=rotation, **changes)


def begun_and_shaken():
    """Return scenes with all kinds of start, under all rules."""
    yield from every()
    yield from every(starts_upright=True, peak=0.35, eccentricity=-0.15)
    yield from every(start=0.4, rate=-0.3, peak=0.3)
    for rule in RULES:
        for scene in SCENES[1:]:
            yield replace(CASE, scene=scene, base=rule, peak=0.8, separation="pressure")


def test_mirrored_scene_gives_mirrored_response():
    """Up to rounding, as the bed's contact is measured from the left, up to the third event."""
    events, leans = 0, []
    for scenario in begun_and_shaken():
        one, other = (
            each.run(output_step="5 ms", outputs=("energy", *ON_REQUEST), points=each.points)
            for each in (scenario, scenario.mirrored)
        )
        assert {"left_overturning_angle", "right_peak_rotation"} <= set(one.variables)
        events += one.sizes["event"]
        leans.append(abs(one.rotation.values[0]))
        if scenario.scene in ALONE:
            test_symmetry.assert_mirrored(one, other)
        elif one.sizes["event"] < 4:
            test_soil.assert_mirrored(one, other)
        else:
            horizon = min(one.event_time.values[3], other.event_time.values[3])
            count = int(np.searchsorted(one.time.values, horizon)) - 1
            test_soil.assert_mirrored(one, other, max(count, 1))
    assert events > 100
    assert max(leans) > 1e-3


def test_mirrored_scene_has_mirrored_statics():
    for scenario in every():
        one, other = (each.system.equilibrium() for each in (scenario, scenario.mirrored))
        assert set(one.variables) == set(other.variables)
        for name in one.variables:
            mine = one[test_symmetry.TRADES_PLACES.get(name, name)].values
            mine = -mine if name in test_symmetry.TURNS_ROUND else mine
            np.testing.assert_allclose(other[name].values, mine, rtol=1e-13, err_msg=name)
        angles = np.linspace(-0.2, 0.2, 9)
        state, image = (
            each.system.moment_rotation((angles * each.sign, "rad"))
            for each in (scenario, scenario.mirrored)
        )
        scale = scenario.mass * 9.80665 * scenario.radius
        np.testing.assert_allclose(
            image.restoring_moment / scale, -state.restoring_moment / scale, atol=1e-12
        )


def test_energies_balance():
    for scenario in begun_and_shaken():
        assert scenario.run(outputs=None).energy_residual.item() <= 1e-5
        reference = scenario.run(outputs="energy", output_step="5 ms", accuracy="reference")
        assert reference.energy_residual.item() <= 1e-8
        balance = test_soil.balance_of(reference)
        assert np.abs(balance - balance[0]).max() <= 1e-7 * energy_scale(reference)


def test_energy_never_rises_at_an_event():
    for scenario in every():
        if scenario.scene != "cascade":  # where each stage has its own ground
            check_energy_at_events(scenario, "reference", stop_at_overturning=False)


def test_an_eccentricity_of_zero_changes_no_bit():
    for scenario in every(eccentricity=0.0, level=0.5, start=0.2, rate=-0.1):
        given = scenario.system
        block = scenario.block
        usual = block.replace(centre_height=None, eccentricity=None)
        assert block.si == usual.si
        assert block != usual
        parts = [usual if part == block else part for part in given.parts]
        options = {"restraint": scenario.base, "rotation": scenario.rotation}
        if scenario.scene in ("coupled", "cascade"):
            options["coupling"] = scenario.scene
        one, other = (
            system.simulate(
                scenario.motion,
                free_vibration="2 s",
                initial=scenario.initial,
                output_step="5 ms",
                outputs=("energy", *ON_REQUEST),
                points=scenario.points,
            )
            for system in (given, rf.System(*parts, **options))
        )
        assert set(one.variables) == set(other.variables)
        assert one.attrs["verdict"] == other.attrs["verdict"]
        assert one.sizes["event"] > 0
        for name in other.variables:
            np.testing.assert_array_equal(one[name].values, other[name].values, err_msg=name)
