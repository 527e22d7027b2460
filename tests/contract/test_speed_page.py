"""Costs of parts and histories on the page "Speed and accuracy" are the measured ones."""

import json

import pytest
from pages import DOCS, numbers_in, table

PAGE = "validation_speed.md"
HEAD = '| part | `"fast"`: a step | the run | `"standard"`: a step | the run | steps |'
MEASURED = json.loads((DOCS / "data" / "parts_cost.json").read_text(encoding="utf-8"))


def test_every_measured_part_is_in_table():
    assert [row[0] for row in table(PAGE, HEAD)] == list(MEASURED)


def test_ratios_are_those_measured():
    for name, *cells in table(PAGE, HEAD):
        one = [MEASURED[name][level] for level in ("fast", "standard")]
        ratios = [level[key] for level in one for key in ("ratio of a step", "ratio")]
        steps = one[1]["steps with"] / one[1]["steps without"]
        for cell, found in zip(cells, (*ratios, steps), strict=True):
            assert float(cell) == pytest.approx(found, rel=0.06), name


def test_a_slack_restrainer_adds_no_steps():
    (most,) = numbers_in(PAGE, "A restrainer that remains slack adds no step but # at its events")
    for ground in ("rigid ground", "pads"):
        for level in MEASURED[f"restrainer, slack, {ground}"].values():
            assert 0 <= level["steps with"] - level["steps without"] <= most


def test_documented_cost_of_histories_matches_measurements():
    columns = ("the loop [ms]", "columns [ms]", "peaks [ms]", "dataset [ms]")
    head = "| | the loop [ms] | without histories | with histories | " + " | ".join(columns[1:])
    keys = (
        "loop [ms]", "without histories, ratio", "with histories, ratio", *columns[1:],
    )  # fmt: skip
    measured = json.loads((DOCS / "data" / "one_run.json").read_text(encoding="utf-8"))
    rows = {name: cells for name, *cells in table(PAGE, f"{head} |")}
    assert len(rows) == sum(map(len, measured.values()))
    for scene, levels in measured.items():
        for level, one in levels.items():
            cells = map(float, rows[f'{scene}, `"{level}"`'])
            assert [*cells] == pytest.approx([one[key] for key in keys], abs=0.006)
