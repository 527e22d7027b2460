"""The digest of a study changes with whatever changes its numbers."""

import inspect
import shutil
from dataclasses import dataclass, fields, is_dataclass, replace

import numpy as np
import pytest
from stored_sweep import assert_identical
from user_examples import example

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.studies.sweeps.identity import _source_of_class, description_of, digest_of
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.study import Study, SweepJob

pytestmark = [
    pytest.mark.wide,
    pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning"),
]

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
OTHER = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"), gravity="9.8 m/s^2")
WEAK, STRONG = (rf.GroundMotion.sine_pulse(f"{size} m/s^2", "1 Hz") for size in (3, 9))
MOTIONS = {"weak": WEAK, "strong": STRONG}
REVERSED = dict(reversed(MOTIONS.items()))
NEUTRAL = {
    "executor": "runs are the same, whoever makes them",
    "chunk": "a store keeps to the chunks that it was begun with",
    "progress": "a bar shows what is done",
    "store": "it is where the study is kept",
}
"""Arguments that change no numbers, and why."""
RUN = {
    "duration": "2.5 s",
    "free_vibration": "1 s",
    "initial": rf.InitialState(rotation="0.01 rad"),
    "accuracy": "standard",
    "overturning": "continue",
}
SEQUENCE = ("initial", "accuracy", "overturning")

SWEPT = {"scene": SYSTEM, "motions": MOTIONS, "scale": [1.0, 2.0], "accuracy": "fast"}
SWEEP_CHANGES = {
    **RUN,
    "scene": OTHER,
    "motions": REVERSED,
    "axes": {"height": ["1 m", "2 m"]},
    "cases": {"width": ["0.5 m"]},
    "points": {"top": ("0 m", "2 m")},
    "outputs": ["rotation"],
    "more_axes": ({}, {"scale": [1.0, 3.0]}),
    "output_step": ({"outputs": ["rotation"]}, {"outputs": ["rotation"], "output_step": "0.02 s"}),
    "period": tuple(
        {"scale": None, "pseudo_spectral_acceleration": ["2 m/s^2", "3 m/s^2"], "period": period}
        for period in ("0.5 s", "2 s")
    ),
}
"""By arguments: another value, or what is asked for at first and then."""

SIZES = {"system": SYSTEM, "motions": MOTIONS, "periods": ([2, 4], "s"), "slenderness": [3, 4]}
SIZES_CHANGES = {
    "system": OTHER, "motions": REVERSED, "periods": ([2, 5], "s"), "slenderness": [3, 5],
    "axes": {"gravity": ["9 m/s^2", "10 m/s^2"]},
    "more_axes": ({"gravity": ["9 m/s^2"]}, {"gravity": ["10 m/s^2"]}),
}  # fmt: skip
SPECTRAL = tuple({"intensity": "SA", "period": period} for period in ("0.5 s", "2 s"))
SPREAD = {"scale": ("lognormal", 1.5, 0.4), "gravity": ("uniform", "9 m/s^2", "10 m/s^2")}
CORRELATED = tuple(
    {"spread": SPREAD, "correlation": {("scale", "gravity"): size}} for size in (0.2, 0.8)
)
LINES = {"scale": [0.5, 2.0], "bracket_width": 0.05}
LINES_CHANGES = {
    "scale": [0.5, 2.5],
    "bracket_width": 0.02,
    "resolution": 0.1,
    "intensity": "PGV",
    "period": SPECTRAL,
}
ANALYSES = {
    "incremental_dynamic_analysis": (
        {"system": SYSTEM, "motions": MOTIONS, **LINES, "intensity": "PGA"},
        {**RUN, **LINES_CHANGES, "system": OTHER, "motions": REVERSED, "limits": ["uplift", 0.5],
         "axes": {"height": ["1 m", "2 m"]},
         "more_axes": ({"width": ["0.5 m"]}, {"width": ["0.6 m"]}),
         "points": {"top": ("0 m", "2 m")}, "outputs": ["rotation"],
         "output_step": ({"outputs": ["rotation"]},
                         {"outputs": ["rotation"], "output_step": "0.02 s"})},
    ),
    "overturning_map": (
        {"system": SYSTEM, "pulse": rf.GroundMotion.sine_pulse, "amplitude": ([2, 4, 8], "m/s^2"),
         "frequency": ([0.8, 10], "Hz"), "bracket_width": 0.05, "overturning": "stop"},
        {**RUN, "system": OTHER, "pulse": rf.GroundMotion.cosine_pulse, "bracket_width": 0.02,
         "amplitude": ([2, 4, 9], "m/s^2"), "frequency": ([0.8, 2], "Hz"), "impacts": 1},
    ),
    "rocking_spectrum": (SIZES, {**RUN, **SIZES_CHANGES}),
    "overturning_spectrum": ({**SIZES, **LINES}, {**RUN, **SIZES_CHANGES, **LINES_CHANGES}),
    "probability_of_overturning": (
        {"system": SYSTEM, "motions": MOTIONS, "spread": {"scale": ("lognormal", 1.5, 0.4)},
         "cases": 24},
        {**RUN, "system": OTHER, "motions": REVERSED, "spread": {"scale": ("lognormal", 1.6, 0.4)},
         "correlation": CORRELATED, "cases": 25, "sampling": "random",
         "seed": 1, "confidence": 0.9},
    ),
    "subset_simulation": (
        {"system": SYSTEM, "motions": MOTIONS, "spread": {"scale": ("lognormal", 0.9, 0.2)},
         "cases": 60, "levels": 2},
        {**RUN, "system": OTHER, "motions": REVERSED, "spread": {"scale": ("lognormal", 0.8, 0.2)},
         "correlation": CORRELATED, "limit": 0.5, "cases": 61, "share": 0.2, "levels": 3,
         "seed": 1, "confidence": 0.9, "points": {"top": ("0 m", "2 m")}},
    ),
    "earthquake_sequences": (
        {"system": SYSTEM, "sequences": {"zwei": [WEAK, STRONG], "1": [STRONG]}, "pause": "1 s"},
        {**{name: RUN[name] for name in SEQUENCE}, "system": OTHER, "pause": "2 s",
         "sequences": {"1": [STRONG], "zwei": [WEAK, STRONG]}},
    ),
}  # fmt: skip


