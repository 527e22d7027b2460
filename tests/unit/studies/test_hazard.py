"""Annual rates: the closed form of a power law, quadrature of a table, and its tails."""

import itertools
import math
import re
import warnings

import numpy as np
import pytest
import xarray as xr
from scipy import integrate, optimize
from scipy.special import ndtr

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SchemaError, UnitsError
from rockframe.studies import hazard

LEVELS = ([0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0], "g_0")
COUNTS = {"intensity": LEVELS, "exceeded": [0, 0, 0, 4, 6, 13, 12, 16], "trials": 40}
G = 9.80665
VALUES = np.array([0.02, 0.1, 0.3, 0.8, 1.7, 5.0])
RATES = np.array([8e-2, 9e-3, 1.4e-3, 1e-4, 9e-6, 1e-7])
TABLE = {"intensity": (VALUES, "g_0"), "rate": RATES}


@pytest.fixture(scope="module")
def curve():
    return rf.fragility(COUNTS, "PGA")


def probability(curve, x):
    return ndtr(np.log(x / curve.median_intensity.item()) / curve.dispersion.item())


def density(x):
    """Return the slope of the table between its points, from its definition; x in m/s^2."""
    place = np.clip(np.searchsorted(VALUES * G, x, side="right") - 1, 0, len(VALUES) - 2)
    ratio = np.log(RATES[place + 1] / RATES[place]) / np.log(VALUES[place + 1] / VALUES[place])
    return -ratio * RATES[place] * (x / (VALUES[place] * G)) ** ratio / x


@pytest.mark.parametrize("exponent", [1.2, 2.5, 4.0])
def test_a_power_law_gives_the_closed_form_of_cornell(curve, exponent):
    found = rf.annual_rate(
        curve, lambda a: 3e-4 * (a / G) ** -exponent, between=["0.01 g_0", "90 g_0"]
    )
    median, spread = curve.median_intensity.item(), curve.dispersion.item()
    exact = 3e-4 * (median / G) ** -exponent * math.exp(0.5 * (exponent * spread) ** 2)
    total = found.annual_rate + found.unreached_rate_below + found.unreached_rate_above
    assert total.item() == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(("exponent", "spread"), [(8.0, 0.4), (4.0, 2.0), (8.0, 2.0), (30.0, 1.5)])
