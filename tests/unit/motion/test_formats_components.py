"""Choice of components: names, directions, channel numbers, pairs."""

import numpy as np
import pytest
from unit.motion.format_samples import (
    SAMPLES,
    VALUES,
    cosmos,
    cosmos_block,
    csmip,
    cwa,
    geonet,
    geonet_component,
    smc,
)

from rockframe.errors import ComponentError, RecordError, RecordWarning
from rockframe.motion import GroundMotion
from rockframe.records.components import UNKNOWN, Orientation, orientation_of

GAL = 0.01
NORTH, EAST, UP = (VALUES[key] * GAL for key in ("N", "E", "U"))


def level(azimuth):
    return Orientation(azimuth=azimuth)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("N", level(0.0)),
        ("N-S", level(0.0)),
        ("ew", level(90.0)),
        (" East ", level(90.0)),
        ("S", level(180.0)),
        ("W", level(270.0)),
        ("090", level(90.0)),
        ("360", level(360.0)),
        ("67", level(67.0)),
        ("90 DEG", level(90.0)),
        ("360 Deg.", level(360.0)),
        ("S16W", level(196.0)),
        ("S74E", level(106.0)),
        ("N15E", level(15.0)),
        ("N10W", level(350.0)),
        ("N 5 W", level(355.0)),
        ("HNE", level(90.0)),
        ("BNN", level(0.0)),
        ("HNZ", Orientation(vertical="up")),
        ("U", Orientation(vertical="up")),
        ("U-D", Orientation(vertical="up")),
        ("UP", Orientation(vertical="up")),
        ("DWN", Orientation(vertical="down")),
        ("Vert", Orientation(vertical="vertical")),
        ("BHZ.00", Orientation(vertical="up")),
        ("BHZ00", Orientation(vertical="up")),
        ("HNZ--", Orientation(vertical="up")),
        ("HNE.10", level(90.0)),
        ("UPDO", Orientation(vertical="up")),
        ("UD1", Orientation(vertical="up")),
        ("V1", Orientation(vertical="vertical")),
        ("-UP", Orientation(vertical="vertical")),
        ("-N", UNKNOWN),
        ("BH100", UNKNOWN),
        ("T3", UNKNOWN),
        ("361", UNKNOWN),
        ("-10", UNKNOWN),
        ("HN1", UNKNOWN),
        ("H1", UNKNOWN),
        ("FN", UNKNOWN),
        ("", UNKNOWN),
        ("½", UNKNOWN),
        ("N99E99", UNKNOWN),
    ],
)
def test_directions_by_name(name, expected):
    assert orientation_of(name) == expected


def test_azimuths_0_and_360_match():
    assert level(0.0).matches(level(360.0))
    assert not level(0.0).matches(level(180.0))
    assert not UNKNOWN.matches(UNKNOWN)


@pytest.mark.parametrize(
    ("component", "expected"),
    [
        ("N", NORTH),
        ("n-s", NORTH),
        ("000", NORTH),
        ("360", NORTH),
        ("E", EAST),
        ("90", EAST),
        ("090", EAST),
        ("U", UP),
        ("up", UP),
        ("Z", UP),
        ("V", UP),
    ],
)
def test_component_is_chosen_by_name_or_direction(write, component, expected):
    motion = GroundMotion.read(write(cwa(), "r.dat"), component=component)
    assert motion.si.horizontal.samples.tolist() == pytest.approx(expected.tolist())
    assert motion.si.vertical is None
    assert "(of U, N, E)" in motion.history[1]


@pytest.mark.parametrize(
    ("component", "expected"),
    [("channel 1", NORTH), ("chan 2", UP), ("Ch. 3", EAST), ("#3", EAST), ("3", EAST), ("2", UP)],
)
def test_component_is_chosen_by_channel_number(write, component, expected):
    motion = GroundMotion.read(write(csmip(2), "r.V2"), component=component)
    assert motion.si.horizontal.samples.tolist() == pytest.approx(expected.tolist())


def test_direction_takes_precedence_over_channel_number(write):
    text = geonet_component(VALUES["N"], name="Up", azimuth=0)
    text += geonet_component(VALUES["E"], name="N02E", azimuth=2)
    motion = GroundMotion.read(write(text, "r.V2A"), component="2")
    assert motion.metadata["component"] == "N02E"


