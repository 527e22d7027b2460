"""One progress bar over all runs of an analysis, whose total grows with its rounds."""

import io
import sys
import types

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError
from rockframe.studies.sweeps import execution

tqdm_auto = pytest.importorskip("tqdm.auto", reason="tqdm is not installed")

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
PULSE = rf.GroundMotion.half_sine_pulse("1 m/s^2", "0.5 s")
FAST = {"free_vibration": "4 s", "accuracy": "fast"}


@pytest.fixture
def bars(monkeypatch):
    """Return all progress bars, each with what it has shown."""
    made = []

    class Bar(tqdm_auto.tqdm):
        def __init__(self, *given, **named):
            made.append(self)
            self.totals, self.words, self.counts = [], [], []
            super().__init__(*given, **named, miniters=1, mininterval=0.0)

        def update(self, n=1):
            super().update(n)
            self.totals.append(self.total)
            self.words.append(self.desc)
            self.counts.append(self.n)

    monkeypatch.setattr(tqdm_auto, "tqdm", Bar)
    return made


ANALYSES = {
    "incremental_dynamic_analysis": lambda **means: rf.incremental_dynamic_analysis(
        SYSTEM, {"one": PULSE, "two": PULSE.scaled(1.3)}, scale=[2, 4, 8], **FAST, **means
    ),
    "overturning_map": lambda **means: rf.overturning_map(
        SYSTEM, rf.GroundMotion.sine_pulse, amplitude=([2, 4, 6], "m/s^2"),
        frequency=([1, 2], "Hz"), **FAST, **means,
    ),
    "overturning_spectrum": lambda **means: rf.overturning_spectrum(
        SYSTEM, PULSE, periods=([2, 4], "s"), scale=[3, 6, 12], **FAST, **means
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    "name",
    [
        "incremental_dynamic_analysis",
        pytest.param("overturning_map", marks=pytest.mark.long),
        pytest.param("overturning_spectrum", marks=pytest.mark.long),
    ],
)
def test_one_bar_counts_all_rounds(name, bars, monkeypatch):
    ran = []
    expect = execution._Bar.expect
    monkeypatch.setattr(
        execution._Bar, "expect", lambda bar, n, done=0: ran.append(n) or expect(bar, n, done)
    )
    ANALYSES[name](progress=True)
    (bar,) = bars
    assert bar.n == bar.total == sum(ran)
    assert bar.totals[0] == ran[0] == 6
    assert len(ran) > 5
    assert bar.totals == sorted(bar.totals)
    assert len(set(bar.totals)) == len(ran)
    assert all(count <= total for count, total in zip(bar.counts, bar.totals, strict=True))
    assert bar.words[0] == f"{name}, scan (total grows)"
    assert f"{name}, round 02 (total grows)" in bar.words
    assert bar.desc == name


def test_stored_cases_count_as_initial_progress(bars, tmp_path):
    analysis = ANALYSES["incremental_dynamic_analysis"]
    first = analysis(progress=True, store=tmp_path)
    again = analysis(progress=True, store=tmp_path)
    one, other = bars
    assert (one.initial, one.n) == (0, one.total)
    assert other.initial == other.n == other.total == one.total
    assert again.identical(first)


def test_bar_counts_scales_of_critical_scale(bars):
    found = rf.critical_scale(SYSTEM, PULSE, largest=8.0, scales=20, progress=True, **FAST)
    (bar,) = bars
    assert bar.n == bar.total == found.sizes["scale"] > 20
    assert bar.totals[:20] == [20] * 20
    assert bar.words[19] == "critical_scale"
    assert bar.words[20] == "critical_scale, more scales (total grows)"
    assert bar.totals[20:] == list(range(21, bar.total + 1))


def test_no_bar_is_shown_without_a_terminal(bars, capsys):
    rf.critical_scale(SYSTEM, PULSE, largest=8.0, scales=5, **FAST)
    ANALYSES["overturning_map"]()
    ANALYSES["overturning_map"](progress=False)
    assert not bars
    assert capsys.readouterr().err == ""


def test_no_bar_is_shown_without_a_stream_of_errors(bars, monkeypatch):
    closed = io.StringIO()
    closed.close()
    for stream in (None, closed):  # None in a program with windows
        monkeypatch.setattr(sys, "stderr", stream)
        rf.sweep(SYSTEM, PULSE, scale=[1, 2], **FAST)
    assert not bars


def test_a_bar_is_closed_when_something_fails(bars):
    def stops(*_):
        raise RuntimeError

    with pytest.raises(RuntimeError), execution.progress_bar(True, owner="some") as bar:
        stops(bar.expect(3))
    assert bars[0].disable  # as tqdm marks a closed bar


def test_notebook_widget_total_grows(monkeypatch):
    widget = types.SimpleNamespace(max=2)

    class Notebook:
        def __init__(self, total, initial, **_):
            self.total, self.initial, self.n = total, initial, initial
            self.container = types.SimpleNamespace(children=(None, widget, None))

        def set_description_str(self, *_, **__):
            pass

        def close(self):
            pass

    monkeypatch.setattr(tqdm_auto, "tqdm", Notebook)
    with execution.progress_bar(True, owner="some") as bar:
        bar.expect(2)
        bar.expect(5, 1)
    assert widget.max == 7
    assert bar._bar.n == bar._bar.initial == 1


def test_invalid_progress_option_is_refused(monkeypatch):
    with pytest.raises(ComponentError, match="critical_scale: progress must be True, False or"):
        rf.critical_scale(SYSTEM, PULSE, progress=1.0)
    with pytest.raises(ComponentError, match="overturning_map: progress must be"):
        ANALYSES["overturning_map"](progress="yes")
    monkeypatch.setitem(sys.modules, "tqdm", None)
    with pytest.raises(ComponentError, match=r"critical_scale: progress=True needs tqdm"):
        rf.critical_scale(SYSTEM, PULSE, progress=True)
    assert np.isfinite(
        rf.critical_scale(SYSTEM, PULSE, largest=8.0, scales=5, **FAST).critical_scale
    )


def test_one_bar_counts_all_levels(bars):
    spread = {"scale": ("lognormal", 3.6, 0.1)}
    found = rf.subset_simulation(SYSTEM, PULSE, spread=spread, cases=200, **FAST, progress=True)
    (bar,) = bars
    assert bar.n == bar.total == found.run_count.item() > 200
    assert bar.totals[0] == 200
    assert bar.words[0] == "subset_simulation, level 01 (total grows)"
    assert "subset_simulation, level 02 step 01 (total grows)" in bar.words
    assert bar.desc == "subset_simulation"
