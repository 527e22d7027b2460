"""A run certified by a proof: its dataset, its command and its report."""

import re
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("flint")

import rockframe as rf
from rockframe.errors import ComponentError, SolverWarning
from rockframe.simulation import proving

PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SHAPE = np.sin(np.pi * np.linspace(0.0, 1.0, 101))


@pytest.fixture(scope="module")
def system():
    return rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))


def pulse(peak):
    return rf.GroundMotion.from_arrays((np.round(peak * SHAPE, 9), "m/s^2"), "0.01 s")


@pytest.mark.parametrize(("peak", "falls"), [(3.0, False), (3.6, True)])
def test_proof_agrees_with_the_verdict(system, peak, falls):
    run = system.simulate(pulse(peak), free_vibration="10 s", certify="proved", outputs=None)
    assert bool(run.verdict_proved)
    assert bool(run.overturned) is falls
    assert run.attrs["proof_verdict"] == ("overturns" if falls else "safe for ever")
    assert run.attrs["proof"].startswith("Proved: the block")
    assert "says nothing of how well" in run.attrs["proof"]
    assert np.isfinite(run.proved_overturning_earliest) == falls
    if falls:
        assert run.proved_overturning_earliest <= run.overturning_time + 1e-6
        assert run.proved_overturning_latest >= run.overturning_time - 1e-6
    assert run.proof_width < 1e-15
    assert "verdict_margin" not in run


def test_run_ending_before_proved_overturning_warns(system):
    with pytest.warns(SolverWarning, match="after the end of the run"):
        run = system.simulate(pulse(3.6), certify="proved", outputs=None)
    assert bool(run.verdict_proved)
    assert not bool(run.overturned)


def test_contradiction_of_run_and_proof_warns(system, monkeypatch):
    original = proving.prove_run

    def wrong(*arguments, **options):
        return replace(original(*arguments, **options), verdict="safe for ever")

    monkeypatch.setattr("rockframe.simulation.run.prove_run", wrong)
    with pytest.warns(SolverWarning, match="the run is wrong, or the proof is"):
        run = system.simulate(pulse(3.6), free_vibration="10 s", certify="proved", outputs=None)
    assert not bool(run.verdict_proved)
    assert "the run is wrong" in run.attrs["cautions"]


@pytest.mark.parametrize(
    ("base", "peak", "away"),
    [
        (rf.RigidGround(), 3.6, 0.3),
        (PADS, 4.5, -0.3),
        pytest.param(rf.RigidGround(), 3.6, -0.3, marks=pytest.mark.long),
        pytest.param(PADS, 4.5, 0.3, marks=pytest.mark.long),
    ],
)
def test_different_overturning_time_warns(base, peak, away, monkeypatch):
    """The verdict is proved, but the run takes another course."""
    original = proving.prove_run

    def later(*arguments, **options):
        proof = original(*arguments, **options)
        return replace(proof, earliest=proof.earliest + away, latest=proof.latest + away)

    standing = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"), base)
    monkeypatch.setattr("rockframe.simulation.run.prove_run", later)
    with pytest.warns(SolverWarning, match=r"in the run at .* s, which is off by 0\.3 s"):
        run = standing.simulate(pulse(peak), free_vibration="10 s", certify="proved", outputs=None)
    assert bool(run.verdict_proved)
    assert "off by 0.3 s" in run.attrs["cautions"]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("accuracy", ["fast", "standard", "reference"])
def test_small_difference_of_overturning_time_does_not_warn(system, accuracy):
    run = system.simulate(
        pulse(3.6), free_vibration="10 s", certify="proved", outputs=None, accuracy=accuracy
    )
    assert bool(run.verdict_proved)


def test_unprovable_scenes_are_refused_before_the_run(system):
    with pytest.raises(ComponentError, match="simulate: proofs are of reaching"):
        system.simulate(pulse(3.0), certify="proved", overturning="continue")
    wall = rf.System(
        rf.Block(width="1 m", height="5 m", mass="10 t"),
        rf.RearWall(side="left", restitution=-0.3),
    )
    with pytest.raises(ComponentError, match="simulate: proofs are of a Block that rocks"):
        wall.simulate(pulse(3.0), certify="proved")
    with pytest.raises(ComponentError, match=r"^prove: proofs are of a Block that rocks"):
        rf.prove(wall, pulse(3.0))
    with pytest.raises(ComponentError, match=r"^prove_critical_scale: proofs are of a Block that"):
        rf.prove_critical_scale(wall, pulse(3.0))
    with pytest.raises(ComponentError, match=r"^prove_critical_scale: system must be a System"):
        rf.prove_critical_scale(pulse(3.0))


def test_report_and_command_state_the_proof(system, tmp_path, capsys):
    from rockframe.command.main import main

    run = system.simulate(pulse(3.0), certify="proved")
    page = rf.report(run, tmp_path / "run.html").read_text(encoding="utf-8")
    assert "The verdict is proved" in page
    assert "No certificate" not in page
    assert "Proved: the block does not overturn" in page
    scene, motion = tmp_path / "scene.toml", tmp_path / "pulse.AT2"
    pulse(3.0).to_at2(motion)
    parts = '[block]\nwidth = "1 m"\nheight = "5 m"\nmass = "10 t"\n'
    scene.write_text(parts)
    assert main(["certify", str(scene), "--motion", str(motion), "--proved"]) == 0
    assert "Proof: Proved: the block" in " ".join(capsys.readouterr().out.split())
    scene.write_text(f'{parts}[run]\ncertify = "proved"\n')
    assert main(["run", str(scene), "--motion", str(motion)]) == 0
    assert "Proof: Proved: the block" in " ".join(capsys.readouterr().out.split())


def test_the_sentence_encloses_the_time_of_overturning(system):
    proof = rf.prove(system, pulse(3.6))
    least, most = re.search(r"between (\S+) s and (\S+) s;", str(proof)).groups()
    assert float(least) <= proof.earliest <= proof.latest <= float(most)
    assert float(most) - float(least) < 1e-10


@pytest.mark.parametrize("base", [rf.RigidGround(), pytest.param(PADS, marks=pytest.mark.long)])
def test_proof_sentence_states_the_interpolation_of_samples(base):
    standing = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"), base)
    assert "this record, joined by straight lines" in str(rf.prove(standing, pulse(1.0)))
    assert "this record times 0.3, joined" in str(rf.prove(standing, pulse(1.0), scale=0.3))
    closed = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    assert "this motion, the polynomials that runs take" in str(rf.prove(standing, closed))


@pytest.mark.parametrize("base", [rf.RigidGround(), PADS])
def test_proof_sentence_states_gravity_and_initial_state(base):
    block = rf.Block(width="1 m", height="5 m", mass="10 t")
    standing = rf.System(block, base, gravity="9.81 m/s^2")
    words = "for the numbers of this block, gravity 9.81 m s^-2, "
    assert f"{words}a start at rest and this record" in str(rf.prove(standing, pulse(1.0)))
    leaning = rf.InitialState(rotation="0.01 rad", angular_velocity="0.002 rad/s")
    proof = str(rf.prove(standing, pulse(1.0), initial=leaning))
    assert f"{words}a start with rotation 0.01 rad and angular velocity 0.002 rad s^-1" in proof