def test_steep_hazard_and_wide_dispersion_match_quadrature(curve, exponent, spread):
    wide = curve.assign(dispersion=curve.dispersion * 0.0 + spread)
    median, ends = curve.median_intensity.item(), np.log([0.5, 20.0])

    def contribution(log):  # with the rate at an intensity of one
        share = ndtr((log - math.log(median)) / spread)
        return share * exponent * 1e-3 * math.exp(-exponent * log)

    exact = integrate.quad(contribution, *ends, epsabs=0, epsrel=1e-11, limit=200)[0]
    table = {"intensity": (np.exp(ends), "m/s^2"), "rate": 1e-3 * np.exp(-exponent * ends)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # the curve continues below the table
        found = rf.annual_rate(wide, table)
    assert found.annual_rate.item() == pytest.approx(exact, rel=1e-9)
    assert (found.rate_share >= 0.0).all()


@pytest.mark.parametrize("exponent", [0.06, 0.2, 0.7, 3.0])
def test_rates_beyond_a_hazard_curve_are_the_closed_forms(curve, exponent):
    """Also above a curve that is almost flat."""
    median, spread = curve.median_intensity.item(), curve.dispersion.item()
    ends = np.array([6.0, 20.0])
    rates = 1e-3 * (ends / ends[0]) ** -exponent
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        found = rf.annual_rate(curve, {"intensity": (ends, "m/s^2"), "rate": rates})
    eta, shift = np.log(ends / median) / spread, exponent * spread
    within = (ends / median) ** exponent * math.exp(0.5 * shift**2)
    below = within * ndtr(eta + shift) - ndtr(eta)
    above = within * ndtr(-eta - shift) + ndtr(eta)
    assert found.unreached_rate_below.item() == pytest.approx((below * rates)[0], rel=1e-9)
    assert found.unreached_rate_above.item() == pytest.approx((above * rates)[1], rel=1e-9)


def test_median_beyond_the_table_gives_zero_rate(curve):
    far = curve.assign(
        median_intensity=curve.median_intensity * 1e3, dispersion=curve.dispersion * 0.0 + 1e-3
    )
    with pytest.warns(ModelWarning, match="1e\\+02 % of the rate"):
        found = rf.annual_rate(far, TABLE)
    assert found.annual_rate == 0.0
    assert found.verdict == "Annual rate of what was counted: 0 within the hazard curve."


def test_share_outside_trials_matches_numerical_integral():
    """Also for stripes that are groups of intensities, about the middle of each."""
    levels = np.geomspace(0.1, 1.5, 61)
    exceeded = np.random.default_rng(4).random(61) < ndtr(np.log(levels / 0.6) / 0.4)
    curve = rf.fragility({"intensity": (levels, "g_0"), "exceeded": exceeded, "trials": 1}, "PGA")
    assert curve.sizes["stripe"] < len(levels)
    found = rf.annual_rate(curve, TABLE)
    x = np.geomspace(levels[0] * G, levels[-1] * G, 100_001)
    within = integrate.trapezoid(probability(curve, x) * density(x), x)
    outside = 1.0 - within / found.annual_rate.item()
    assert found.outside_trials_share.item() == pytest.approx(outside, abs=1e-3)


def test_hazard_table_integral_matches_quadrature(curve):
    found = rf.annual_rate(curve, TABLE)
    ends = VALUES * G

    def between(a, b):
        return integrate.quad(
            lambda x: probability(curve, x) * density(x), a, b, epsabs=0, epsrel=1e-11
        )[0]

    parts = [between(a, b) for a, b in itertools.pairwise(ends)]
    assert found.annual_rate.item() == pytest.approx(sum(parts), rel=1e-9)
    assert found.rate_share.sum().item() == pytest.approx(1.0)

    def until(x):
        inner = [*ends[ends < x], x]
        return sum(between(a, b) for a, b in itertools.pairwise(inner))

    middle = optimize.brentq(lambda x: until(x) - 0.5 * sum(parts), ends[1], ends[-1])
    assert found.quantile_intensity.sel(quantile=0.5).item() == pytest.approx(middle, rel=2e-3)
    outside = 1.0 - (until(1.0 * G) - until(0.2 * G)) / sum(parts)
    assert found.outside_trials_share.item() == pytest.approx(outside, abs=2e-3)


def in_g(curve):
    """Return a fragility with accelerations in g, and ratios in per cent."""
    others = {"m s^-2": ("g_0", G), "1": ("percent", 0.01)}
    found = curve.copy(deep=True)
    for name, one in curve.variables.items():
        if one.dtype.kind == "f" and one.attrs.get("units") in others:
            unit, size = others[one.attrs["units"]]
            found[name] = (curve[name] / size).assign_attrs(one.attrs, units=unit)
    return found


def test_a_fragility_in_other_units_has_the_same_rate(curve):
    rate = rf.annual_rate(curve, TABLE).annual_rate.item()
    other = in_g(curve)
    name = "peak_ground_acceleration"
    for one in (other, curve.assign_coords({name: other[name]})):  # or only its coordinate
        assert rf.annual_rate(one, TABLE).annual_rate.item() == pytest.approx(rate)
    expected, found = (rf.annual_rate(one, TABLE) for one in (curve, other))
    upper = "annual_rate_upper_bound"  # from the probabilities
    assert found[upper].item() == pytest.approx(expected[upper].item(), rel=1e-9)


def test_exports_do_not_depend_on_units(curve, tmp_path):
    other = in_g(curve)
    exported = rf.export.to_pelicun(other, "x")
    parameters = exported["LS1-Theta_0"].item(), exported["LS1-Theta_1"].item()
    expected = curve.median_intensity.item() / G, curve.dispersion.item()
    assert parameters == pytest.approx(expected, rel=1e-12)
    files = [
        rf.export.to_openquake({"x": one}, tmp_path / f"{k}.xml").read_text()
        for k, one in enumerate((curve, other))
    ]
    assert files[0] == files[1]


def test_rate_bounds_are_rates_of_the_band_curves():
    levels = np.geomspace(0.03, 4.0, 12)
    exceeded = [0, 0, 0, 0, 1, 5, 17, 28, 37, 39, 40, 40]
    counts = {"intensity": (levels, "g_0"), "exceeded": exceeded, "trials": 40}
    curve = rf.fragility(counts, "PGA")
    found = rf.annual_rate(curve, TABLE)
    along = curve.peak_ground_acceleration.values
    for end in ("lower", "upper"):
        band = curve[f"exceedance_probability_{end}_bound"].values
        x = np.geomspace(along[0], along[-1], 200_001)
        within = integrate.trapezoid(np.interp(x, along, band) * density(x), x)
        total = found[f"annual_rate_{end}_bound"].item()
        # little lies beyond the plotted curve
        assert total == pytest.approx(within, rel=0.01)
    assert found.annual_rate_lower_bound < found.annual_rate < found.annual_rate_upper_bound


@pytest.mark.parametrize("known", [(0.5, 60.0), (4.0, 9.0)], ids=["whole", "its middle"])
def test_pointwise_integration_matches_lognormal_closed_form(known):
    x = np.geomspace(*known, 101)
    median, spread = 6.0, 0.45
    values = xr.DataArray(ndtr(np.log(x / median) / spread), dims="x", coords={"x": x})
    finely = hazard._subdivided(hazard.HazardCurve(VALUES * G, RATES))
    by_points = hazard._integrated(values, *finely)
    exact = hazard.lognormal_rates(median, spread, *finely)
    np.testing.assert_allclose(by_points, exact, rtol=1e-7, atol=1e-12 * exact.sum())


def test_rate_of_separated_trials_equals_hazard_at_median():
    counts = {"intensity": ([0.2, 0.4, 0.8, 1.0], "g_0"), "exceeded": [0, 0, 9, 9], "trials": 9}
    parted = rf.fragility(counts, "PGA")
    found = rf.annual_rate(parted, TABLE)
    at = np.exp(np.interp(np.log(parted.median_intensity), np.log(VALUES * G), np.log(RATES)))
    reached = found.annual_rate.item() + RATES[-1]  # the step continues beyond the table
    assert reached == pytest.approx(at.item(), rel=1e-9)


def test_hazard_accepts_probabilities_and_dataarrays(curve):
    one = rf.annual_rate(curve, TABLE).annual_rate.item()
    chance = {"intensity": (VALUES, "g_0"), "probability": 1 - np.exp(-50 * RATES), "years": 50}
    assert rf.annual_rate(curve, chance).annual_rate.item() == pytest.approx(one, rel=1e-12)
    array = xr.DataArray(
        RATES, dims="pga", coords={"pga": ("pga", VALUES * G, {"units": "m s^-2"})}
    )
    assert rf.annual_rate(curve, array).annual_rate.item() == pytest.approx(one, rel=1e-12)


@pytest.mark.parametrize(
    ("unit", "size"), [("year^-1", 1.0), ("1/s", 365.25 * 86400.0), ("percent", 0.01), ("1", 1.0)]
)
def test_the_unit_of_hazard_rates_counts(curve, unit, size):
    rates = RATES / size
    array = xr.DataArray(
        rates, dims="x", coords={"x": ("x", VALUES * G, {"units": "m/s^2"})}, attrs={"units": unit}
    )
    expected = rf.annual_rate(curve, TABLE).annual_rate
    hazards = [array, {**TABLE, "rate": array}]
    hazards += [] if unit == "1" else [{**TABLE, "rate": (rates, unit)}]
    for hazard_curve in hazards:
        found = rf.annual_rate(curve, hazard_curve).annual_rate
        assert found.item() == pytest.approx(expected.item(), rel=1e-12)
    assert expected.attrs["units"] == "1"  # a year differs between libraries of units


def test_probabilities_of_hazard_may_be_percentages(curve):
    chances = 1.0 - np.exp(-50.0 * RATES[1:])
    expected, found = (
        rf.annual_rate(
            curve, {"intensity": (VALUES[1:], "g_0"), "probability": given, "years": 50}
        ).annual_rate
        for given in (chances, [f"{100.0 * chance!r} %" for chance in chances.tolist()])
    )
    assert found.item() == pytest.approx(expected.item(), rel=1e-12)


def test_unit_g_means_gravity_for_accelerations(curve):
    """In other arguments g is the gram."""
    counted = rf.fragility({**COUNTS, "intensity": (LEVELS[0], "g")}, "PGA")
    assert counted.median_intensity.item() == curve.median_intensity.item()
    one = rf.annual_rate(curve, TABLE).annual_rate.item()
    array = xr.DataArray(RATES, dims="pga", coords={"pga": ("pga", VALUES, {"units": "g"})})
    for hazard_curve in (array, *({**TABLE, "intensity": some} for some in (
        (VALUES, "g"), [f"{value} g" for value in VALUES]
    ))):  # fmt: skip
        assert rf.annual_rate(curve, hazard_curve).annual_rate.item() == pytest.approx(
            one, rel=1e-12
        )
    ends = [
        rf.annual_rate(curve, lambda a: a**-2.5, between=some).annual_rate.item()
        for some in (["0.01 g", "90 g"], ["0.01 g_0", "90 g_0"])
    ]
    assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("unit", "size"), [("g", G), ("cm/s^2", 0.01), ("1", 1.0), ("m s^-2", 1.0)]
)
def test_custom_measure_takes_a_hazard_in_its_unit(unit, size):
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {f"m{k}": pulse.scaled(2.0 + 0.7 * k) for k in range(6)}
    runs = rf.sweep(system, motions, free_vibration="3 s", accuracy="fast", progress=False)
    own = xr.DataArray(2.0 + 0.7 * np.arange(6), dims="motion", name="mine") / size
    found = rf.fragility(runs, own.assign_attrs(units=unit))
    expected = rf.annual_rate(rf.fragility(runs, "PGA"), TABLE).annual_rate
    values = VALUES * G / size
    for hazard_curve in (
        {"intensity": (values, unit), "rate": RATES},
        xr.DataArray(RATES, dims="a", coords={"a": ("a", values, {"units": unit})}),
    ):
        rate = rf.annual_rate(found, hazard_curve).annual_rate
        np.testing.assert_allclose(rate, expected, rtol=1e-9)
    other = xr.DataArray(values, attrs={"units": "mm"})
    with pytest.raises(UnitsError, match="has the unit 'mm'"):
        rf.annual_rate(found, {"intensity": (other, unit), "rate": RATES})


