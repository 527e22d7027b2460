"""The error of fixed sub-steps falls with the third power of their length, events included."""

import math

import numpy as np
import pytest
from overdamping import overdamped

import rockframe as rf
from rockframe.errors import SolverError

HALVINGS = 4
ORDER = 3
SETTLED = 3
"""Last members of a series of halvings by which its order is judged."""


def record(peak: float = 3.5) -> rf.GroundMotion:
    """Return five seconds at 10 ms, with kinks at the samples like every record."""
    noise = np.random.default_rng(4).normal(size=(2, 501))
    across, up = (np.convolve(row, np.hanning(41) / 20.0, "same") for row in noise)
    return rf.GroundMotion.from_arrays(
        (peak * across / abs(across).max(), "m/s^2"),
        "0.01 s",
        vertical=(2.0 * up / abs(up).max(), "m/s^2"),
    )


def block() -> rf.Block:
    return rf.Block.from_size(radius="5 m", slenderness=4, mass="100 t")


def pads(damping_ratio: float = 0.1) -> rf.TwoSpringSupport:
    return rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=damping_ratio)


def frame() -> rf.RockingFrame:
    return rf.RockingFrame(block(), columns=2, beam_mass="50 t")


def tendon() -> rf.Tendon:
    return rf.Tendon(stiffness="20 MN/m", preload="100 kN")


def tie() -> rf.Restrainer:
    return rf.Restrainer(on=("0 m", "9 m"), to=("-2 m", "9 m"), stiffness="1 MN/m", slack="50 mm")


def stack() -> rf.Stack:
    plinth = rf.Block(width="4 m", height="3 m", mass="120 t")
    return rf.Stack(block(), plinth, interfaces=[rf.RigidGround()])


def cap() -> rf.CushionCap:
    return rf.CushionCap(height="0.9 m", mass="36 t")


def soil() -> rf.WinklerSoil:
    return rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)


# scene, fewest sub-steps of the series, events that must happen
SCENES = {
    "rigid ground": (rf.System(block()), 1, {"impact", "uplift"}),
    "tendons": (rf.System(frame(), tendon()), 1, {"impact", "uplift"}),
    "restrainer": (rf.System(block(), tie()), 1, {"impact", "restrainer_taut"}),
    "stack": (rf.System(stack()), 1, {"impact", "uplift"}),
    "pads": (rf.System(block(), pads()), 1, {"separation", "impact"}),
    "undamped pads": (rf.System(block(), pads(0.0)), 1, {"separation", "impact"}),
    "critically damped pads": (rf.System(block(), pads(1.0)), 2, {"separation", "impact"}),
    "leading corner": (
        rf.System(block(), pads(), restraint="leading-corner"), 1, {"impact", "pivot_change"},
    ),
    "soil": (rf.System(block(), soil()), 1, {"separation", "reengagement"}),
    "coupled": (rf.System(block(), pads(), cap(), soil()), 2, {"separation", "impact"}),
    "cascade": (
        rf.System(block(), pads(), cap(), soil(), coupling="cascade"), 2, {"separation", "impact"},
    ),
}  # fmt: skip


def kinds(response) -> set[str]:
    names = response.event_kind.attrs["flag_meanings"].split()
    values = np.atleast_1d(response.event_kind.attrs["flag_values"]).tolist()
    known = dict(zip(values, names, strict=True))
    return {known[int(value)] for value in response.event_kind.to_numpy()}


def errors(system: rf.System, fewest: int) -> tuple[dict[str, np.ndarray], set[str]]:
    run = {"motion": record(), "overturning": "continue"}
    exact = system.simulate(accuracy=rf.Accuracy(rtol=1e-13), **run)
    out: dict[str, list[float]] = {"history": [], "peak": [], "energy": []}
    for halving in range(HALVINGS + 1):
        accuracy = rf.Accuracy(substeps=fewest * 2**halving)
        response = system.simulate(accuracy=accuracy, **run)
        out["history"].append(float(abs(response.rotation - exact.rotation).max()))
        out["peak"].append(abs(float(response.peak_rotation - exact.peak_rotation)))
        out["energy"].append(float(response.energy_residual))
        assert response.event_time.size == exact.event_time.size
    size = float(exact.peak_rotation)
    relative = {name: np.array(column) for name, column in out.items()}
    return {**relative, "history": relative["history"] / size, "peak": relative["peak"] / size}, (
        kinds(exact)
    )


def slope(error: np.ndarray) -> float:
    """Return the order of convergence that fits the last halvings of a series."""
    last = np.log2(error[-SETTLED:])
    return -float(np.polyfit(np.arange(SETTLED), last, 1)[0])


@pytest.mark.parametrize(
    "scene",
    # no other test compiles these equations for fixed steps
    [
        pytest.param(one, marks=[pytest.mark.long] * (one in ("stack", "coupled", "cascade")))
        for one in SCENES
    ],
)
def test_third_order_with_events(scene):
    system, fewest, wanted = SCENES[scene]
    error, happened = errors(system, fewest)
    assert wanted <= happened
    orders = {name: slope(column) for name, column in error.items()}
    assert min(orders.values()) >= ORDER - 0.25
    assert error["history"][0] < 5e-4
    assert error["energy"][0] < 2e-4


