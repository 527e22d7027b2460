"""Finding flips along a scale, with artificial verdicts and clearances."""

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.solve.workspace import Status
from rockframe.studies.flips import MIN_INTERVAL, flips_sentence, scan_scales

ROW = [0.1 * k for k in range(41)]


def runs_of(peak, undecided=lambda scale: False):
    """Make runs whose peak over the overturning angle is a function of the scale."""
    tried = []

    def look(scale):
        tried.append(scale)
        share = peak(scale)
        if undecided(scale):
            return RunSummary(
                None, min(share, 1.0), (1.0 - min(share, 1.0),), status=Status.CHATTER
            )
        if share < 1.0:
            return RunSummary(False, share, (1.0 - share,))
        return RunSummary(
            True, 1.0, (share - 1.0, 1.0), time=1.0, direction=1, status=Status.OVERTURNED
        )

    return look, tried


def test_single_flip_is_bracketed_to_requested_width():
    for width in (1e-2, 1e-5, 1e-12):
        look, _ = runs_of(lambda scale: scale / math.pi)
        [flip] = scan_scales(look, ROW, max_runs=100, width=width).flips()
        assert flip.overturns_above
        assert flip.below < math.pi <= flip.above
        assert flip.above - flip.below <= width * flip.above


def test_overturning_island_is_found_when_peaks_hint_at_it():
    def peak(scale):
        return 0.2 * scale + 0.8 * math.exp(-((10.0 * (scale - 1.55)) ** 2))

    look, tried = runs_of(peak)
    found = scan_scales(look, ROW, max_runs=100, width=1e-4)
    assert not any(peak(scale) >= 1.0 for scale in ROW if scale < 5.0)
    assert [flip.overturns_above for flip in found.flips()] == [True, False]
    for flip in found.flips():
        assert (peak(flip.below) < 1.0) != (peak(flip.above) < 1.0)
    assert found.resolved_up_to == ROW[-1]
    assert len(set(tried)) == len(tried) == len(found.runs) < 100


def test_sentence_states_the_largest_gap_between_runs():
    """An island without any sign in the peaks is missed, and the sentence does not exclude it."""
    look, _ = runs_of(lambda scale: 1.5 if 2.001 < scale < 2.099 else 0.05)
    found = scan_scales(look, ROW, max_runs=100, width=1e-4)
    assert found.flips() == []
    assert found.resolved_up_to == ROW[-1]
    assert found.largest_gap == pytest.approx(0.1)
    assert flips_sentence(found, width=1e-4).endswith("41 scales tried up to 4, at most 0.1 apart.")
    fine = scan_scales(look, [0.05 * k for k in range(81)], max_runs=100, width=1e-4)
    assert fine.largest_gap < 2.099 - 2.001
    assert len(fine.flips()) == 2


@pytest.mark.parametrize("gap", [0.1, 0.30000001, 0.0126, 0.00999, 9.91, 1e-9, 123.0])
def test_a_gap_is_rounded_up(gap):
    look, _ = runs_of(lambda scale: 0.01)
    text = flips_sentence(scan_scales(look, [0.0, gap], max_runs=2, width=1e-3), width=1e-3)
    stated = float(text.partition("at most ")[2].partition(" apart")[0])
    assert gap * (1.0 - 1e-9) <= stated <= 1.1 * gap


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-7])
def test_sentence_has_the_digits_of_the_bracket(width):
    look, _ = runs_of(lambda scale: scale / math.pi)
    scan = scan_scales(look, ROW, max_runs=100, width=width)
    stated = flips_sentence(scan, width=width).partition("from ")[2].partition(" times")[0]
    [flip] = scan.flips()
    assert float(stated) == pytest.approx(flip.above, rel=0.5 * width)


def test_a_run_without_a_verdict_leaves_a_gap():
    look, _ = runs_of(lambda scale: 0.05, undecided=lambda scale: 1.05 < scale < 1.45)
    assert scan_scales(look, ROW, max_runs=41, width=1e-3).largest_gap == pytest.approx(0.5)


