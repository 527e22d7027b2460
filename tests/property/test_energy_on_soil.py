"""Energies balance in every scene on soil, under every rule, free and forced, with uplift."""

from itertools import product

import numpy as np
import pytest

import rockframe as rf

RULES = ("contact-state", "leading-corner", "centre")
BOUNDS = {"reference": 1e-8, "standard": 1e-5}


def noise(peak, seed):
    rng = np.random.default_rng(seed)
    smooth = np.convolve(rng.normal(size=500), np.ones(12) / 12.0, "same")
    return peak * smooth / np.abs(smooth).max()


def scene(name, rule, separation):
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1)
    cap = rf.CushionCap(width="2.8 m", height="0.5 m", mass="12 t")
    soil = rf.WinklerSoil(stiffness="4 MPa", damping_ratio=0.15, separation=separation)
    parts, coupling = {
        "soil": ((soil,), "coupled"),
        "cap and soil": ((cap, soil), "coupled"),
        "coupled": ((pads, cap, soil), "coupled"),
        "cascade": ((pads, cap, soil), "cascade"),
    }[name]
    return rf.System(block, *parts, restraint=rule, coupling=coupling)


SCENES = list(
    product(("soil", "cap and soil", "coupled", "cascade"), RULES, ("displacement", "pressure"))
)


@pytest.mark.parametrize(
    ("name", "rule", "separation", "accuracy"),
    [
        # every scene at one of the accuracies, and at the other in the long run
        pytest.param(*one, accuracy, marks=[pytest.mark.long] * ((number + place) % 2))
        for number, one in enumerate(SCENES)
        for place, accuracy in enumerate(BOUNDS)
    ],
)
def test_energies_balance(name, rule, separation, accuracy):
    system = scene(name, rule, separation)
    shaken = rf.GroundMotion.from_arrays(
        (noise(4.0, 3), "m/s^2"), "0.01 s", vertical=(noise(9.0, 4), "m/s^2")
    )
    released = {"duration": "6 s", "initial": rf.InitialState(rotation="0.12 rad")}
    runs = {
        "free": system.simulate(accuracy=accuracy, outputs=("energy",), **released),
        "forced": system.simulate(
            shaken, accuracy=accuracy, outputs=("energy",), overturning="continue"
        ),
    }
    for run in runs.values():
        assert run.energy_residual.item() <= BOUNDS[accuracy]
        stored = run.kinetic_energy + run.potential_energy + run.elastic_energy
        gone = run.dissipated_energy + run.impact_energy + run.repinning_energy
        balance = (stored + gone - run.input_energy).values
        terms = (run.kinetic_energy, run.elastic_energy, gone, abs(run.input_energy))
        largest = max(float(term.max()) for term in terms)
        assert np.abs(balance - balance[0]).max() <= 100.0 * BOUNDS[accuracy] * largest
        for name_of_loss in ("dissipated_energy", "impact_energy", "repinning_energy"):
            assert np.diff(run[name_of_loss].values).min() >= -1e-9 * largest
    if name != "cascade" or accuracy == "reference":
        lifted = runs["forced"].get("soil_contact_state", runs["forced"].contact_state)
        assert int((lifted != 0).sum()) > 0
