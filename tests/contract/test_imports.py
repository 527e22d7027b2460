"""Imports load no more modules than a script needs."""

import inspect
import subprocess
import sys

import pytest

import rockframe as rf
from rockframe import deprecated
from rockframe.errors import RockframeError, RockframeWarning

pytestmark = pytest.mark.contract

NEEDED_BY_FEW = {"numba", "llvmlite", "matplotlib", "scipy.signal", "scipy.special", "netCDF4"}
HEAVY = (*NEEDED_BY_FEW, "xarray", "pandas", "pint")


def loaded(*codes):
    """Run codes in one fresh interpreter; return the heavy modules loaded after each."""
    names = (*HEAVY, "matplotlib.pyplot")
    report = f"import sys; print(*[name for name in {names} if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(f"{code}\n{report}" for code in codes)],
        capture_output=True, text=True, timeout=240,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == len(codes)
    return [set(line.split()) for line in lines]


@pytest.fixture(scope="module")
def needed():
    """Return the modules that pint and xarray load, which are always needed."""
    return loaded("import pint, xarray")[0]


COMMAND_LINE = """
import sys
sys.argv = ["/somewhere/bin/rockframe", *{words}]
from rockframe.command.main import main
assert main() == 0
print("LOADED", *sys.modules)
"""
LOOKING_AROUND = "assert 'System' in dir(rockframe)\nrockframe.__version__"
NAMING_ALL = """
for name in rockframe.__all__:
    if name != "plot":
        getattr(rockframe, name)
"""
READING = """
import rockframe as rf
motion = rf.GroundMotion.read({file!r}, unit="m/s^2")
assert len(motion) == 50
"""
DESCRIBING = """
block = rf.Block(width="2 m", height="8 m", mass="50 t")
text = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)).describe()
assert "two-spring" in text
"""


def test_only_needed_libraries_are_imported(needed, tmp_path):
    """In sequence: what is not loaded after the last code was not loaded by any before it."""
    file = tmp_path / "record.txt"
    file.write_text("\n".join(f"{0.01 * i:.2f} {0.1 * (i % 3)}" for i in range(50)))
    imported, accessed, *others = loaded(
        "import rockframe",
        LOOKING_AROUND,
        NAMING_ALL,
        READING.format(file=str(file)),
        DESCRIBING,
        "rf.plot",
    )
    assert not NEEDED_BY_FEW & needed
    assert imported == needed
    assert accessed == needed
    for after in others:
        assert not NEEDED_BY_FEW & after


@pytest.mark.parametrize("words", [["run", "--help"], ["completion", "zsh"], ["--version"]])
def test_help_and_completion_load_no_library(words):
    done = subprocess.run(
        [sys.executable, "-c", COMMAND_LINE.format(words=words)],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not {*HEAVY, "numpy", "scipy"} & set(done.stdout.split("LOADED")[1].split())
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "rockframe", *words],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0
    newly_loaded = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "argparse" in newly_loaded
    assert not {*HEAVY, "numpy", "scipy"} & newly_loaded


