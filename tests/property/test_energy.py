"""Energy balances over random scenes, and bounds of energy at events.

Ranges: see `property.scenarios`.
"""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.tied_runs import draw_scene as draw_tied
from hypothesis import example, given, settings
from property.checks import check_energy_at_events
from property.scenarios import GRAVITY, RULES, Scenario, scenarios

import rockframe as rf
from rockframe.errors import ModelWarning
from rockframe.solve.accuracy import accuracy_of

pytestmark = [pytest.mark.wide, pytest.mark.property]

FINISHED = {0, 1, 2}
HARD = {
    "radius": 5.0,
    "slenderness": 4.0,
    "frequency": 1.0,
    "cycles": 1.0,
    "peak": 1.0,
}

INTERPOLATED = Scenario(
    base="centre",
    radius=0.725,
    slenderness=1.0,
    beta=59.29,
    xi=0.421,
    rotation="finite",
    peak=1.496,
    frequency=0.568,
    cycles=0.5,
    vertical=0.0,
    rate=0.27,
)
"""Its dissipated energy, interpolated at `standard`, falls by 1.0003e-9 of the largest energy."""


def energy_scale(response):
    names = ("kinetic_energy", "input_energy", "dissipated_energy")
    return max(float(np.abs(response[name].values).max()) for name in names)


@given(scenarios())
@example(Scenario(base="contact-state", beta=60.0, xi=0.0, rotation="finite", vertical=0.5, **HARD))
@example(Scenario(base="centre", beta=8.0, xi=0.5, rotation="finite", vertical=-0.5, **HARD))
@example(Scenario(base="leading-corner", beta=20.0, xi=0.0, rotation="small", vertical=0.0, **HARD))
@example(
    # shaken by exactly g tan(theta): the block lifts by no more than rounding
    Scenario(
        base="rigid",
        radius=0.5,
        slenderness=1.0,
        beta=8.0,
        xi=0.0,
        rotation="finite",
        peak=1.0,
        frequency=0.5,
        cycles=0.5,
        vertical=0.0,
    )
)
@example(
    # upright at every event and at the end: the largest energies occur in between
    Scenario(
        base="leading-corner",
        radius=1.051,
        slenderness=1.051,
        beta=36.979,
        xi=0.0,
        rotation="finite",
        peak=0.5,
        frequency=0.5,
        cycles=0.5,
        vertical=0.0,
    )
)
@settings(max_examples=150, deadline=None)
def test_energy_balances(scenario):
    standard = scenario.run(outputs=None)
    assert standard.status.item() in FINISHED
    assert standard.energy_residual.item() <= 1e-5
    reference = scenario.run(outputs=None, accuracy="reference")
    assert reference.status.item() in FINISHED
    assert reference.energy_residual.item() <= 1e-8


@pytest.mark.parametrize(
    "scene",
    [
        {"base": "contact-state", "radius": 0.5, "slenderness": 1.0, "beta": 29.815, "cycles": 2.5},
        {"base": "leading-corner", "radius": 1.051, "slenderness": 1.051, "beta": 36.979},
        {"base": "rigid", "radius": 5.0, "slenderness": 4.0, "beta": 20.0, "start": 0.5},
    ],
)
def test_energy_residual_is_relative_to_largest_term_of_run(scene):
    """The scale is not only that of events and of the end, where little energy may be stored."""
    excitation = {"peak": 0.2, "frequency": 0.5, "cycles": 0.5, "vertical": 0.0}
    scenario = Scenario(**{"xi": 0.0, "rotation": "finite", **excitation, **scene})
    response = scenario.run(outputs="energy", output_step="1 ms")
    stored = sum(response[f"{kind}_energy"].values for kind in ("kinetic", "potential", "elastic"))
    stored -= stored[0]
    gone = sum(response[f"{kind}_energy"].values for kind in ("dissipated", "impact", "repinning"))
    supplied = response.input_energy.values
    imbalance = np.abs(stored + gone - supplied).max()
    largest = max(np.abs(stored).max(), np.abs(supplied).max(), np.abs(gone).max())
    assert imbalance / largest > 1e-10
    # samples between the steps can only increase the imbalance
    assert response.energy_residual.item() <= 2.0 * imbalance / largest


@given(scenarios())
@example(Scenario(base="rigid", beta=60.0, xi=0.0, rotation="finite", vertical=0.5, **HARD))
@example(Scenario(base="contact-state", beta=20.0, xi=0.1, rotation="finite", vertical=0.0, **HARD))
@settings(max_examples=60, deadline=None)
def test_energy_balances_in_the_histories(scenario):
    """At every sample stored, dissipated and lost energy equal the input."""
    response = scenario.run(outputs="energy", output_step="5 ms", accuracy="reference")
    stored = sum(response[f"{kind}_energy"].values for kind in ("kinetic", "potential", "elastic"))
    gone = sum(response[f"{kind}_energy"].values for kind in ("dissipated", "impact", "repinning"))
    balance = stored + gone - response.input_energy.values
    drift = np.abs(balance - balance[0]).max()
    # energies far below that of the block's rocking are rounding, as in the residual
    noise = 1e-12 * scenario.mass * GRAVITY * scenario.radius * response.overturning_angle.item()
    assert drift <= 1e-6 * max(energy_scale(response), noise)


