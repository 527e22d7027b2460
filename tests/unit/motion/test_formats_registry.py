"""The registry of formats, and readers registered by users."""

import doctest
from functools import wraps
from types import SimpleNamespace

import numpy as np
import pytest
from unit.motion.motion_files import numbers

import rockframe.records
from rockframe.errors import ComponentError, RecordError
from rockframe.motion import GroundMotion, formats
from rockframe.records import (
    Component,
    Record,
    choose_component,
    choose_unit,
    known_formats,
    register,
    unregister,
)
from rockframe.records.unit_names import acceleration_unit

VALUES = numbers(9)
FILE = "MADE UP FORMAT\nGAL\n" + "".join(f"{value:.7f}\n" for value in VALUES)
GAL = acceleration_unit("gal")


def read(source, request):
    unit, name, warnings = choose_unit(source, request, source.lines[1], 2)
    values = np.array([float(line) for line in source.lines[2:] if line])
    record = Record(0.01, values, unit, {"unit_as_read": name}, warnings=tuple(warnings))
    return choose_component(source, request, [Component("N", lambda: record)])


def reader(**changed):
    attributes = {
        "NAME": "made-up",
        "TITLE": "file made up for a test",
        "SUFFIXES": (".mup",),
        "recognises": lambda source: source.lines[0] == "MADE UP FORMAT",
        "read": read,
    }
    return SimpleNamespace(**{**attributes, **changed})


@pytest.fixture
def registered():
    added = []

    def _register(**changed):
        register(reader(**changed))
        added.append(changed.get("NAME", "made-up"))

    yield _register
    for name in added:
        unregister(name)


def test_formats_are_listed_with_name_title_and_suffixes():
    listed = formats()
    # as the manual lists them
    assert all(entry.holds and entry.unit for entry in listed if entry.own)
    names = [entry.name for entry in listed]
    assert len(set(names)) == len(names)
    assert names[-1] == "text"  # it accepts every column of numbers
    for entry in listed:
        assert entry.title
        assert all(suffix.startswith(".") for suffix in entry.suffixes)


def test_a_list_of_formats_can_be_printed():
    text = repr(formats()[0])
    expected = "name='peer-at2', title='PEER acceleration file (AT2)', suffixes=('.at2',)"
    assert text == f"Format({expected})"


def test_the_example_runs():
    assert doctest.testmod(known_formats).attempted
    assert not doctest.testmod(known_formats).failed


def test_registry_functions_are_shared_by_both_modules():
    assert rockframe.motion.formats is rockframe.records.formats
    assert rockframe.motion.register is rockframe.records.register
    assert rockframe.motion.unregister is rockframe.records.unregister


def test_former_module_of_readers_warns_and_redirects():
    with pytest.warns(FutureWarning, match=r"rockframe\.records: import Record from there"):
        from rockframe.motion.readers import Record as Before
    assert Before is Record
    with pytest.raises(AttributeError):
        rockframe.motion.readers.nothing  # noqa: B018


def test_format_name_is_case_insensitive(write):
    with pytest.raises(RecordError, match=r"expected a header line 'Sampling Freq\(Hz\)'"):
        GroundMotion.read(write("x", "r"), format="K_NET")


def test_an_unknown_format_is_refused_and_the_others_listed(write):
    with pytest.raises(ComponentError, match=r"one of 'peer-at2', .*'text', got 'xls'"):
        GroundMotion.read(write("x", "r"), format="xls")


@pytest.mark.parametrize("name", ["r.mup", "r.txt"])
@pytest.mark.parametrize("format_name", [None, "made-up"])
def test_an_added_format_is_recognised_and_read(write, registered, name, format_name):
    registered()
    motion = GroundMotion.read(write(FILE, name), format=format_name, component="N")
    assert motion.si.horizontal.samples.tolist() == pytest.approx(
        (0.01 * VALUES).tolist(), abs=1e-9
    )
    assert motion.metadata["format"] == "made-up"
    assert motion.metadata["component"] == "N"
    assert formats()[-2].title == "file made up for a test"


def test_an_added_format_may_read_bytes(write, registered):
    registered(
        BINARY=True,
        recognises=lambda source: source.data.startswith(b"\x00MUP"),
        read=lambda source, request: Record(0.01, [1, 2.5], GAL, {"unit_as_read": "gal"}),
    )
    motion = GroundMotion.read(write(b"\x00MUP\xff", "r.bin"))
    assert motion.si.horizontal.samples.tolist() == [0.01, 0.025]


