"""The example of office contents: its output and its file."""

import runpy
import sys
from pathlib import Path

import pandas as pd
import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "office_contents.py"


@pytest.mark.long
def test_script_compares_medians_with_fema(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(sys, "argv", [str(SCRIPT), "--motions", "3", "--folder", str(tmp_path)])
    with pytest.raises(SystemExit) as left:
        runpy.run_path(str(SCRIPT), run_name="__main__")
    assert left.value.code == 0
    table = pd.read_csv(tmp_path / "office_contents.csv", index_col="component")
    stdout = capsys.readouterr().out
    assert all(name in stdout for name in table.index)
    assert len(table) == 9
    # of bookcases of one depth the taller falls first; all are of the order of FEMA's medians
    shelves = table.iloc[:5]["computed [m/s]"]
    assert shelves.iloc[0] > shelves.iloc[2] > shelves.iloc[4]
    assert table["ratio"].between(0.6, 2.0).all()
    rows = pd.read_csv(tmp_path / "damage_library.csv", index_col="ID")
    assert rows["LS1-Theta_0"].round(3).tolist() == table["computed [m/s]"].tolist()
    assert set(rows["Demand-Type"]) == {"Peak Floor Velocity"}
    assert (tmp_path / "office_contents.png").stat().st_size > 10_000
