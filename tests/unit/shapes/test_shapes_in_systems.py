"""Bodies defined by their shape are blocks, and survive round trips of results."""

import pytest
import xarray as xr

import rockframe as rf

pytestmark = pytest.mark.unit

L_SHAPE = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.4, 3.0), (0.4, 4.0), (0.0, 4.0)]


def test_shaped_bodies_survive_result_round_trip(tmp_path):
    bodies = (
        rf.Block.from_outline((L_SHAPE, "m"), mass="1 t"),
        rf.Block.cylinder(diameter="1 m", height="3 m", mass="1 t"),
        rf.Block.from_parts(
            {
                "case": {"width": "0.8 m", "height": "1.9 m", "mass": "40 kg"},
                "shelf": {"mass": "5 kg", "at": ("-0.3 m", "1.5 m")},
            }
        ),
    )
    for number, body in enumerate(bodies):
        system = rf.System(body)
        response = system.simulate(
            duration="1 s", initial=rf.InitialState(rotation="0.05 rad"), output_step="0.1 s"
        )
        file = tmp_path / f"{number}.nc"
        response.to_netcdf(file)
        with xr.open_dataset(file) as stored:
            assert rf.System.from_dataset(stored) == system


def test_description_gives_uplift_acceleration_to_either_side():
    leaning = [(0.0, 0.0), (1.0, 0.0), (0.2, 3.0), (0.0, 3.0)]
    system = rf.System(rf.Block.from_outline(leaning, unit="m", mass="1 t"))
    words = " ".join(system.describe().split())
    assert "2.895 m s^-2 to the right, which tips to the left, or 5.51 m s^-2 to the left" in words
    for amplitude, rocks in ((2.88, False), (2.91, True), (-5.5, False), (-5.52, True)):
        pulse = rf.GroundMotion.half_sine_pulse(f"{amplitude} m/s^2", "0.3 s")
        peak = system.simulate(pulse, outputs=None).peak_rotation.item()
        assert (peak != 0.0) is rocks, amplitude
    level = rf.System(rf.Block(width="0.5 m", height="2 m", mass="1 t")).describe()
    assert "2.452 m s^-2 without vertical motion" in level
