"""What the page "Speed and accuracy" says that parts cost is what was measured."""

import json

import pytest
from pages import DOCS, said, table

PAGE = "validation_speed.md"
HEAD = '| part | `"fast"`: a step | the run | `"standard"`: a step | the run | steps |'
MEASURED = json.loads((DOCS / "data" / "parts_cost.json").read_text(encoding="utf-8"))


def test_every_part_stands_in_the_table():
    assert [row[0] for row in table(PAGE, HEAD)] == list(MEASURED)


def test_ratios_are_those_measured():
    for name, *cells in table(PAGE, HEAD):
        one = [MEASURED[name][level] for level in ("fast", "standard")]
        ratios = [level[key] for level in one for key in ("ratio of a step", "ratio")]
        steps = one[1]["steps with"] / one[1]["steps without"]
        for cell, found in zip(cells, (*ratios, steps), strict=True):
            assert float(cell) == pytest.approx(found, rel=0.06), name


def test_a_slack_restrainer_adds_no_steps():
    (most,) = said(PAGE, "One that hangs slack adds no step but # at its events")
    for ground in ("rigid ground", "pads"):
        for level in MEASURED[f"restrainer, slack, {ground}"].values():
            assert 0 <= level["steps with"] - level["steps without"] <= most