def test_each_structure_and_limit_state_has_its_rate():
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = [
        rf.GroundMotion.stochastic(6.5, "10 km", seed=k, stress_drop="20 MPa") for k in range(6)
    ]
    runs = rf.sweep(
        system, motions, scale=[0.4, 0.7, 1, 2, 3, 5, 8], width=["0.4 m", "0.6 m"], accuracy="fast",
        progress=False,
    )  # fmt: skip
    found = rf.fragility(runs, "PGA")
    rates = rf.annual_rate(found, TABLE)
    assert rates.annual_rate.dims == ("width", "limit_state")
    assert rates.rate_share.dims == ("width", "limit_state", "contributing_intensity")
    one = rf.annual_rate(found.isel(width=1), TABLE)
    xr.testing.assert_equal(one.annual_rate, rates.annual_rate.isel(width=1))
    assert (
        rates.annual_rate.sel(limit_state="uplift") > rates.annual_rate.isel(limit_state=1)
    ).all()


def test_rate_beyond_the_hazard_table_warns(curve):
    with pytest.warns(
        ModelWarning, match=r"above 9\.807 m s\^-2, where it ends, 3\d % of the rate"
    ):
        rf.annual_rate(curve, {"intensity": ([0.1, 0.5, 1.0], "g_0"), "rate": [1e-2, 1e-3, 1e-4]})
    with pytest.warns(ModelWarning, match=r"there lie below 7\.845 m s\^-2"):
        rf.annual_rate(curve, {"intensity": ([0.8, 2.0, 9.0], "g_0"), "rate": [1e-3, 4e-5, 1e-8]})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rf.annual_rate(curve, TABLE)


