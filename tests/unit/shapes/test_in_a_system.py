"""Bodies by their shape are blocks: a result keeps them, through a file too."""

import pytest
import xarray as xr

import rockframe as rf

pytestmark = pytest.mark.unit

L_SHAPE = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.4, 3.0), (0.4, 4.0), (0.0, 4.0)]


def test_a_result_in_a_file_keeps_the_body(tmp_path):
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
        with xr.open_dataset(file) as kept:
            assert rf.System.from_dataset(kept) == system
