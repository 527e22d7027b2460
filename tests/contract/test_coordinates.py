"""Datasets of analyses: coordinates have no fill value, and the references are of the method."""

import netCDF4
import pytest

import rockframe as rf

pytestmark = pytest.mark.contract

CABINET = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
SUITE = {
    f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa").window(
        "5 s", "25 s"
    )
    for k in range(6)
}
WIDTHS = ["0.5 m", "0.6 m"]
TARGET = rf.TargetSpectrum.eurocode_8("0.2 g_0")


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(CABINET, SUITE, scale=[0.5, 1, 2, 4], width=WIDTHS, accuracy="fast")


def dynamic_analysis(_):
    two = {name: SUITE[name] for name in ("seed 0", "seed 1")}
    return rf.incremental_dynamic_analysis(
        CABINET, two, scale=[1, 2, 4], width=WIDTHS, accuracy="fast"
    )


def overturning_map(_):
    return rf.overturning_map(
        CABINET, rf.GroundMotion.sine_pulse, amplitude=([3, 6], "m/s^2"), frequency=([1, 2], "Hz"),
        free_vibration="2 s", accuracy="fast",
    )  # fmt: skip


def annual_rate(runs):
    hazard = {
        "intensity": ([0.1, 1.0, 10.0, 1000.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-4, 1e-10],
    }  # fmt: skip
    return rf.annual_rate(rf.fragility(runs, "PGA", limits=[0.3]), hazard)


@pytest.mark.parametrize(
    "analysis",
    [
        lambda runs: rf.fragility(runs, "PGA", limits=[0.3]),
        lambda runs: rf.fragility(runs, ("PGA", "PGV/PGA"), limits=[], pooled=["width"]),
        lambda runs: rf.fractile_curves(runs.isel(width=0), "PGA", levels=[0.3]),
        lambda runs: rf.cloud_analysis(runs.isel(width=0, scale=[1]), "PGA"),
        dynamic_analysis,
        overturning_map,
        annual_rate,
    ],
    ids=["fragility", "two measures", "fractiles", "cloud", "dynamic", "map", "rate"],
)
def test_coordinates_have_no_fill_value(analysis, runs, tmp_path):
    found = analysis(runs)
    found.to_netcdf(tmp_path / "found.nc")
    with netCDF4.Dataset(tmp_path / "found.nc") as file:
        for name in found.coords:
            assert "_FillValue" not in file[name].ncattrs(), name


@pytest.mark.parametrize(
    ("analysis", "authors"),
    [
        (lambda runs: rf.fragility(runs, "PGA", limits=[0.3]), "Baker"),
        (lambda runs: rf.fragility(runs, "PGA", limits=[0.3], dispersion="common"), "McCullagh"),
        (lambda runs: rf.fractile_curves(runs.isel(width=0), "PGA"), "Vamvatsikos"),
        (lambda runs: rf.cloud_analysis(runs.isel(width=0, scale=[1]), "PGA"), "Jalayer"),
        (lambda runs: rf.compare_intensities(runs, ["PGA"], pooled=["width"]), "Luco"),
        (lambda runs: rf.ensemble_statistics(runs.isel(width=0, scale=0)), "Clopper"),
        (annual_rate, "Cornell"),
        (lambda _: rf.MotionSuite(SUITE).scaling_to(TARGET), "Nigam"),
        (lambda _: rf.MotionSuite(SUITE).selection_for(TARGET, 2, bounds=None), "Baker and Lee"),
    ],
)
def test_references_are_of_the_method(analysis, authors, runs):
    references = analysis(runs).attrs["references"]
    assert authors in references
    assert "Winkler" not in references  # of the equations of a run