FULLY_TESTED = ("overturning_map", "probability_of_overturning", "earthquake_sequences")
"""Analyses whose arguments of runs are all changed in the short tests."""


def arguments_of(name):
    return set(inspect.signature(getattr(rf, name)).parameters)


def test_every_study_argument_is_covered_by_these_tests():
    # tests/unit/studies/test_known_cases.py covers arguments that keep the numbers
    assert set(SWEEP_CHANGES) | set(NEUTRAL) | {"known"} == arguments_of("sweep")
    for name, (_, changes) in ANALYSES.items():
        assert set(changes) | set(NEUTRAL) == arguments_of(name), name


def before_and_after(base, name, change):
    """Return the arguments of an analysis before and after a change."""
    before, after = change if isinstance(change, tuple) and len(change) == 2 and all(
        isinstance(one, dict) for one in change
    ) else ({}, {name: change})  # fmt: skip
    return tuple(
        {key: value for key, value in {**base, **more}.items() if value is not None}
        for more in (before, after)
    )


@pytest.mark.parametrize("name", SWEEP_CHANGES)
def test_changed_sweep_argument_is_refused_by_its_store(name, tmp_path):
    before, after = before_and_after(SWEPT, name, SWEEP_CHANGES[name])
    rf.sweep(**before, store=tmp_path / "study")
    with pytest.raises(StudyError, match=r"found another study, which differs in \w+.* known='"):
        rf.sweep(**after, store=tmp_path / "study")


def test_execution_options_do_not_change_the_study(tmp_path):
    from concurrent.futures import ThreadPoolExecutor

    plain = rf.sweep(**SWEPT)
    with ThreadPoolExecutor(1) as pool:
        for changes in ({"chunk": 1}, {"executor": pool}, {"progress": False}, {}):
            assert_identical(rf.sweep(**SWEPT, **changes, store=tmp_path / "study"), plain)


@pytest.fixture(scope="module")
def started_store(tmp_path_factory):
    """Return a function that creates the store of an analysis, each only once."""
    made = {}

    def store(name, arguments, into):
        key = name, repr(sorted(arguments.items(), key=lambda one: one[0]))
        if key not in made:
            made[key] = tmp_path_factory.mktemp("store") / "study"
            getattr(rf, name)(**arguments, store=made[key])
        shutil.copytree(made[key], into)

    return store


@pytest.mark.parametrize(
    ("analysis", "name"),
    [
        # arguments that all analyses pass to runs are read in one place
        pytest.param(
            one, name, marks=[pytest.mark.long] * (name in RUN and one not in FULLY_TESTED)
        )
        for one, (_, changes) in ANALYSES.items()
        for name in changes
    ],
)
def test_store_never_returns_results_of_other_arguments(analysis, name, started_store, tmp_path):
    base, changes = ANALYSES[analysis]
    before, after = before_and_after({"accuracy": "fast", **base}, name, changes[name])
    started_store(analysis, before, tmp_path / "study")
    try:
        stored = getattr(rf, analysis)(**after, store=tmp_path / "study")
    except StudyError as problem:
        assert "found another study, which differs in" in str(problem)  # noqa: PT017
    else:
        assert_identical(stored, getattr(rf, analysis)(**after))