@pytest.mark.parametrize("scene", ["pads", "soil", "coupled", "cascade"])
def test_the_energy_balances_at_all_times(scene):
    system, fewest, _ = SCENES[scene]
    imbalance = []
    for substeps in (fewest, 4 * fewest):
        response = system.simulate(
            record(),
            accuracy=rf.Accuracy(substeps=substeps),
            outputs=["energy"],
            output_step="7 ms",
        )
        stored = response.kinetic_energy + response.potential_energy + response.elastic_energy
        lost = response.dissipated_energy + response.impact_energy + response.repinning_energy
        balance = stored + lost - response.input_energy
        size = max(float(abs(part).max()) for part in (stored, lost, response.input_energy))
        imbalance.append(float(abs(balance - balance[0]).max()) / size)
    assert imbalance[0] < 1e-4
    assert imbalance[1] < imbalance[0] / 30.0


def test_more_output_times_change_nothing():
    system, fewest, _ = SCENES["pads"]
    accuracy = rf.Accuracy(substeps=fewest)
    coarse = system.simulate(record(3.0), accuracy=accuracy)
    fine = system.simulate(record(3.0), accuracy=accuracy, output_step="2.5 ms")
    none = system.simulate(record(3.0), accuracy=accuracy, outputs=None)
    np.testing.assert_array_equal(coarse.rotation, fine.rotation[::4])
    for name in ("peak_rotation", "impact_count", "energy_residual", "first_uplift_time"):
        assert float(coarse[name]) == float(fine[name]) == float(none[name])


def test_an_event_does_not_shift_the_grid():
    system, _, _ = SCENES["rigid ground"]
    for substeps in (1, 3):
        response = system.simulate(record(), accuracy=rf.Accuracy(substeps=substeps))
        events = np.unique(response.event_time)
        # each event cuts one step in two
        assert response.attrs["solver_steps"] == 500 * substeps + events.size


@overdamped
def test_an_unstable_number_of_substeps_is_refused():
    stiff = rf.TwoSpringSupport(frequency_ratio=200, damping_ratio=1.5)
    system = rf.System(block(), stiff)
    with pytest.raises(SolverError, match=r"substeps=4 .* give at least \d+") as caught:
        system.simulate(record(), accuracy=rf.Accuracy(substeps=4))
    least = int(str(caught.value).split("at least ")[1].split(",")[0])
    response = system.simulate(
        record().scaled(0.1), accuracy=rf.Accuracy(substeps=least), free_vibration="5 s"
    )
    calm = response.sel(time=slice(8.0, None))
    assert float(abs(calm.vertical_displacement).max()) < 1e-12


@overdamped
@pytest.mark.parametrize("damping_ratio", [0.0, 0.3, 1.5])
def test_least_number_of_substeps_follows_fastest_vibration(damping_ratio):
    """Steps of 0.85 over omega (zeta + sqrt(1 + zeta^2))."""
    undamped, damped = (
        rf.System(block(), rf.TwoSpringSupport(frequency_ratio=200, damping_ratio=ratio))
        for ratio in (0.0, damping_ratio)
    )
    fastest = float(undamped.frequencies().angular_frequency[-1])
    rate = fastest * (damping_ratio + math.hypot(1.0, damping_ratio))
    with pytest.raises(SolverError) as caught:
        damped.simulate(record(), accuracy=rf.Accuracy(substeps=1))
    assert f"fastest vibration ({fastest / (2.0 * math.pi):.4g} Hz)" in str(caught.value)
    assert f"give at least {math.ceil(0.01 * rate / 0.85)}," in str(caught.value)


@overdamped
@pytest.mark.parametrize("damping_ratio", [0.0, 0.05, 0.3, 1.0, 3.0])
@pytest.mark.parametrize("frequency_ratio", [20, 200])
def test_fast_is_stable(frequency_ratio, damping_ratio):
    pads = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=damping_ratio)
    system = rf.System(block(), pads)
    weak = record().scaled(0.1)
    fast = system.simulate(weak, accuracy="fast", free_vibration="20 s")
    exact = system.simulate(weak, free_vibration="20 s")
    assert float(abs(fast.rotation - exact.rotation).max()) < 0.01 * float(exact.peak_rotation)


# with samples so coarse that the ground's slope changes in each step
COARSE = {
    "rigid ground": rf.System(block()),
    "wall": rf.System(block(), rf.RearWall(side="left", restitution=-0.5)),
    "frame": rf.System(frame()),
    "tendons": SCENES["tendons"][0],
    "friction": rf.System(block(), rf.RigidGround(friction=0.26)),
    "restrainer": SCENES["restrainer"][0],
    "stack": SCENES["stack"][0],
}


@pytest.mark.parametrize("scene", COARSE)
@pytest.mark.parametrize("peak", [3.4, 4.6])
def test_energy_residual_is_small_with_coarse_steps(scene, peak):
    noise = np.convolve(np.random.default_rng(8).normal(size=80), np.hanning(7), "same")
    motion = rf.GroundMotion.from_arrays(
        (peak * noise / abs(noise).max(), "m/s^2"), time_step="0.04 s"
    )
    run = COARSE[scene].simulate(motion, accuracy="fast", second_look=False)
    assert run.attrs["solver_substeps"] <= 2
    assert run.event_time.size > 1
    assert float(run.energy_residual) < 2e-4
