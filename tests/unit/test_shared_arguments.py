"""Arguments shared by several functions: signatures, docstrings and refusals."""

import inspect
import pickle
from typing import Annotated, TypedDict, Unpack, get_type_hints

import pytest

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.shared_arguments import (
    Argument,
    declared_arguments,
    with_documented_arguments,
    with_shared_arguments,
)
from rockframe.simulation.run_arguments import ComparedArguments, RunArguments, ScaleArguments
from rockframe.studies.sweeps.arguments import (
    SWEEP_ARGUMENT_NAMES,
    SequenceArguments,
    SweepArguments,
)

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
PULSE = rf.GroundMotion.half_sine_pulse("1 m/s^2", "0.5 s")

LENGTH = ["duration", "free_vibration"]
COURSE = ["initial", "accuracy", "overturning"]
EXECUTION = ["store", "executor", "chunk", "progress"]
TAKEN = {
    rf.rocking_spectrum: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.overturning_spectrum: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.incremental_dynamic_analysis: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.overturning_map: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.probability_of_overturning: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.subset_simulation: (SweepArguments, [*LENGTH, *COURSE, *EXECUTION]),
    rf.earthquake_sequences: (SequenceArguments, [*COURSE, *EXECUTION]),
    rf.critical_scale: (ScaleArguments, [*LENGTH, *COURSE]),
    rf.tradeoff: (ComparedArguments, [*LENGTH, "initial", "output_step"]),
}
DEFAULTS = {"accuracy": "standard", "overturning": "stop"}


class Some(TypedDict, total=False):
    depth: Annotated[float, Argument(2.0, "float, optional", "How deep it is [m].")]
    colour: Annotated[str | None, Argument(None, "str, optional", "Of the rock.")]


@with_shared_arguments(Some, colour="grey")
def pit(width: float, *, roof: bool = False, **more: Unpack[Some]) -> dict[str, object]:
    """Dig.

    Parameters
    ----------
    width : float
        How wide [m].
    roof : bool, optional
        Whether there is one.

    Returns
    -------
    dict
    """
    return {"width": width, "roof": roof, **more}


def test_decorated_function_documents_all_arguments():
    assert str(inspect.signature(pit)) == (
        "(width: float, *, roof: bool = False, depth=2.0, colour='grey') -> dict[str, object]"
    )
    assert inspect.getdoc(pit) == (
        "Dig.\n\nParameters\n----------\n"
        "width : float\n    How wide [m].\n"
        "roof : bool, optional\n    Whether there is one.\n"
        "depth : float, optional\n    How deep it is [m].\n"
        "colour : str, optional\n    Of the rock.\n"
        "\nReturns\n-------\ndict"
    )
    assert pit(1.0) == {"width": 1.0, "roof": False, "colour": "grey"}
    assert pit(1.0, colour=None, depth=3.0)["colour"] is None
    with pytest.raises(
        TypeError, match=r"^pit\(\) takes no 'dept'; was 'depth' meant\? It takes w"
    ):
        pit(1.0, dept=3.0)
    with pytest.raises(TypeError, match=r"takes no 'x'\. It takes width, roof, depth, colour$"):
        pit(1.0, x=3.0)
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'width'"):
        pit()


def test_existing_docstring_rows_are_preserved_in_signature_order():
    def dug(depth=2.0, colour=None, *others):
        """Dig.

        Parameters
        ----------
        colour : str
            Its own words.
        *others
            More.
        """

    text = inspect.getdoc(with_documented_arguments(Some)(dug))
    rows = text.split("----------\n")[1].splitlines()
    assert rows[::2] == ["depth : float, optional", "colour : str", "*others"]
    assert rows[3] == "    Its own words."

    def bare(depth=2.0):
        pass

    assert with_documented_arguments(Some)(bare).__doc__ == ""


WITH_AXES = (rf.incremental_dynamic_analysis, rf.rocking_spectrum, rf.overturning_spectrum)


@pytest.mark.parametrize("function", TAKEN, ids=lambda one: one.__name__)
def test_analyses_have_the_shared_argument_names_and_defaults(function):
    kind, names = TAKEN[function]
    declared = declared_arguments(kind)
    assert list(declared) == names
    own = inspect.signature(function).parameters
    further = [one.name for one in own.values() if one.kind is one.VAR_KEYWORD]
    assert further == (["more_axes"] if function in WITH_AXES else [])
    for name in names:
        usual = DEFAULTS.get(name)
        if function is rf.overturning_map and name == "overturning":
            usual = "continue"
        assert own[name].kind is inspect.Parameter.KEYWORD_ONLY
        assert own[name].default == usual
        assert f"\n{name} : " in inspect.getdoc(function)
        assert declared[name].description[-1] in ".]"
    refused = (
        (StudyError, "'acuracies' names no parameter; was 'accuracy' meant")
        if further  # any other name may be that of an axis
        else (TypeError, rf"{function.__name__}\(\) takes no 'acuracies'")
    )
    needed = {"periods": ([2.0], "s"), "scale": [1.0, 2.0]} if further else {}
    needed = {name: one for name, one in needed.items() if name in own}
    with pytest.raises(refused[0], match=refused[1]):
        function(SYSTEM, **needed, acuracies="fast")
    assert pickle.loads(pickle.dumps(function)) is function  # noqa: S301


def test_sweep_and_simulate_signatures_match_declarations():
    """Both list their arguments explicitly: one takes any further name, the other any outputs."""
    of_sweep = inspect.signature(rf.sweep).parameters
    for name, one in declared_arguments(SweepArguments).items():
        assert of_sweep[name].default == one.default
    assert set(SWEEP_ARGUMENT_NAMES) < set(of_sweep)
    run_arguments = inspect.signature(rf.System.simulate).parameters
    only_of_runs = {"self", "motion", "certify", "second_look"}
    assert set(get_type_hints(RunArguments)) == set(run_arguments) - only_of_runs
    assert all(run_arguments[name].default == DEFAULTS.get(name) for name in (*LENGTH, *COURSE))


def test_a_misspelt_argument_of_a_sweep_is_no_axis():
    with pytest.raises(StudyError, match="'acuracy' names no parameter; was 'accuracy' meant"):
        rf.sweep(SYSTEM, PULSE, acuracy=["fast"])
    with pytest.raises(StudyError, match="argument 'duraton'; was 'duration' meant"):
        rf.sweep(lambda width: SYSTEM, PULSE, width=[1.0], duraton="3 s")


def test_shared_argument_values_are_checked_by_all_analyses():
    for wrong, words in (
        ({"duration": "3 kg"}, "duration needs a time in a unit such as s"),
        ({"overturning": "halt"}, "overturning"),
        ({"accuracy": "exact"}, "accuracy"),
    ):
        for function, arguments in (
            (rf.rocking_spectrum, {"periods": ([2.0], "s")}),
            (rf.overturning_spectrum, {"periods": ([2.0], "s"), "scale": [1.0, 2.0]}),
            (rf.sweep, {"scale": [1.0]}),
        ):
            with pytest.raises(StudyError, match=words):
                function(SYSTEM, PULSE, **arguments, **wrong)
    with pytest.raises(StudyError, match="duration or free_vibration, not both"):
        rf.rocking_spectrum(
            SYSTEM, PULSE, periods=([2.0], "s"), duration="3 s", free_vibration="1 s"
        )


def test_width_argument_is_refused_in_favour_of_bracket_width():
    for analysis in (rf.critical_scale, rf.overturning_map):
        with pytest.raises(TypeError, match="the width of a bracket is 'bracket_width'"):
            analysis(width=0.01)
