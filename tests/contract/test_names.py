"""Names of classes and functions are unique in the package."""

import ast
from collections import defaultdict
from pathlib import Path

import rockframe as rf
from rockframe import plot

PACKAGE = Path(rf.__file__).parent
SHARED_FUNCTIONS = {
    # the same function for several kinds
    "solve_motion",  # equations of several bodies
    "matched",  # a motion, and a suite
    # established public names
    "register", "table",
    # a figure, and the function whose result it shows
    "moment_rotation", "velocity_pulse",
}  # fmt: skip


def test_class_and_function_names_are_unique():
    places = {ast.ClassDef: defaultdict(list), ast.FunctionDef: defaultdict(list)}
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            # functions of balls have the names of functions of numbers
            of_balls = type(node) is ast.FunctionDef and PACKAGE / "proof" in path.parents
            if type(node) in places and not node.name.startswith("_") and not of_balls:
                places[type(node)][node.name].append(str(path.relative_to(PACKAGE)))
    figures = set(plot.__all__) & set(rf.__all__)
    for kind, shared in (
        (ast.ClassDef, set()), (ast.FunctionDef, SHARED_FUNCTIONS | figures)
    ):  # fmt: skip
        several = {name: files for name, files in places[kind].items() if len(files) > 1}
        doubled = {name: files for name, files in several.items() if name not in shared}
        assert not doubled, f"give one of each another name: {doubled}"
        assert shared - figures <= set(several), "names that occur at most once"
