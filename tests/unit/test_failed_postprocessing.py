"""Failed postprocessing does not lose an integrated run."""

import math
from functools import cached_property

import pytest

import rockframe as rf
from rockframe.errors import ModelWarning, SolverWarning
from rockframe.simulation import run as running
from rockframe.simulation.plan import Plan
from rockframe.system.assembly import Assembly
from rockframe.system.setting import Setting

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1.5 Hz")
PLAN = {"free_vibration": "1 s", "output_step": "0.1 s"}
STEPS = {
    "compute_outputs": "peaks of forces",
    "may_overturn_later": "energy to overturn",
    "energy_caution": "another run agrees",
    "_separation_cautions": "leave the ground",
    "sliding_cautions": "friction that is needed",
    "friction_words": "friction that is needed",
    "motion_attributes": "origin",
    "certify": "certificate",
    "second_look": "second run with more steps",
    "to_json": "arguments as text",
    "json": "parts as text",
    "description": "words of the model",
    "cautions": "unusual about the scene",
    "uplift_angle": "uplift angle",
}
OF_CLASSES = {
    "to_json": Plan, "json": Assembly, "description": Assembly, "cautions": Assembly,
    "uplift_angle": Setting,
}  # fmt: skip


def broken(*_, **__):
    msg = "left out on purpose"
    raise ZeroDivisionError(msg)


def broken_property(name):
    found = cached_property(broken)
    found.__set_name__(None, name)
    return found


@pytest.fixture(params=list(STEPS))
def failing(request, monkeypatch):
    name = request.param
    if name in OF_CLASSES:
        failure = broken if name == "to_json" else broken_property(name)
        monkeypatch.setattr(OF_CLASSES[name], name, failure)
    else:
        monkeypatch.setattr(running, name, broken)
    return name


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_failed_postprocessing_step_warns_and_run_survives(failing):
    options = {"accuracy": "fast" if failing == "second_look" else "standard"}
    options |= {"certify": failing == "certify", **PLAN}
    found = rf.System(BLOCK).simulate(PULSE, **options)
    message = f"{STEPS[failing]}.* could not be computed: ZeroDivisionError: left out on purpose"
    with pytest.warns(SolverWarning, match=message):
        again = rf.System(BLOCK).simulate(PULSE, **options)
    assert "ZeroDivisionError: left out on purpose" in found.attrs["cautions"]
    assert again.attrs["verdict"].startswith("Did not overturn")
    assert float(again.peak_rotation) > 0.0
    assert ("rotation" in again) == (failing != "compute_outputs")
    assert math.isnan(float(again.uplift_angle)) == (failing == "uplift_angle")


def test_unknown_output_column_loses_only_histories(monkeypatch):
    answers = running.compute_outputs

    def with_extra_column(*arguments):
        found = answers(*arguments)
        found.values["unheard_of"] = found.values["rotation"]
        return found

    monkeypatch.setattr(running, "compute_outputs", with_extra_column)
    with pytest.warns(SolverWarning, match="'unheard_of' is not in the schema"):
        found = rf.System(BLOCK).simulate(PULSE, **PLAN)
    assert float(found.peak_rotation) > 0.0


@pytest.mark.parametrize("accuracy", ["standard", "fast"])
def test_failed_postprocessing_preserves_sweep_results(monkeypatch, accuracy):
    monkeypatch.setattr(running, "may_overturn_later", broken)
    with pytest.warns(ModelWarning, match="left out on purpose"):
        found = rf.sweep(
            rf.System(BLOCK), PULSE, scale=[0.9, 1.0], accuracy=accuracy, progress=False, **PLAN
        )
    assert (found.peak_rotation > 0.0).all()


def test_interrupt_in_postprocessing_propagates(monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(running, "may_overturn_later", interrupted)
    with pytest.raises(KeyboardInterrupt):
        rf.System(BLOCK).simulate(PULSE, **PLAN)