def test_sentence_states_resolved_range_when_runs_are_exhausted():
    def peak(scale):
        return 0.2 * scale + 0.8 * math.exp(-((10.0 * (scale - 1.55)) ** 2))

    look, tried = runs_of(peak)
    found = scan_scales(look, ROW, max_runs=len(ROW), width=1e-4, resolution=0.02)
    assert len(tried) == len(ROW)
    assert found.flips() == []
    assert found.resolved_up_to == 0.0
    sentence = flips_sentence(found, width=1e-4, resolution=0.02)
    assert sentence.endswith(
        "Beyond 0 some are more than 2 % apart, and a lesser scale between them may overturn."
    )


def test_scarce_runs_halve_the_widest_gaps_first():
    """Of 1 to 2, 2 to 3.1 and 3.1 to 4, which are 0.5, 0.35 and 0.23 of their upper ends wide."""
    look, tried = runs_of(lambda scale: 0.01)
    scan_scales(look, [1.0, 2.0, 3.1, 4.0], max_runs=7, width=1e-3, resolution=0.02)
    assert tried[4:] == pytest.approx([1.5, 2.55, 1.25])


@pytest.mark.parametrize("count", range(5))
def test_scarce_runs_halve_intervals_nearest_to_overturning_first(count):
    peaks = {0.0: 0.3, 1.0: 0.75, 2.0: 0.3, 3.0: 0.95, 4.0: 0.3}
    look, tried = runs_of(lambda scale: peaks.get(scale, 0.5))
    scan_scales(look, list(peaks), max_runs=5 + count, width=1e-3)
    assert tried[5:] == [2.5, 3.5, 0.5, 1.5][:count]


def test_gaps_are_halved_only_below_the_least_scale_that_overturns():
    look, tried = runs_of(lambda scale: scale / math.pi)
    found = scan_scales(look, ROW, max_runs=1000, width=1e-4, resolution=0.02, may_slide=True)
    [flip] = found.flips()
    below = [ends for ends in pairwise(found.runs) if ends[0] > 0.0 and ends[1] <= flip.above]
    assert all(far - near <= 0.02 * far for near, far in below)
    assert {scale for scale in tried if scale > ROW[32]} == set(ROW[33:])
    assert found.resolved_up_to == ROW[32]


@pytest.mark.parametrize("resolution", [0.05, 0.02, pytest.param(0.005, marks=pytest.mark.long)])
def test_no_range_wider_than_resolution_is_missed_in_resolved_range(resolution):
    """Also where peaks are constant and indicate no island."""
    start = 1.3
    for length in (1.05, 2.0):
        wide = start * (1.0 + length * resolution)
        look, tried = runs_of(lambda at, wide=wide: 1.5 if start < at < wide else 0.01)
        found = scan_scales(look, [0.0, 1.0, 2.0], max_runs=3000, width=1e-4, resolution=resolution)
        assert found.resolved_up_to >= start
        assert [flip.overturns_above for flip in found.flips()][:1] == [True]
        few = scan_scales(look, [0.0, 1.0, 2.0], max_runs=20, width=1e-4, resolution=resolution)
        assert few.resolved_up_to < start

    # a base that does not lift does not lift at any smaller scale either
    def still(scale):
        return replace(look(scale), lifted=scale > 1.0)

    count = len(tried)
    assert (
        scan_scales(
            still, [0.0, 1.0, 2.0], max_runs=3000, width=1e-4, resolution=resolution
        ).resolved_up_to
        >= start
    )
    assert min(tried[count + 3 :]) > 1.0


def test_runs_without_a_verdict_do_not_form_flips():
    look, _ = runs_of(lambda scale: scale / 2.0, undecided=lambda scale: 1.8 < scale < 2.3)
    found = scan_scales(look, ROW, max_runs=200, width=1e-4)
    [flip] = found.flips()
    assert flip.below <= 1.8 + 1e-12
    assert flip.above >= 2.3 - 1e-12
    assert 1.5 < found.resolved_up_to <= 1.8 + 1e-12
    text = flips_sentence(found, width=1e-3)
    assert "5 runs could not be finished and have no verdict, the first at 1.9." in text
    assert "Overturns from 2.3 times the motion on" in text


