"""Soil that yields, from the example's file: its moment in closed form, and its energies."""

import importlib.util
import re
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe import extension as ext
from rockframe.results.schema import SCHEMA
from rockframe.system import parts as parts_of

FILE = Path(__file__).parents[2] / "examples" / "own_yielding_bed.py"
WALL = rf.Block(width="2 m", height="6 m", mass="30 t")
WEIGHT, HALF_WIDTH = 30e3 * 9.80665, 1.0
SETTLEMENT = 0.005


@pytest.fixture(scope="module")
def bed():
    rows, kinds = dict(SCHEMA), dict(parts_of._KINDS)
    spec = importlib.util.spec_from_file_location(FILE.stem, FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[FILE.stem] = module
    spec.loader.exec_module(module)
    yield module
    for table, was in ((SCHEMA, rows), (parts_of._KINDS, kinds)):
        table.clear()
        table.update(was)


def soil(bed, load, damping_ratio=0.05):
    return bed.YieldingSoil(settlement=SETTLEMENT, load=load, damping_ratio=damping_ratio)


def noise():
    rng = np.random.default_rng(12)
    across, upwards = (np.convolve(rng.normal(size=100), np.ones(5) / 5, "same") for _ in "xy")
    return rf.GroundMotion.from_arrays(
        (6.0 * across, "m/s^2"), "0.02 s", vertical=(3.0 * upwards, "m/s^2")
    )


def test_example_imports_nothing_private():
    text = FILE.read_text(encoding="utf-8")
    found = re.findall(r"^(?:from|import) (rockframe\S*.*)$", text, re.MULTILINE)
    assert found == ["rockframe as rf", "rockframe import extension as ext"]


@pytest.mark.parametrize("load", [0.2, 0.3, 0.5, 0.7])
def test_static_moment_converges_to_closed_form(bed, monkeypatch, load):
    """Springs at midpoints of parts of the base: the error falls with the square of their size."""
    apart = []
    for count in (20, 80):
        monkeypatch.setattr(bed, "SPRINGS", count)
        support = rf.System(WALL, soil(bed, load), rotation="small").setting.support
        errors = []
        for phi in (0.1, 0.25, 0.45, 0.8, 1.0, 1.4, 3.0):
            held = support.held_at(phi * SETTLEMENT / load)
            found = held.base_moment * load / (WEIGHT * HALF_WIDTH)
            errors.append(abs(found - bed.moment(load, phi)))
        apart.append(max(errors))
    assert apart[0] < 6e-4
    assert apart[1] < apart[0] / 8.0


@pytest.mark.parametrize("damping_ratio", [pytest.param(0.0, marks=pytest.mark.long), 0.05])
@plain_python()
def test_energies_balance_while_springs_yield_lift_and_land(bed, monkeypatch, damping_ratio):
    monkeypatch.setattr(bed, "SPRINGS", 6)
    response = rf.System(WALL, soil(bed, 0.6, damping_ratio)).simulate(
        noise(), duration="0.9 s", accuracy="reference", outputs="energy"
    )
    for side in ("left", "right"):
        permanent = response[f"{side}_soil_set"].values
        assert permanent[-1] > 0.0
        assert (np.diff(permanent) >= 0.0).all()
    assert {0, 1, 2} & set(response.contact_state.values.tolist()) != {0}
    assert float(response.energy_residual) <= 1e-8


def test_springs_that_cannot_yield_match_elastic_bed(bed, monkeypatch):
    """For many springs at small settlement the limit is the bed in closed form."""
    monkeypatch.setattr(bed, "SPRINGS", 64)
    with plain_python():
        many = rf.System(WALL, soil(bed, 1e-6, 0.0)).simulate(noise(), duration="0.4 s")
        stiffness = WEIGHT / (2.0 * HALF_WIDTH**2 * SETTLEMENT)
        winkler = rf.WinklerSoil(stiffness=f"{stiffness} Pa", damping_ratio=0.0)
        closed = rf.System(WALL, winkler).simulate(noise(), duration="0.4 s")
    apart = np.abs(many.rotation - closed.rotation).max()
    assert float(apart) < 2e-3 * float(np.abs(closed.rotation).max())


def test_invalid_spring_law_raises():
    with pytest.raises(TypeError, match=r"Bad has no method energy; .* a field 'power', which is"):

        @ext.point_law
        class Bad(NamedTuple):
            power: float

            def spring(self, point, own):
                return point.pressed

            def force_rate(self, state, point, own):
                return point.speed