def test_unspecified_component_raises_and_lists_components(write):
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write(cwa(), "r.dat"))
    error = caught.value
    assert error.found == "3 components: 'U' (up), 'N' (0°), 'E' (90°)"
    assert "component='N'" in error.expected
    assert "component=('N', 'U')" in error.expected


def test_unknown_component_raises_and_lists_components(write):
    with pytest.raises(RecordError, match=r"'U' \(up\), 'N'.*expected the component 'S45E'"):
        GroundMotion.read(write(cwa(), "r.dat"), component="S45E")


def test_opposite_directions_are_not_the_same(write):
    with pytest.raises(RecordError, match="expected the component 'S'"):
        GroundMotion.read(write(cwa(), "r.dat"), component="S")


def test_the_only_horizontal_component_needs_no_name(write):
    motion = GroundMotion.read(write(cosmos(), "r.V2c"))
    assert motion.si.horizontal.samples.tolist() == pytest.approx(NORTH.tolist())
    assert motion.history[1] == "component 360 Deg taken (of 360 Deg, Up)"


def test_components_with_same_name_need_channel_number(write):
    text = cosmos_block("acceleration", VALUES["N"], chan="  4: 360 Deg")
    text += cosmos_block("acceleration", VALUES["E"], chan="  7: 360 Deg")
    path = write(text, "r.V2c")
    with pytest.raises(RecordError, match=r"2 components that match 'N'.*channel number"):
        GroundMotion.read(path, component="N")
    with pytest.raises(RecordError, match="such as component='channel 4'"):
        GroundMotion.read(path)
    motion = GroundMotion.read(path, component="channel 7")
    assert motion.si.horizontal.samples.tolist() == pytest.approx(EAST.tolist())
    assert motion.metadata["channel"] == 7