def test_runs_without_a_verdict_below_the_critical_scale_leave_it_uncertain():
    look, _ = runs_of(lambda scale: scale / math.pi, lambda scale: 0.0 < scale < 3.15)
    found = scan_scales(look, ROW, max_runs=100, width=1e-3, resolution=0.01)
    [flip] = found.flips()
    assert (flip.below, found.resolved_up_to) == (0.0, 0.0)
    assert flip.above >= math.pi
    words = "Beyond 0 some are more than 1 % apart, and a lesser scale between them may overturn."
    assert words in flips_sentence(found, width=1e-3, resolution=0.01)


def test_no_caution_about_lesser_scales_when_the_least_overturns():
    look, _ = runs_of(lambda scale: 1.2)
    text = flips_sentence(
        scan_scales(look, ROW, max_runs=41, width=1e-3, resolution=0.01), width=1e-3
    )
    assert text == "Overturns without the motion; 41 scales tried up to 4, at most 0.1 apart."


def test_refinement_skips_low_peaks_and_terminates():
    look, tried = runs_of(lambda scale: 0.05 * abs(math.sin(40.0 * scale)))
    scan_scales(look, ROW, max_runs=10_000, width=1e-3)
    assert len(tried) == len(ROW)
    look, _ = runs_of(lambda scale: 0.9 + 0.09 * math.sin(1e6 * scale))
    found = scan_scales(look, ROW, max_runs=10_000, width=1e-3)
    scales = list(found.runs)
    assert len(scales) < 10_000
    assert all(b - a > 0.49 * MIN_INTERVAL * b for a, b in pairwise(scales))


def test_at_most_three_surviving_ranges_are_named():
    row = [0.05 + 0.1 * k for k in range(40)]
    for length, ranges in ((2.0, 1), (1.0, 3), (0.5, 7)):
        look, _ = runs_of(lambda at, length=length: 1.5 if at % length >= 0.5 * length else 0.5)
        found = scan_scales(look, row, max_runs=len(row), width=1e-6)
        text = flips_sentence(found, width=1e-6)
        assert sum(not flip.overturns_above for flip in found.flips()) == ranges
        assert text.startswith(f"Overturns from {0.5 * length:g} times the motion on, stands again")
        named = text.partition(";")[0].count("from") - 1
        assert named == min(ranges, 3)
        assert (f"and in {ranges - 3} further ranges;" in text) == (ranges > 3)


def test_interrupted_scan_retains_completed_runs():
    def peak(scale):
        return 0.2 * scale + 0.8 * math.exp(-((10.0 * (scale - 1.55)) ** 2))

    look, tried = runs_of(peak)
    how = {"max_runs": 400, "width": 1e-4, "resolution": 0.05}
    complete = scan_scales(look, ROW, **how)
    assert complete.completed
    again = 0
    for count in range(1, len(tried)):
        look, _ = runs_of(peak)
        left = iter([None] * count)

        def interrupted(scale, look=look, left=left):
            for _ in left:
                return look(scale)
            raise KeyboardInterrupt

        found = scan_scales(interrupted, ROW, **how)
        assert not found.completed
        assert sorted(found.runs) == sorted(tried[:count])
        assert "interrupted" in flips_sentence(found, width=1e-4)
        # every flip of the complete analysis up to that scale lies in a bracket
        for flip in complete.flips():
            around = [one for one in found.flips() if one.below <= flip.below < one.above]
            if flip.above <= found.resolved_up_to:
                assert around
                again += 1
    assert again > 50
    with pytest.raises(KeyboardInterrupt):
        scan_scales(interrupted, ROW, max_runs=100, width=1e-4)