@pytest.mark.parametrize(
    ("name", "words", "first"),
    [
        ("probe.py", ["-m", "rockframe"], "import rockframe"),
        pytest.param("rockframe.study.py", [], "import rockframe", marks=pytest.mark.long),
        pytest.param("rockframe", [], "from rockframe import Block", marks=pytest.mark.long),
    ],
)
def test_accessor_is_registered_for_any_script_name(name, words, first, tmp_path):
    script = tmp_path / name
    script.write_text(f"{first}\nimport xarray\nassert hasattr(xarray.Dataset, 'rockframe')")
    done = subprocess.run(
        [sys.executable, str(script), *words], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr


def test_simulation_imports_numba_only_to_compile():
    code = """
import rockframe as rf
block = rf.Block(width="2 m", height="8 m", mass="50 t")
response = rf.System(block).simulate(rf.GroundMotion.sine_pulse())
response.to_netcdf
"""
    assert not (NEEDED_BY_FEW - {"numba", "llvmlite"}) & loaded(code)[0]
    plain = "import os\nos.environ['ROCKFRAME_COMPILE'] = '0'"
    assert not NEEDED_BY_FEW & loaded(plain + code)[0]


def test_all_public_names_exist():
    expected = {
        "Accuracy",
        "Block",
        "GroundMotion",
        "InitialState",
        "System",
        "TwoSpringSupport",
        "errors",
        "export",
        "plot",
    }
    assert expected <= set(rf.__all__)
    assert len(set(rf.__all__)) == len(rf.__all__)
    for name in rf.__all__:
        assert getattr(rf, name) is not None
    with pytest.raises(AttributeError, match="Sytem"):
        rf.Sytem  # noqa: B018


def test_dir_lists_only_public_names():
    figures = {"motion", "response", "selection", "spectra", "tradeoff", "fragility"}
    assert figures <= set(dir(rf.plot))
    assert not [name for name in dir(rf.plot) if name.startswith("_")]
    assert all(callable(getattr(rf.plot, name)) for name in dir(rf.plot))
    assert all(name.endswith(("Error", "Warning")) for name in dir(rf.errors))
    assert not set(rf.__all__) & set(dir(rf.errors))
    assert "Block" in dir(rf.components)
    public = set(dir(rf.System(rf.Block(width="1 m", height="3 m", mass="1 t"))))
    assert {"simulate", "describe", "parts"} <= public
    assert not {"assembly", "scene", "setting"} & public


def test_moved_names_warn_as_deprecated():
    with pytest.warns(DeprecationWarning, match=r"AssemblyError is now rockframe\.errors"):
        assert rf.AssemblyError is rf.errors.AssemblyError
    with pytest.warns(DeprecationWarning, match=r"Case is now rockframe\.studies\.Sweep"):
        from rockframe import Case
    assert inspect.isclass(Case)
    suite = {"one": rf.GroundMotion.stochastic(6, "20 km", seed=1)}
    target = rf.TargetSpectrum.eurocode_8("0.1 g_0")
    for name, arguments, new in (
        ("scale_to_target", (suite, target), rf.MotionSuite(suite).scaling_to(target)),
        ("select_for_target", (suite, target, 1), rf.MotionSuite(suite).selection_for(target, 1)),
        ("fragility_of_counts", (COUNTS["intensity"], [0, 2, 5], 5), rf.fragility(COUNTS)),
    ):
        with pytest.warns(DeprecationWarning, match=rf"rockframe\.{name} is now rockframe\."):
            old = getattr(rf, name)
        assert old(*arguments).drop_attrs().identical(new.drop_attrs())
    for name in deprecated.MOVED:
        with pytest.warns(DeprecationWarning, match=rf"rockframe\.{name} is now rockframe\."):
            assert callable(getattr(rf, name))


COUNTS = {"intensity": ([1.0, 2.0, 3.0], "m/s^2"), "exceeded": [0, 2, 5], "trials": 5}


def test_errors_share_one_base_class():
    family = {name: getattr(rf.errors, name) for name in dir(rf.errors)}
    for name, one in family.items():
        base = RockframeWarning if name.endswith("Warning") else RockframeError
        assert issubclass(one, base)
    assert issubclass(RockframeWarning, UserWarning)


WITHOUT = """
import sys, threading
for name in ("numba", "llvmlite", "netCDF4", "tqdm", "_multiprocessing"):
    sys.modules[name] = None  # an import of it fails, as where it is not installed

def start(self):
    raise RuntimeError("can't start new thread")

threading.Thread.start = start
import rockframe as rf
system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
pulse = rf.GroundMotion.sine_pulse("-5 m/s^2", "2 Hz")
run = system.simulate(pulse, free_vibration="0.1 s", accuracy="fast", second_look=False)
runs = rf.sweep(system, pulse, scale=[0.5, 1.0], free_vibration="0.1 s", accuracy="fast")
assert runs.peak_rotation.values[1] == run.peak_rotation.item() > 0.0
assert len(rf.response_spectrum(pulse, ([0.5], "s")).period) == 1
"""


def test_runs_without_threads_and_compiled_libraries():
    """As in a browser, where these modules are missing and no thread can be started."""
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT], capture_output=True, text=True, timeout=240
    )
    assert done.returncode == 0, done.stderr
