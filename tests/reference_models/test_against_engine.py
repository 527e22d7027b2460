"""The block on two pads against MuJoCo, a multibody engine; skipped where it is not installed.

All cases and steps, with costs: ``python tests/benchmarks/engine_comparison.py``.
"""

import pytest

pytest.importorskip("mujoco")

from benchmarks.engine_comparison import Case, by_engine, by_rockframe, difference

STEP = 2e-4
ALLOWED = 2e-4
ALLOWED_WITH_CHANGES_MET = 1e-8
SECONDS = 2.0
RULES = ("centre", "leading-corner", "contact-state")


def compare_with_engine(case: Case, *, meet_changes: bool) -> tuple[float, int]:
    """Run both; return the difference of the rotation over its peak, and the number of impacts."""
    exact = by_rockframe(case)
    step = 2.0 * STEP if meet_changes else STEP
    difference_found = by_engine(case, step, meet_changes=meet_changes)
    return difference(difference_found, exact["rotation"].to_numpy()), int(exact["impact_count"])


def test_full_contact():
    case = Case("half sine", 0.02, 0.10, seconds=SECONDS)
    difference_found, impacts = compare_with_engine(case, meet_changes=False)
    assert impacts == 0
    assert difference_found < ALLOWED_WITH_CHANGES_MET


@pytest.mark.parametrize("damping_ratio", [pytest.param(0.0, marks=pytest.mark.long), 0.10])
def test_uplift(damping_ratio):
    """Fixed steps: the remaining error comes from steps in which contact changes."""
    case = Case("half sine", 0.35, damping_ratio, seconds=SECONDS)
    difference_found, impacts = compare_with_engine(case, meet_changes=False)
    assert impacts > 0
    assert difference_found < ALLOWED


@pytest.mark.parametrize("restraint", RULES)
def test_uplift_with_steps_at_contact_changes_matches_mujoco(restraint):
    case = Case("half sine", 0.35, 0.10, restraint, seconds=SECONDS)
    difference_found, impacts = compare_with_engine(case, meet_changes=True)
    assert impacts > 0
    assert difference_found < ALLOWED_WITH_CHANGES_MET


@pytest.mark.parametrize("meet_changes", [pytest.param(False, marks=pytest.mark.long), True])
def test_record(meet_changes):
    case = Case("El Centro", 1.0, 0.10, seconds=4.0)
    allowed = ALLOWED_WITH_CHANGES_MET if meet_changes else ALLOWED
    difference_found, impacts = compare_with_engine(case, meet_changes=meet_changes)
    assert impacts > 0
    assert difference_found < allowed
