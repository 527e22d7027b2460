"""Scenes and studies in TOML: systems built from them, and lines of errors."""

import re
import tomllib

import numpy as np
import pytest

import rockframe as rf
from rockframe.command.files.parts import classes_in, inner_parts, part_slots, toml_tables
from rockframe.command.files.scenes import read_scene
from rockframe.command.files.studies import read_study
from rockframe.command.files.tables import in_toml, lines_of
from rockframe.command.files.templates import TEMPLATES, all_keys_template
from rockframe.errors import FileError, StudyError

pytestmark = pytest.mark.unit

BLOCK = '[block]\nwidth = "1 m"\nheight = "4 m"\nmass = "5 t"\n'
OWN = """
from rockframe.components import TwoSpringSupport

class SoftPads(TwoSpringSupport):
    pass
"""


@pytest.fixture
def file(tmp_path):
    def write(text, name="scene.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def faults(read, path):
    """Return the errors of a file, as messages by line."""
    with pytest.raises(FileError) as caught:
        read(path)
    for line, words in caught.value.faults:
        place = "" if line is None else f", line {line}"
        assert f"{path}{place}: {words}" in str(caught.value)
    return dict(caught.value.faults)


def test_line_numbers_of_keys_and_tables_are_found():
    text = """# a comment with [a.table] = "in it"
top = 1
"quoted key" = '''
[no.header]
not = "a key"
'''

[one]   # a comment
first = [
  "a", # ]
  "b",
]
second.inner = { x = 1,
  y = 2 }

[[many]]
x = 1
[many.below]
y = 2
[[many]]
x = "]["
[ one . deeper ]
z = 0
"""
    text = text.replace("x = 1,\n  y = 2 }", "x = 1, y = 2 }")  # TOML 1.0 requires it on one line
    assert lines_of(text) == {
        ("top",): 2,
        ("quoted key",): 3,
        ("one",): 8,
        ("one", "first"): 9,
        ("one", "second"): 13,
        ("one", "second", "inner"): 13,
        ("many",): 15,
        ("many", 0): 15,
        ("many", 0, "x"): 16,
        ("many", 0, "below"): 17,
        ("many", 0, "below", "y"): 18,
        ("many", 1): 19,
        ("many", 1, "x"): 20,
        ("one", "deeper"): 21,
        ("one", "deeper", "z"): 22,
    }


def test_scene_file_builds_the_same_system_as_python(file):
    (file(OWN, "soft.py"))
    path = file(
        """
modules = ["soft.py"]
[block]
type = "FrameEquivalent"
constructor = "from_members"
storeys = 2
width = "4 m"
height = "6 m"
column_width = "0.25 m"
beam_height = "0.3 m"
beam_width = "0.25 m"
density = "2500 kg/m^3"
[pads]
type = "SoftPads"
stiffness = "12 MN/m"
damping_ratio = "5 %"
[cap]
height = "0.9 m"
mass = "36 t"
[soil]
constructor = "from_subgrade_modulus"
modulus = "20 MN/m^3"
depth = "4 m"
damping_ratio = 0.2
[system]
coupling = "cascade"
gravity = "9.81 m/s^2"
[motion]
constructor = "sine_pulse"
amplitude = "-3 m/s^2"
frequency = "0.5 Hz"
operations = [{ scaled = { factor = 1.5 } }, { resampled = { time_step = "0.01 s" } }]
[run]
free_vibration = "2 s"
outputs = ["energy"]
points = { roof = ["0 m", "6 m"] }
[run.initial]
rotation = "0.001 rad"
[run.accuracy]
rtol = 1e-6
"""
    )
    scene = read_scene(path)
    frame = rf.FrameEquivalent.from_members(
        storeys=2, width="4 m", height="6 m", column_width="0.25 m", beam_height="0.3 m",
        beam_width="0.25 m", density="2500 kg/m^3",
    )  # fmt: skip
    pads = type(scene.system.parts.pads)(stiffness="12 MN/m", damping_ratio=0.05)
    assert issubclass(type(pads), rf.TwoSpringSupport)
    cap = rf.CushionCap(height="0.9 m", mass="36 t")
    soil = rf.WinklerSoil(stiffness="80 MPa", damping_ratio=0.2)
    assert scene.system == rf.System(
        frame, pads, cap, soil, coupling="cascade", gravity="9.81 m/s^2"
    )
    pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", "0.5 Hz").scaled(1.5).resampled("0.01 s")
    assert scene.motion == pulse
    assert scene.run["initial"] == rf.InitialState(rotation="0.001 rad")
    assert scene.run["accuracy"] == rf.Accuracy(rtol=1e-6)
    assert scene.run["outputs"] == ["energy"]


def test_relative_paths_are_resolved_from_the_scene_file(file, tmp_path, monkeypatch):
    (tmp_path / "records").mkdir()
    for name, peak in (("a", "-3 m/s^2"), ("b", "-2 m/s^2")):
        rf.GroundMotion.sine_pulse(peak).to_at2(tmp_path / "records" / f"{name}.AT2")
    path = file(
        f'{BLOCK}[motion]\nfile = "records/a.AT2"\noperations = [{{scaled = {{factor = 2}}}}]'
    )
    monkeypatch.chdir("/")
    motion = read_scene(path).motion
    assert motion.peak_acceleration.m_as("m/s^2") == pytest.approx(6.0, rel=1e-3)
    study = read_study(
        file(
            'scene = "scene.toml"\nmotions = ["records/*.AT2"]\nstore = "kept"\n'
            '[axes]\nscale = [1, 2]\nwidth = { values = [1, 2], unit = "m" }\n'
            '"System.gravity" = ["9 m/s^2"]\n[sweep]\naccuracy = "fast"\n',
            "study.toml",
        )
    )
    assert list(study.motions) == ["a", "b"]
    assert study.store == tmp_path / "kept"
    assert study.arguments["axes"] == {
        "scale": [1, 2], "width": ([1, 2], "m"), "System.gravity": ["9 m/s^2"],
    }  # fmt: skip
    assert study.arguments["accuracy"] == "fast"


SCENES = {
    "no TOML": ("[block]\nwidth = 1 m\n", {2: "this is no TOML"}),
    "no unit": (BLOCK.replace('"1 m"', "1.0"), {2: "width needs a length with a unit"}),
    "another unit": (BLOCK.replace('"5 t"', '"5 m"'), {4: "mass needs a mass"}),
    "out of range": (BLOCK.replace('"1 m"', '"-1 m"'), {2: "greater than zero"}),
    "a slip": (BLOCK.replace("width", "widht"), {1: "lacks 'width'", 2: "was 'width' meant?"}),
    "a missing key": (BLOCK.replace('mass = "5 t"', ""), {1: 'mass = "99 t"'}),
    "an unknown table": (f"{BLOCK}[sol]\n", {5: "was 'soil' meant?"}),
    "a table by its class": (f"{BLOCK}[WinklerSoil]\n", {5: 'written [soil] with type = "Winkler'}),
    "a table by its class in small letters": (
        f"{BLOCK}[two_spring_support]\n",
        {5: 'written [pads] with type = "TwoSpringSupport"'},
    ),
    "a block that slides": (
        f'{BLOCK}[ground]\nfriction = 0.5\n[system]\nrotation = "small"\n',
        {8: 'with rotation = "finite" only; give sliding = "checked"'},
    ),
    "a squat block": (BLOCK.replace('"1 m"', '"90 m"'), {None: "On [ground] with friction = ..."}),
    "a point": (
        f'{BLOCK}[restrainer]\ntype = "Load"\nat = "3 m"\nvertical = "1 kN"\n',
        {7: 'a point such as ["-0.5 m", "3 m"], to'},
    ),
    "points": (
        '[block]\nconstructor = "from_outline"\npoints = [[0, 0], [1, 0], [1, 2]]\n'
        'density = "1 kg/m^3"\ndepth = "1 m"\n',
        {3: 'such as [["0 m", "0 m"], ["1 m", "0 m"], ...]'},
    ),
    "a sloping outline": (
        '[block]\nconstructor = "from_outline"\npoints = [[0, 0], [1, 0.1], [1, 2]]\n'
        'unit = "m"\ndensity = "1 kg/m^3"\ndepth = "1 m"\n',
        {3: 'give [system] with inclination = "5.711 deg"'},
    ),
    "a start as a number": (
        f'{BLOCK}[run]\ninitial = "0.1 rad"\n',
        {6: 'write initial = { rotation = "0.1 rad" }'},
    ),
    "the dampers of a run": (
        f"{BLOCK}[run]\ndamping = 0.1\n",
        {6: "such as [pads] with damping_ratio = 0.1 or [soil] with damping_ratio = 0.2"},
    ),
    "the scale of a run": (
        f"{BLOCK}[run]\nscale = 2\n",
        {6: "write operations = [{ scaled = { factor = 1.5 } }] in [motion]"},
    ),
    "the gravity of a run": (
        f'{BLOCK}[run]\ngravity = "9 m/s^2"\n',
        {6: '[system] with gravity = "9.81 m/s^2"'},
    ),
    "no table": ("block = 3\n", {1: "must be a table"}),
    "no part": ("[system]\n", {1: "no Block is given"}),
    "parts that do not fit": (
        f'{BLOCK}[cap]\nheight = "1 m"\nmass = "1 t"\n',
        {None: "without a WinklerSoil"},
    ),
    "two ways": (
        f'{BLOCK}[pads]\nfrequency_ratio = 20\nstiffness = "1 MN/m"\ndamping_ratio = 0.1\n',
        {6: "frequency_ratio or stiffness"},
    ),
    "an unknown class": (f'{BLOCK}[soil]\ntype = "Mud"\n', {6: 'modules = ["mine.py"]'}),
    "another constructor's key": (
        '[soil]\nmodulus = "20 MN/m^3"\ndamping_ratio = 0.2\n' + BLOCK,
        {2: 'constructor = "from_subgrade_modulus"', 1: "lacks 'stiffness'"},
    ),
    "no constructor": (BLOCK + 'constructor = "from_thin_air"\n', {5: "from_size"}),
    "an option": (f'{BLOCK}[system]\nrestraint = "glue"\n', {6: "restraint must be one of"}),
    "an option's unit": (f"{BLOCK}[system]\ngravity = 9.81\n", {6: "gravity needs"}),
    "a run's key": (f'{BLOCK}[run]\ndamping = "1"\n', {6: "unknown key 'damping'"}),
    "a run's damping": (
        f"{BLOCK}[pads]\nfrequency_ratio = 20\ndamping = 0.1\n[run]\ndamping = 0.1\n",
        {7: "damping_ratio", 9: "dampers belong to the parts"},
    ),
    "a run's step": (f'{BLOCK}[run]\ndt = "5 ms"\n', {6: "output_step is the spacing"}),
    "a system's damping": (f"{BLOCK}[system]\ndamping = 0.1\n", {6: "belong to the parts"}),
    "a run's time": (f'{BLOCK}[run]\nfree_vibration = "3"\n', {6: "free_vibration needs a time"}),
    "an accuracy": (f'{BLOCK}[run]\naccuracy = "best"\n', {6: "'fast', 'standard'"}),
    "an output": (f'{BLOCK}[run]\noutputs = ["energie"]\n', {6: "energie"}),
    "a start": (f'{BLOCK}[run.initial]\nrotation = "3 m"\n', {6: "rotation needs an angle"}),
    "no record": (f'{BLOCK}[motion]\nfile = "none.AT2"\n', {5: "no such file"}),
    "no motion": (f'{BLOCK}[motion]\ncomponent = "NS"\n', {5: "lacks 'file'"}),
    "a pulse of no kind": (
        f'{BLOCK}[motion]\namplitude = "1 m/s^2"\n',
        {5: "or 'constructor', one of sine_pulse, cosine_pulse"},
    ),
    "a pulse": (
        f'{BLOCK}[motion]\nconstructor = "sine_pulse"\nfrequency = "1 s"\n',
        {7: "its frequency is '1 Hz'"},
    ),
    "no pulse": (f'{BLOCK}[motion]\nconstructor = "bang"\n', {6: "sine_pulse"}),
    "an operation": (
        f'{BLOCK}[motion]\nconstructor = "sine_pulse"\noperations = [{{ scale = {{}} }}]\n',
        {7: "was 'scaled' meant?"},
    ),
    "its argument": (
        f'{BLOCK}[[motion.operations]]\n[motion.operations.scaled]\nfactor = "x"\n'
        '[motion]\nconstructor = "sine_pulse"\n',
        {7: "factor"},
    ),
    "a module": (f'modules = ["none.py"]\n{BLOCK}', {1: "none.py cannot be imported"}),
}


@pytest.mark.parametrize("name", SCENES)
def test_scene_errors_have_line_numbers(name, file):
    text, expected = SCENES[name]
    errors = faults(read_scene, file(text))
    for line, words in expected.items():
        message = errors[line] if line in errors else " ".join(errors.values())
        assert words in message, (line, errors)
        if line is not None:
            assert line in errors, errors


def test_constructor_calls_in_messages_are_translated_to_toml():
    words = "WinklerSoil.from_subgrade_modulus('20 MN/m^3', depth='4 m', ...) takes it"
    table = '[soil] with constructor = "from_subgrade_modulus", depth = "4 m"'
    assert in_toml(words) == f"{table} takes it"
    own = in_toml("give Load(vertical='1 kN'), or a file 'x=(1).AT2'")
    assert own == 'give [restrainer] with type = "Load", vertical = "1 kN", or a file \'x=(1).AT2\''


def test_module_named_like_another_is_refused(file):
    file("raise RuntimeError\n", "json.py")
    errors = faults(read_scene, file(f'modules = ["json.py"]\n{BLOCK}'))
    assert "json is another module already" in errors[1]


def test_all_scene_errors_are_reported_at_once(file):
    text = BLOCK.replace('"1 m"', "1").replace('"5 t"', '"5 m"') + "[pads]\nstifness = 3\n"
    assert set(faults(read_scene, file(text))) == {2, 4, 6}


STUDIES = {
    "nothing to vary": (BLOCK, "a study needs [axes]"),
    "no scene": ('scene = "none.toml"\n[axes]\nscale = [1]\n', "none.toml"),
    "two scenes": (f'scene = "scene.toml"\n{BLOCK}[axes]\nscale = [1]\n', "are both given"),
    "no motions": (f'motions = ["none/*.AT2"]\n{BLOCK}[axes]\nscale = [1]\n', "no file matches"),
    "a sweep's key": (f"{BLOCK}[axes]\nscale = [1]\n[sweep]\ncunk = 3\n", "was 'chunk' meant?"),
    "no table": (f'cases = "none.csv"\n{BLOCK}', "none.csv"),
}


@pytest.mark.parametrize("name", STUDIES)
def test_study_errors_are_described(name, file):
    text, words = STUDIES[name]
    assert words in " ".join(faults(read_study, file(text)).values())


def test_rows_longer_than_their_head_are_refused(file):
    # the first value of each row would be read as a label, and the others one column too early
    file("width [m],scale\n0.7,1,9\n0.8,2,9\n", "rows.csv")
    errors = faults(read_study, file(f'cases = "rows.csv"\n{BLOCK}'))
    assert "its rows have 3 values, but there are 2 heads" in errors[1]


def test_motions_of_a_table_are_found_by_their_names(file, tmp_path):
    for number in (1, 2, 3):
        pulse = rf.GroundMotion.sine_pulse(f"{number} m/s^2", "2 Hz")
        pulse.to_at2(tmp_path / f"0{number}.AT2")
    file("motion, scale\n01, 1\n02, 1\n", "rows.csv")
    head = 'motions = ["*.AT2"]\ncases = "rows.csv"\n'
    study = read_study(file(head + BLOCK))
    runs = rf.sweep(study.system, study.motions, **study.arguments)
    assert runs.motion.values.tolist() == ["01", "02"]
    file("motion, scale\n1, 1\n2, 1\n", "rows.csv")  # as written by spreadsheet programs
    study = read_study(file(head + BLOCK))
    with pytest.raises(StudyError, match="give the name, '01'"):
        rf.sweep(study.system, study.motions, **study.arguments)


def test_store_and_record_paths_are_relative_to_the_file(file, tmp_path, monkeypatch):
    text = f'{BLOCK}[axes]\nscale = [1]\n[sweep]\nknown = "kept"\n'
    assert read_study(file(text)).arguments["known"] == [tmp_path / "kept"]
    requests = []

    def read(path, *, response=None):
        requests.append((path, response))
        return rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")

    monkeypatch.setattr(rf.GroundMotion, "read", read)
    read_scene(file(f'{BLOCK}[motion]\nfile = "x.mseed"\nresponse = "x.xml"\n'))
    assert requests == [(tmp_path / "x.mseed", tmp_path / "x.xml")]


def test_sweep_errors_have_the_line_of_their_table(file):
    text = f'{BLOCK}[axes]\naccuracy = ["fast"]\n[sweep]\noverturning = "halt"\n'
    study = read_study(file(text))
    with pytest.raises(StudyError) as caught:
        rf.sweep(study.system, study.motions, duration="1 s", **study.arguments)
    faults_by_line = dict(study.at_lines(caught.value).faults)
    assert "axis 'accuracy' is an argument of the runs" in faults_by_line[6]
    assert "overturning must be one of" in faults_by_line[8]


def test_faults_of_a_table_of_cases_have_its_line(file):
    cap = (
        '[cap]\nheight = "0.5 m"\nmass = "2 t"\n[soil]\nstiffness = "9 MPa"\ndamping_ratio = 0.2\n'
    )
    file("width [m]\n0.8\n", "rows.csv")
    study = read_study(file(f'cases = "rows.csv"\n{BLOCK}{cap}[axes]\nheight = ["3 m"]\n'))
    with pytest.raises(StudyError) as caught:
        rf.sweep(study.system, study.motions, duration="1 s", **study.arguments)
    assert all("in axes={...} or cases" in fault for fault in caught.value.faults)
    faults_by_line = dict(study.at_lines(caught.value).faults)
    words = "is a parameter of Block and CushionCap; name one:"
    assert faults_by_line[1] == f"axis 'width' {words} 'Block.width' or 'CushionCap.width'"
    assert f"axis 'height' {words}" in faults_by_line[13]


def test_templates_can_be_read(file):
    for name, text in TEMPLATES.items():
        if name == "study":
            file(TEMPLATES["block"])
            assert read_study(file(text, "study.toml")).arguments["axes"]["scale"]
        else:
            scene = read_scene(file(text))
            assert np.isfinite(scene.motion.si.duration), name


def test_full_template_lists_every_key():
    text = all_keys_template()
    for slot in part_slots():
        assert f"\n[{slot}]" in text
        for name, kind in classes_in(slot).items():
            assert f'type = "{name}"' in text
            inner = inner_parts(kind)
            assert all(f"[{slot}.{key}]" in text for key in inner)
            assert all(f"\n# {key} = " in text for key in kind.declared() if key not in inner)
    examples = re.findall(r"^# (\w+ = .+?)(?:  .*)?$", text, re.MULTILINE)
    assert len(examples) > 60
    assert all(tomllib.loads(example) for example in examples)
    bare = re.findall(r"^# (\w+)  ", text, re.MULTILINE)
    assert bare == []  # every key has a value
    assert "eq-" not in text  # labels of equations have no meaning outside the manual
    assert "``" not in text
    assert max(map(len, text.splitlines())) < 125


@pytest.mark.parametrize(
    ("table", "omitted"),
    [
        # values that require another value or another scene
        ("system", {"coupling", "sliding"}),
        ("run", {"duration"}),
        ("run.initial", set()),
        ("sweep", {"duration", "known"}),
        ("block", {"shape_factor"}),
        ("pads", {"stiffness", "damping"}),
    ],
)
def test_a_file_with_the_values_of_every_key_can_be_read(file, table, omitted):
    of_table = all_keys_template().split(f"\n[{table}] ", 1)[1].split("\n[", 1)[0]
    lines = re.findall(r"^# (\w+ = .+?)(?:  .*)?$", of_table, re.MULTILINE)
    settings = "\n".join(setting for setting in lines if setting.split()[0] not in omitted)
    body = "[block]\nwidth = '1 m'\nheight = '4 m'\nmass = '9 t'\n" * (table != "block")
    text = f"{body}[{table}]\n{settings}\n"
    if table == "sweep":
        motion = "[motion]\nconstructor = 'sine_pulse'\namplitude = '1 m/s^2'\nfrequency = '1 Hz'\n"
        read_study(file(f"{text}{motion}[axes]\nscale = [1.0, 2.0]\n", "study.toml"))
    else:
        assert read_scene(file(text)).system.describe()


STATUE = rf.Block(width="0.6 m", height="2 m", mass="1 t", eccentricity="0.02 m")
PLINTH = rf.Block(width="1 m", height="1 m", mass="2 t")
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
TIE = rf.Restrainer(
    on=("-0.3 m", "2 m"), to=("-1.5 m", "2 m"), stiffness="2 MN/m", brittle=True,
    strength="20 kN", name='upper "tie", new',
)  # fmt: skip
LOAD = rf.Load(at=("0 m", "2 m"), vertical="1 kN")
WRITTEN = {
    "a block with ties": (STATUE, rf.RigidGround(friction=0.5), TIE, LOAD),
    "one tie": (STATUE, PADS, TIE),
    "a stack": (rf.Stack(STATUE, PLINTH, interfaces=[PADS], offsets=["0.05 m"]), PADS),
    "columns": (rf.RockingFrame(PLINTH, columns=3, beam_mass="20 t"),),
    "a building": (
        rf.FrameEquivalent.from_members(
            storeys=2, width="4 m", height="6 m", column_width="0.25 m", beam_height="0.3 m",
            beam_width="0.25 m", density="2500 kg/m^3",
        ),
        PADS,
        rf.CushionCap(height="0.9 m", mass="36 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRITTEN)
def test_written_parts_survive_toml_round_trip(name, file):
    system = rf.System(*WRITTEN[name])
    lines = [
        line for head, keys in toml_tables(system.parts.structural()) for line in (head, *keys)
    ]
    assert read_scene(file("\n".join(lines))).system == system


def test_one_table_of_interfaces_is_the_base_between_all_bodies(file):
    body = "[[stack.bodies]]\nwidth = '1 m'\nheight = '1.5 m'\nmass = '2 t'\n"
    joint = "[stack.interfaces]\ntype = 'RigidGround'\nfriction = 0.3\n"
    drum, base = rf.Block(width="1 m", height="1.5 m", mass="2 t"), rf.RigidGround(friction=0.3)
    assert read_scene(file(3 * body + joint)).system == rf.System(
        rf.Stack(drum, drum, drum, interfaces=base)
    )