# descriptions ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Arguments:
    size: float
    words: tuple[str, ...]
    further: object = None


def test_description_covers_all_fields_and_refuses_unknown_objects():
    one = Arguments(1.0, ("a", "b"))
    others = [
        replace(one, size=np.nextafter(1.0, 2.0)), replace(one, words=("b", "a")),
        *(replace(one, further=each) for each in (
            0, False, 0.0, "0", (), (0,), {"a": 1, "b": 2}, {"b": 2, "a": 1}, np.zeros(2),
            np.zeros(3), np.zeros((1, 2)), np.zeros(2, dtype=np.float32), np.array(["a", "b"]),
            np.array(["ab", ""]), WEAK, STRONG, SYSTEM.parts.block, RUN["initial"], one,
            assert_identical,
        )),
    ]  # fmt: skip
    digests = [digest_of(description_of(each)) for each in (one, *others)]
    assert len(set(digests)) == len(digests)
    assert digest_of(description_of(Arguments(1.0, ("a", "b")))) == digests[0]
    for unknown in (object(), {1, 2}, Arguments(1.0, (), object()), {"a": object()}):
        with pytest.raises(StudyError, match="cannot be recognised in another process"):
            description_of(unknown)


def studied(**changes):
    return plan_study(SYSTEM, MOTIONS, {"scale": [1.0]}, None, outputs=["rotation"], **changes)


def test_description_of_a_study_covers_nested_fields():
    seen = []

    def walked(value, described):
        if is_dataclass(value):
            seen.append(type(value).__name__)
            for one in fields(value):
                if one.compare:
                    walked(getattr(value, one.name), described[one.name])

    study = studied()
    walked(study, study.to_dict())
    assert {"Study", "SystemScene", "Assembly", "Parts", "Options", "Grid", "RunRequest",
            "Accuracy", "Histories"} <= set(seen)  # fmt: skip
    assert not [name for name in seen if name.startswith("_")]
    # further fields of a job do not change numbers: two follow from the grid, names of restrainers
    # from the scenes; with lanes or without, cases are equal bit for bit
    derived = {"axes", "motion_of_case", "compile_timeout", "restrainers"}
    described = {one.name for one in fields(Study)} | derived
    assert {one.name for one in fields(SweepJob)} <= described


def test_digest_depends_on_motion_samples():
    si = WEAK.si
    other = replace(si.horizontal, samples=si.horizontal.samples * 1.0000001)
    longer = replace(si.horizontal, time_step=2 * si.time_step)
    straight = replace(si.horizontal, polynomials=None)
    upwards = replace(si.horizontal, name="vertical")
    changed = [replace(si, horizontal=one) for one in (other, longer, straight)]
    changed.append(replace(si, vertical=upwards))
    assert len({digest_of(description_of(rf.GroundMotion(one))) for one in (si, *changed)}) == 5


def test_digest_depends_on_closure_of_a_function():
    def scene_with(density):
        def scene(height):
            return rf.System(rf.Block(width="0.5 m", height=height, mass=f"{density} kg"))

        return scene

    def digest(function):
        return plan_study(function, MOTIONS, {"height": ["1 m", "2 m"]}, None).digest

    assert digest(scene_with(400)) == digest(scene_with(400))
    assert digest(scene_with(400)) != digest(scene_with(401))


ARGUMENTS = {"frequency_ratio": 15, "damping_ratio": 0.05, "strength": 0.6, "hardening": 0.1}


def test_description_of_a_part_has_no_source_of_python_itself():
    """It took seconds to read, and another Python would have refused the store."""
    for part in (rf.Block(width="1 m", height="4 m", mass="1 t"), rf.RigidGround()):
        assert set(description_of(part)) == {*part.to_dict(), "given"}


def test_digest_depends_on_code_of_a_user_defined_base(tmp_path):
    def digest(module):
        _source_of_class.cache_clear()
        pads = module.YieldingPads(**ARGUMENTS)
        return digest_of(description_of(pads))

    with example() as module:
        plain = digest(module)
        assert digest(module) == plain
        changed = tmp_path / "changed.py"
        changed.write_text("def helper():\n    return 1\n")
        code = compile(changed.read_text(), str(changed), "exec")
        exec(code, vars(module))  # noqa: S102
        assert digest(module) != plain
        del module.helper
        assert digest(module) == plain
        module.CONSTANT = 0.1
        assert digest(module) != plain
        del module.CONSTANT
    _source_of_class.cache_clear()