@given(scenarios())
@example(INTERPOLATED)
@settings(max_examples=60, deadline=None)
def test_losses_only_grow(scenario):
    run = {"outputs": "energy", "output_step": "5 ms", "overturning": "continue"}
    for accuracy in ("reference", "standard"):
        response = scenario.run(accuracy=accuracy, **run)
        # samples within a step are interpolated, no better than the step is accurate
        within_step = accuracy_of(accuracy).rtol * energy_scale(response)
        for name in ("dissipated_energy", "impact_energy", "repinning_energy"):
            steps = np.diff(response[name].values)
            assert (steps >= -within_step).all(), (accuracy, name)
    slack = 1e-9 * energy_scale(response)
    assert (response.kinetic_energy.values >= 0.0).all()
    assert (response.elastic_energy.values >= 0.0).all()
    # after a flight an end may slide, which also dissipates
    if scenario.base == "rigid" or (scenario.xi == 0.0 and response.flight_count.item() == 0):
        np.testing.assert_allclose(response.dissipated_energy.values, 0.0, atol=slack)
    if scenario.base in ("rigid", "centre") or scenario.rotation == "small":
        pinned = response.flight_count.item() == 0
        # a slip that has reached zero is stopped: its energy is a rounding error squared
        lost = response.repinning_energy.values
        assert not pinned or (lost <= 1e-24 * energy_scale(response)).all()


@given(scenarios())
@settings(max_examples=60, deadline=None)
def test_energy_never_rises_at_an_event(scenario):
    # a corner that ends sliding is set on its level, to within the accuracy of the run
    check_energy_at_events(scenario, "reference", stop_at_overturning=False)


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("start", [0.2, 0.6, -0.9])
def test_lossless_leading_corner_conserves_energy(start, rotation):
    """Undamped, with eps = 1, rocking freely through many contact changes."""

    block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0, restitution=1)
    with pytest.warns(ModelWarning, match="eps_max"):
        system = rf.System(block, pads, restraint="leading-corner", rotation=rotation)
    scenario = Scenario(
        base="leading-corner", beta=20.0, xi=0.0, rotation=rotation, vertical=0.0, **HARD
    )
    response = system.simulate(
        duration="20 s",
        initial=replace(scenario, start=start).initial,
        accuracy="reference",
        outputs="energy",
    )
    assert not response.overturned.item()
    assert response.impact_count.item() > 3
    stored = sum(response[f"{kind}_energy"].values for kind in ("kinetic", "potential", "elastic"))
    at_rest = 0.5 * block.mass.m_as("kg") * 9.80665 * 9.80665 / (20.0**2 * 0.75 * 9.80665 / 5.0)
    free = stored[0] - at_rest
    assert free > 0.0
    np.testing.assert_allclose(stored - at_rest, free, rtol=1e-7)
    assert (response.impact_energy.values <= 1e-9 * free).all()
    assert (np.abs(response.repinning_energy.values) <= 1e-9 * free).all()


@pytest.mark.parametrize("rule", RULES)
def test_a_block_left_alone_comes_to_rest(rule):
    scenario = Scenario(
        base=rule, beta=20.0, xi=0.2, rotation="finite", vertical=0.0, free=60.0,
        **{**HARD, "peak": 0.4},
    )  # fmt: skip
    response = scenario.run(outputs="energy")
    assert response.peak_relative_rotation.item() > 0.05
    kinetic = response.kinetic_energy.values
    assert kinetic[-1] < 1e-9 * kinetic.max()
    assert abs(response.rotation.values[-1]) < 1e-6
    assert response.contact_state.values[-1] == 0


@pytest.mark.parametrize("base", RULES)
def test_energy_residual_does_not_depend_on_motion_strength(base):
    """In full contact a tenth of the motion makes a hundredth of the energies, and of the errors.

    The springs' energy at rest does not scale; relative to it the residual would vanish.
    """
    excitation = {"frequency": 1.5, "cycles": 2.0, "vertical": 0.4, "xi": 0.1, "rotation": "small"}
    size = {"radius": 5.0, "slenderness": 4.0, "beta": 20.0}
    residuals = [
        Scenario(base=base, peak=peak, **excitation, **size)
        .run(accuracy="fast")
        .energy_residual.item()
        for peak in (3e-3, 3e-4, 3e-5)
    ]
    assert residuals[0] > 1e-7
    assert residuals == pytest.approx([residuals[0]] * 3, rel=0.05)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("number", [47, 295])
def test_each_loss_never_decreases_on_mixed_bases(number):
    """On pads after flight, next to rigid bases, the hold is part of the impact."""
    system, motion, _ = draw_tied(number)
    response = system.simulate(motion, outputs="energy", output_step="1 ms", second_look=False)
    for name in ("impact_energy", "repinning_energy"):
        steps = np.diff(response[name].values)
        assert steps.min() > -1e-12 * energy_scale(response), name
