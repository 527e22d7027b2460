"""What is loaded when: no more than a script asks for, beside what all of them need."""

import subprocess
import sys

import pytest

import rockframe as rf

pytestmark = pytest.mark.contract

NEEDED_BY_FEW = {"numba", "llvmlite", "matplotlib", "scipy.signal", "scipy.special", "netCDF4"}
HEAVY = (*NEEDED_BY_FEW, "xarray", "pandas", "pint")


def loaded(code):
    """Run code in a fresh interpreter and give the heavy modules it has loaded."""
    report = f"import sys; print(*[m for m in {(*HEAVY, 'matplotlib.pyplot')} if m in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, timeout=240
    )
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split())


@pytest.fixture(scope="module")
def needed():
    """What pint and xarray load, without which there are no units and no results."""
    return loaded("import pint, xarray")


def test_importing_loads_what_every_scene_needs_and_no_more(needed):
    assert not NEEDED_BY_FEW & needed
    assert loaded("import rockframe") == needed


def test_looking_around_loads_no_more(needed):
    code = "import rockframe\nassert 'System' in dir(rockframe)\nrockframe.__version__"
    assert loaded(code) == needed


def test_naming_everything_loads_neither_numba_nor_a_plot():
    code = """
import rockframe
for name in rockframe.__all__:
    if name != "plot":
        getattr(rockframe, name)
"""
    assert not NEEDED_BY_FEW & loaded(code)


def test_reading_a_record_loads_no_compiler_nor_a_plot(tmp_path):
    file = tmp_path / "record.txt"
    file.write_text("\n".join(f"{0.01 * i:.2f} {0.1 * (i % 3)}" for i in range(50)))
    code = f"""
import rockframe as rf
motion = rf.GroundMotion.read({str(file)!r}, unit="m/s^2")
assert len(motion) == 50
"""
    assert not NEEDED_BY_FEW & loaded(code)


def test_describing_a_system_loads_neither_numba_nor_a_plot():
    code = """
import rockframe as rf
block = rf.Block(width="2 m", height="8 m", mass="50 t")
text = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)).describe()
assert "two-spring" in text
"""
    assert not NEEDED_BY_FEW & loaded(code)


def test_simulating_loads_a_compiler_only_to_compile_and_no_plot():
    code = """
import rockframe as rf
block = rf.Block(width="2 m", height="8 m", mass="50 t")
response = rf.System(block).simulate(rf.GroundMotion.sine_pulse())
response.to_netcdf
"""
    assert not (NEEDED_BY_FEW - {"numba", "llvmlite"}) & loaded(code)
    plain = "import os\nos.environ['ROCKFRAME_COMPILE'] = '0'"
    assert not NEEDED_BY_FEW & loaded(plain + code)


def test_plotting_does_not_need_a_screen_nor_pyplot_at_import():
    assert "matplotlib" not in loaded("import rockframe as rf\nrf.plot")


def test_all_names_are_there():
    expected = {
        "Accuracy",
        "AssemblyError",
        "Block",
        "ComponentError",
        "GroundMotion",
        "InitialState",
        "ModelWarning",
        "RecordError",
        "RockframeError",
        "SchemaError",
        "SolverError",
        "System",
        "TwoSpringSupport",
        "UnitsError",
        "plot",
    }
    assert expected <= set(rf.__all__)
    assert len(set(rf.__all__)) == len(rf.__all__)
    for name in rf.__all__:
        assert getattr(rf, name) is not None
    with pytest.raises(AttributeError, match="Sytem"):
        rf.Sytem  # noqa: B018


def test_only_what_is_meant_for_users_is_shown():
    assert dir(rf.plot) == ["motion", "response", "spectra", "tradeoff"]
    assert all(callable(getattr(rf.plot, name)) for name in dir(rf.plot))
    assert {name for name in rf.__all__ if name.endswith(("Error", "Warning"))} == set(
        dir(rf.errors)
    )
    assert all(getattr(rf, name) is getattr(rf.errors, name) for name in dir(rf.errors))
    assert "Block" in dir(rf.components)


def test_errors_form_one_family():
    for name in ("Units", "Component", "Assembly", "Record", "Solver", "Schema"):
        error = getattr(rf, f"{name}Error")
        assert issubclass(error, rf.RockframeError)
        assert error is not rf.RockframeError
    for name in ("Model", "Record", "Solver"):
        warning = getattr(rf, f"{name}Warning")
        assert issubclass(warning, rf.RockframeWarning)
        assert issubclass(warning, UserWarning)