def test_unregister_removes_only_registered_formats(write, registered):
    register(reader())
    unregister("made-up")
    assert "made-up" not in {entry.name for entry in formats()}
    with pytest.raises(ComponentError, match=r"no added format is called 'made-up'"):
        unregister("made-up")
    with pytest.raises(ComponentError, match="'peer-at2'"):
        unregister("peer-at2")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"NAME": "Made Up"}, "NAME must be small letters"),
        ({"NAME": 3}, "NAME must be"),
        ({"TITLE": "  "}, "TITLE must be one line"),
        ({"SUFFIXES": [".mup"]}, "SUFFIXES must be a tuple"),
        ({"SUFFIXES": ("mup",)}, "SUFFIXES must be a tuple"),
        ({"recognises": None}, "recognises must be a function of source"),
        ({"read": lambda source: None}, "read must be a function of source and request"),
        ({"BINARY": 1}, "BINARY must be True or False"),
        ({"NAME": "text"}, "the format 'text' exists already"),
    ],
)
def test_register_refuses_invalid_readers(changed, words):
    before = formats()
    with pytest.raises(ComponentError, match=words):
        register(reader(**changed))
    assert formats() == before


def test_decorated_functions_are_read_by_their_own_arguments(registered):
    def as_text(function):
        @wraps(function)
        def call(source, request):
            return function("\n".join(source.lines), source=source, request=request)

        return call

    @as_text
    def read_text(text, *, source, request):
        assert text.startswith("MADE UP FORMAT")
        return read(source, request)

    @wraps(read)
    def of_text(text):
        return read_text(text)

    registered(read=read_text)
    with pytest.raises(ComponentError, match=r"read must be a function of source and request"):
        register(reader(NAME="other", read=of_text))


def test_all_faults_are_listed():
    with pytest.raises(ComponentError, match=r"NAME.*; TITLE.*; SUFFIXES.*; recognises.*; read"):
        register(object())


def test_the_same_name_twice(registered):
    registered()
    with pytest.raises(ComponentError, match="exists already"):
        register(reader())


def failing(source, request):
    return {}["whatever"]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"read": failing}, r"failure of the added reader .* \(KeyError: 'whatever'\)"),
        ({"read": lambda source, request: None}, "returned NoneType, not a Record"),
        (
            {"read": lambda source, request: Record(0.01, [1.0, np.nan], GAL, {})},
            "samples are not all finite",
        ),
        ({"read": lambda source, request: Record(0.01, [[1.0, 2.0]], GAL, {})}, r"shape \(1, 2\)"),
        ({"read": lambda source, request: Record(0.01, [1.0], GAL, {})}, r"shape \(1,\)"),
        ({"read": lambda source, request: Record("1", [1.0, 2.0], GAL, {})}, "time_step is '1'"),
        (
            {"read": lambda source, request: Record(0.01, [1.0, 2.0], GAL, {"a": [1]})},
            "metadata 'a' is neither",
        ),
        (
            {"read": lambda source, request: Record(0.01, [1.0, 2.0], GAL, {}, vertical=[1, 2, 3])},
            "2 and 3 samples",
        ),
        ({"read": lambda source, request: Record(0.01, [1.0, 2.0], "gal", {})}, "unit is 'gal'"),
        (
            {"recognises": lambda source: 1 / 0},
            r"failure of the added reader .* \(ZeroDivisionError",
        ),
    ],
)
def test_faults_of_registered_reader_raise_record_error(write, registered, changed, words):
    registered(**changed)
    with pytest.raises(RecordError, match=words):
        GroundMotion.read(write(FILE, "r.mup"))


def test_refusal_by_registered_reader_is_passed_on(write, registered):
    def refusing(source, request):
        raise source.refuse(found="this", expected="that", line=2)

    registered(read=refusing)
    with pytest.raises(RecordError, match="line 2: found this; expected that"):
        GroundMotion.read(write(FILE, "r.mup"))


def test_response_argument_needs_counts(write):
    with pytest.raises(RecordError, match="to which the argument response applies"):
        GroundMotion.read(write("0,1\n1,2\n", "r.csv"), unit="g", response="response.xml")