@pytest.mark.parametrize(
    ("hazard_curve", "error", "words"),
    [
        ({"intensity": (VALUES, "m/s"), "rate": RATES}, UnitsError, "is in m s"),
        ({"intensity": (VALUES, "g_0"), "rate": RATES[::-1]}, ComponentError, "above zero fall"),
        ({"intensity": (VALUES, "g_0"), "rate": RATES[:3]}, ComponentError, "a rate each; found 6"),
        ({"intensity": (VALUES, "g_0")}, ComponentError, "a table of hazard has"),
        ({"intensity": (VALUES, "g_0"), "probability": RATES + 1, "years": 50}, ComponentError,
         "above 0 and below 1"),
        *(
            ({"intensity": ([0.1, 0.2], "g_0"), "probability": ends, "years": 50}, ComponentError,
             "above 0 and below 1")
            for ends in ([0.5, 0.0], [1.0, 0.5])
        ),
        ({"intensity": ([0.1], "g_0"), "rate": [1e-3]}, ComponentError, "two intensities or more"),
        *(
            ({"intensity": (values, "g_0"), "rate": rates}, ComponentError, "above zero rise")
            for values, rates in (
                ([0.0, 0.1], [1e-2, 1e-3]), ([0.2, 0.1], [1e-2, 1e-3]), ([0.1, 0.2], [1e-2, 0.0]),
                ([0.1, 0.2], [1e-2, 1e-2]),
            )
        ),
        ({"intensity": ([0.1, 0.2], "g_0"), "rate": [np.inf, 1e-3]}, ComponentError, "be finite"),
        ({**TABLE, "rate": (RATES, "m")}, UnitsError, "rate needs plain numbers or values in year"),
        ({**TABLE, "rate": ["a", "b"]}, UnitsError, "rate needs plain numbers or values in year"),
        ({"intensity": (VALUES, "g_0"), "probability": (RATES, "1/year"), "years": 50}, UnitsError,
         "probability needs plain numbers, got"),
        (np.exp, ComponentError, "needs between"),
        (3.0, ComponentError, "must be a table"),
    ],
)  # fmt: skip
def test_invalid_hazard_is_refused(curve, hazard_curve, error, words):
    with pytest.raises(error, match=words):
        rf.annual_rate(curve, hazard_curve)


