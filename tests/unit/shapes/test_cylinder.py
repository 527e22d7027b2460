"""Cylinders rocking on their rim: closed forms, numerical integration, invalid arguments."""

import math

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, UnitsError

pytestmark = pytest.mark.unit

SIZE = {"diameter": "1 m", "height": "3 m"}


def test_a_solid_cylinder():
    drum = rf.Block.cylinder(**SIZE, density="2700 kg/m^3")
    mass = 2700.0 * math.pi * 0.25 * 3.0
    assert drum.si.mass == pytest.approx(mass, rel=1e-15)
    assert drum.si.inertia == pytest.approx(mass * (3.0 * 0.25 + 9.0) / 12.0, rel=1e-15)
    assert (drum.si.width, drum.si.height, drum.si.centre_height) == (1.0, 3.0, 1.5)
    assert drum.si.eccentricity == 0.0
    assert rf.Block.cylinder(**SIZE, mass=drum.mass).si == drum.si


def test_cylinder_inertia_agrees_with_sum_over_chords():
    # in side view the depth is the chord 2 sqrt(r^2 - x^2)
    cells = 4000
    x = 0.5 * ((np.arange(cells) + 0.5) / cells * 2.0 - 1.0)
    chord = np.sqrt(0.25 - x * x)
    across = (chord * x * x).sum() / chord.sum()
    up = 9.0 / 12.0
    drum = rf.Block.cylinder(**SIZE, mass="1 t")
    assert drum.si.inertia == pytest.approx(1e3 * (across + up), rel=1e-6)
    # less than that of the rectangle of its side view
    assert drum.shape_factor > 3.0


def test_tube_equals_difference_of_solid_cylinders():
    properties = {"height": "3 m", "density": "2700 kg/m^3"}
    outer, inner = (rf.Block.cylinder(diameter=d, **properties).si for d in ("1 m", "0.8 m"))
    tube = rf.Block.cylinder(diameter="1 m", wall_thickness="10 cm", **properties).si
    assert tube.mass == pytest.approx(outer.mass - inner.mass, rel=1e-14)
    assert tube.inertia == pytest.approx(outer.inertia - inner.inertia, rel=1e-13)
    # a thin wall tends to m r^2/2 + m h^2/12
    thin = rf.Block.cylinder(diameter="1 m", wall_thickness="1 um", height="3 m", mass="1 t").si
    assert thin.inertia == pytest.approx(1e3 * (0.125 + 0.75), rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "give mass or density; neither was given"),
        ({"mass": "1 t", "density": "2 t/m^3"}, "both were given"),
        ({"mass": "1 t", "wall_thickness": "0.5 m"}, "less than half the diameter, 0.5 m"),
        ({"mass": "1 t", "wall_thickness": "0 m"}, "wall_thickness must be greater than zero"),
        ({"mass": "1 t", "diameter": "-1 m"}, "diameter must be greater than zero"),
        ({"mass": "0 t"}, "mass must be greater than zero"),
    ],
)
def test_a_faulty_cylinder_is_refused(changes, words):
    with pytest.raises(ComponentError, match=words):
        rf.Block.cylinder(**{**SIZE, **changes})


@pytest.mark.parametrize("name", ["diameter", "height", "mass", "wall_thickness"])
def test_a_cylinder_needs_units(name):
    with pytest.raises(UnitsError, match=f"Block.cylinder: {name} needs"):
        rf.Block.cylinder(**{**SIZE, "mass": "1 t", name: 0.1})
