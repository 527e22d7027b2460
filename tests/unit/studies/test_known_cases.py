"""Extended and combined studies reuse stored cases instead of running them again."""

import numpy as np
import pytest
from stored_sweep import assert_identical

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.studies.sweeps.study import Study

pytestmark = [
    pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning"),
]

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
NOISE = np.random.default_rng(5).normal(size=400)


def record(count, size):
    return rf.GroundMotion.from_arrays((size * NOISE[:count], "m/s^2"), "0.01 s", name="noise")


MOTIONS = {
    "weak": rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"),
    "10": record(400, 2.0),
    "9": record(150, 5.0),
    "a": rf.GroundMotion.half_sine_pulse("6 m/s^2", "0.4 s"),
}
SCALES = [1.0, 0.5, 2.0, 0.7, 1.5]
HEIGHTS = ["2 m", "0.2 m", "1 m"]  # the second cannot rock


@pytest.fixture
def cases_run(monkeypatch):
    """Return a list that collects the cases that are run."""
    count, plain = [], Study.job

    def job(self, cases):
        count.extend(np.asarray(cases).tolist())
        return plain(self, cases)

    monkeypatch.setattr(Study, "job", job)
    return count


def swept(motions=tuple(MOTIONS), scales=SCALES, heights=HEIGHTS, **run):
    return rf.sweep(
        SYSTEM, {name: MOTIONS[name] for name in motions}, height=heights, scale=scales,
        **{"accuracy": "fast", "chunk": 4, **run},
    )  # fmt: skip


@pytest.mark.parametrize(
    "chunk", [7, *(pytest.param(size, marks=pytest.mark.long) for size in (1, 4, 1000))]
)
def test_a_study_is_extended_by_motions_and_values(tmp_path, cases_run, chunk):
    complete = swept()
    swept(("10", "weak"), [0.5, 1.0], HEIGHTS[::-1], store=tmp_path / "first")
    cases_run.clear()
    more = swept(store=tmp_path / "more", known=tmp_path / "first", chunk=chunk)
    assert_identical(more, complete)
    assert len(cases_run) == len(set(cases_run)) == 60 - 2 * 2 * 3
    cases_run.clear()
    assert_identical(swept(store=tmp_path / "more", known=str(tmp_path / "first")), complete)
    assert_identical(swept(store=tmp_path / "more"), complete)  # independent of the first study
    assert not cases_run


def test_studies_are_combined(tmp_path, cases_run):
    complete = swept()
    swept(("a", "9"), store=tmp_path / "some")
    swept(("weak", "9", "10"), store=tmp_path / "others")
    cases_run.clear()
    parts = [tmp_path / "others", tmp_path / "some"]
    assert_identical(swept(store=tmp_path / "all", known=parts), complete)
    assert not cases_run
    few = swept(("9",), [2.0])  # too few for lanes, in which the stored ones were run
    assert_identical(
        swept(("9",), [2.0], store=tmp_path / "one", known=parts), few, apart=["driver"]
    )


def test_cases_missing_from_the_known_study_are_run(tmp_path, cases_run):
    settings = {"outputs": ["rotation"], "output_step": "0.02 s", "duration": "3 s",
            "points": {"top": ("0 m", "2 m")}, "accuracy": "standard"}  # fmt: skip
    heights = ["2 m", "3 m"]
    complete = swept(heights=heights, **settings)
    swept(("weak", "9"), heights=heights, store=tmp_path / "first", **settings)
    (tmp_path / "first" / "chunk-000001.arrays").unlink()
    cases_run.clear()
    more = swept(heights=heights, store=tmp_path / "more", known=tmp_path / "first", **settings)
    assert_identical(more, complete)
    assert len(cases_run) == 20 + 4


def test_incompatible_known_study_is_refused(tmp_path):
    swept(store=tmp_path / "first")
    known = {"store": tmp_path / "more", "known": tmp_path / "first"}
    with pytest.raises(StudyError, match=r"known: .* differs in arguments \(accuracy"):
        swept(accuracy="standard", **known)
    other = rf.System(rf.Block(width="0.6 m", height="2 m", mass="400 kg"))
    with pytest.raises(StudyError, match=r"known: .* differs in scene"):
        rf.sweep(other, MOTIONS, height=HEIGHTS, scale=SCALES, accuracy="fast", **known)
    with pytest.raises(StudyError, match=r"holds a study over height, scale; expected the axes h"):
        rf.sweep(SYSTEM, MOTIONS, height=HEIGHTS, accuracy="fast", **known)
    with pytest.raises(StudyError, match="grids of one system"):
        rf.sweep(
            SYSTEM, MOTIONS, cases={"width": ["0.5 m"]}, height=HEIGHTS, scale=SCALES,
            accuracy="fast", **known,
        )  # fmt: skip
    with pytest.raises(StudyError, match="give store='a folder'"):
        swept(known=tmp_path / "first")
    with pytest.raises(StudyError, match="found no study"):
        swept(store=tmp_path / "more", known=tmp_path / "nothing")


def test_cases_that_the_known_study_gets_meanwhile_are_run_too(tmp_path, monkeypatch):
    complete = swept(heights=["2 m"], scales=[0.5, 1.0])
    swept(heights=["2 m"], scales=[0.5, 1.0], store=tmp_path / "first")
    late = tmp_path / "first" / "chunk-000001.arrays"
    content, plain = late.read_bytes(), Study.job
    late.unlink()

    def job(self, cases):
        late.write_bytes(content)  # by another job, which goes on with the known study
        return plain(self, cases)

    monkeypatch.setattr(Study, "job", job)
    more = swept(
        heights=["2 m"], scales=[0.5, 1.0], store=tmp_path / "more", known=tmp_path / "first",
        chunk=8,
    )  # fmt: skip
    assert_identical(more, complete)