@pytest.mark.parametrize("between", [["2 g_0", "1 g_0"], ["0 g_0", "1 g_0"], ["1 g_0"]])
def test_hazard_function_range_must_increase(curve, between):
    with pytest.raises(ComponentError, match="two intensities that rise"):
        rf.annual_rate(curve, lambda a: a**-2.0, between=between)


def test_two_point_hazard_gives_a_return_period(curve):
    table = {"intensity": ([0.02, 5.0], "g_0"), "rate": [8e-2, 1e-9]}
    found = rf.annual_rate(curve, table)
    written = re.search(r"a return period of (\d+) years", found.verdict)  # not 2.332e+06
    assert int(written[1]) == pytest.approx(1.0 / found.annual_rate.item(), rel=5e-4)


def test_dataset_without_a_fragility_is_refused(curve):
    with pytest.raises(SchemaError, match="found no fragility"):
        rf.annual_rate(curve.drop_vars("exceedance_probability"), TABLE)


def test_intensity_errors_name_the_called_function(curve):
    for wrong in ([1 + 2j], ([0.1, 0.2], "bananas"), [[0.1, 0.2]]):
        with pytest.raises((ComponentError, UnitsError), match=r"^annual_rate: "):
            rf.annual_rate(curve, TABLE | {"intensity": wrong})
        with pytest.raises((ComponentError, UnitsError), match=r"^fragility: "):
            rf.fragility(COUNTS | {"intensity": wrong}, "PGA")


def test_verdict_names_the_only_structure_with_a_fragility():
    pulses = {f"{k} Hz": rf.GroundMotion.sine_pulse("4 m/s^2", f"{k} Hz") for k in (0.8, 1.1, 1.4)}
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    runs = rf.sweep(
        system, pulses, scale=np.linspace(0.5, 3, 6), width=["0.5 m", "1.9 m"], free_vibration="4 s"
    )
    curves = rf.fragility(runs, "PGA", limits=[])
    table = {"intensity": (VALUES * 100, "m/s^2"), "rate": RATES}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        both = rf.annual_rate(curves, table)
        one = rf.annual_rate(curves.isel(width=[0]), table)
    assert np.isnan(both.annual_rate.values.ravel()).tolist() == [False, True]
    alone = "overturning, of the one of 2 structures that has a fragility"
    assert both.attrs["verdict"] == one.attrs["verdict"].replace("overturning", alone)


def test_rate_of_another_state_is_said_where_there_is_none_of_overturning():
    pulses = [rf.GroundMotion.sine_pulse(f"{a} m/s^2", f"{f} Hz") for a in (2, 3) for f in (1, 2)]
    block = rf.System(rf.Block(width="2 m", height="6 m", mass="20 t"))
    runs = rf.sweep(block, pulses, scale=[1.0, 2.0], free_vibration="2 s", progress=False)
    found = rf.fragility(runs, "PGA", limits=["uplift", 0.9])
    assert found.fragility_status[0] != found.fragility_status[-1]  # the block never overturns
    with warnings.catch_warnings(action="ignore", category=ModelWarning):
        rates = rf.annual_rate(found, TABLE)
    assert rates.annual_rate.notnull().values.tolist() == [True, False, False]
    assert rates.verdict.startswith("There is no fragility against overturning, and so no rate. ")
    uplift = rates.annual_rate[0].item()
    assert f"Annual rate of uplift: {uplift:.3g}, a return period" in rates.verdict
    none = rf.annual_rate(found.isel(limit_state=[1, 2]), TABLE).verdict
    assert none == "There is no fragility against overturning, and so no rate."