class TestPairs:
    @pytest.mark.parametrize("component", [("E", "U"), ["090", "up"], ("E", "Z")])
    def test_a_horizontal_and_the_vertical_component(self, write, component):
        motion = GroundMotion.read(write(cwa(), "r.dat"), component=component)
        assert motion.si.horizontal.samples.tolist() == pytest.approx(EAST.tolist())
        assert motion.si.vertical.samples.tolist() == pytest.approx(UP.tolist())
        assert motion.metadata["component"] == "E"
        assert motion.metadata["vertical_component"] == "U"
        assert "component E taken as horizontal, U as vertical" in motion.history

    def test_pair_equals_with_vertical(self, write):
        path = write(geonet(), "r.V2A")
        both = GroundMotion.read(path, component=("S16W", "Up"))
        across, upwards = (GroundMotion.read(path, component=name) for name in ("S16W", "Up"))
        assert both.sha256 == across.with_vertical(upwards).sha256

    @pytest.mark.parametrize(
        ("component", "words"),
        [
            (("N", "E"), "'E' .* requested as the vertical one; expected a vertical"),
            (("U", "N"), "'U' .* requested as the horizontal one"),
            (("U", "U"), "requested as the horizontal one"),
            (("N", "T"), "expected the component 'T'"),
        ],
    )
    def test_invalid_pairs_are_refused(self, write, component, words):
        with pytest.raises(RecordError, match=words):
            GroundMotion.read(write(cwa(), "r.dat"), component=component)

    def test_a_file_of_one_component_has_no_pair(self, write):
        with pytest.raises(RecordError, match=r"one component, '360'.*with_vertical"):
            GroundMotion.read(write(smc(), "r.smc"), component=("360", "U"))

    def test_a_component_downwards_is_turned_over(self, write):
        path = write(cwa(sequence="Time U(-); N(+); E(+)"), "r.dat")
        motion = GroundMotion.read(path, component=("N", "U"))
        assert motion.si.vertical.samples.tolist() == pytest.approx((-UP).tolist())
        assert "component -U turned over: positive upwards" in motion.history

    def test_upward_direction_inverts_downward_component(self, write):
        path = write(cwa(sequence="Time U(-); N(+); E(+)"), "r.dat")
        turned = GroundMotion.read(path, component="up")
        assert turned.si.horizontal.samples.tolist() == pytest.approx((-UP).tolist())
        assert "turned over" in turned.history[-1]
        unchanged = GroundMotion.read(path, component="-U")
        assert unchanged.si.horizontal.samples.tolist() == pytest.approx(UP.tolist())

    def test_a_component_of_unknown_sense_is_warned_about(self, write):
        text = cosmos_block("acceleration", VALUES["N"])
        text += cosmos_block("acceleration", VALUES["U"], chan="  2: Vert", azimuth=402)
        path = write(text, "r.V2c")
        with pytest.warns(RecordWarning, match="upwards or downwards; upwards is assumed"):
            motion = GroundMotion.read(path, component=("N", "Vert"))
        assert motion.si.vertical.samples.tolist() == pytest.approx(UP.tolist())

    @pytest.mark.parametrize(("code", "sign"), [(400, 1.0), (401, -1.0)])
    def test_sense_of_a_cosmos_channel_follows_from_its_code(self, write, code, sign):
        text = cosmos_block("acceleration", VALUES["N"])
        text += cosmos_block("acceleration", VALUES["U"], chan="  2: Vert", azimuth=code)
        motion = GroundMotion.read(write(text, "r.V2c"), component=("N", "Vert"))
        assert motion.si.vertical.samples.tolist() == pytest.approx((sign * UP).tolist())

    def test_the_shorter_of_two_is_padded(self, write):
        text = cosmos_block("acceleration", VALUES["N"])
        text += cosmos_block("acceleration", VALUES["U"][:20], chan="  2: Up", azimuth=400)
        motion = GroundMotion.read(write(text, "r.V2c"), component=("N", "U"))
        assert motion.si.vertical.samples[20:].tolist() == [0.0] * (len(motion) - 20)
        assert f"vertical component padded with {len(motion) - 20} zeros" in motion.history

    def test_units_may_differ(self, write):
        text = cosmos_block("acceleration", VALUES["N"])
        text += cosmos_block(
            "acceleration", VALUES["U"], chan="  2: Up", azimuth=400, unit="mg(11)", code=11
        )
        motion = GroundMotion.read(write(text, "r.V2c"), component=("N", "U"))
        np.testing.assert_allclose(motion.si.vertical.samples, VALUES["U"] * 9.80665e-3, rtol=1e-12)

    def test_different_time_steps_of_pair_are_refused(self, write):
        text = cosmos_block("acceleration", VALUES["N"])
        text += cosmos_block(
            "acceleration", VALUES["U"], chan="  2: Up", azimuth=400, milliseconds=5.0
        )
        with pytest.raises(RecordError, match=r"time steps of 0\.01 s and 0\.005 s"):
            GroundMotion.read(write(text, "r.V2c"), component=("N", "U"))

    def test_different_start_times_of_pair_are_refused(self, write):
        later = cosmos_block("acceleration", VALUES["U"], chan="  2: Up", azimuth=400)
        text = cosmos_block("acceleration", VALUES["N"]) + later.replace("17:29:39.", "17:29:40.")
        with pytest.raises(RecordError, match=r"start at .*39\.137 UTC and at .*40\.137 UTC"):
            GroundMotion.read(write(text, "r.V2c"), component=("N", "U"))


class TestOnlyVertical:
    def test_default_component_warns(self, write):
        path = write(smc(name="UP", slope=0), "r.smc")
        with pytest.warns(RecordWarning, match=r"vertical, and is read as if.*with_vertical"):
            GroundMotion.read(path)

    def test_explicit_component_does_not_warn(self, write):
        GroundMotion.read(write(smc(name="UP", slope=0), "r.smc"), component="U")


@pytest.mark.parametrize(
    "component", ["", "  ", 3, ("N",), ("N", "U", "E"), ("N", 3), ("N", ""), {"N": "U"}, object()]
)
def test_invalid_component_arguments_are_refused(write, component):
    sample = SAMPLES["cwa"]
    with pytest.raises(ComponentError, match=r"component=\('N', 'U'\)"):
        GroundMotion.read(write(sample.data, sample.name), component=component)
