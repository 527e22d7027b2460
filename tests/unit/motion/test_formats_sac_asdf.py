"""SAC and ASDF: byte orders, missing units, orientations, checks."""

import importlib.util
import re

import netCDF4
import numpy as np
import pytest
from unit.motion.binary_samples import asdf, station_xml
from unit.motion.dialect_samples import COUNT, VALUES, sac

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

needs_lxml = pytest.mark.skipif(
    importlib.util.find_spec("lxml") is None, reason="lxml is not installed"
)

SINGLE = VALUES["E"].astype(np.float32).astype(np.float64)


def read_sac(write, name="r.sac", *, unit="gal", **sample_options):
    read_options = {
        key: sample_options.pop(key) for key in ("component", "response") if key in sample_options
    }
    return GroundMotion.read(write(sac(**sample_options), name), unit=unit, **read_options)


class TestSac:
    @pytest.mark.parametrize("order", "<>")
    @pytest.mark.parametrize("name", ["r.sac", "r", "r.txt"])
    def test_either_byte_order_whatever_the_name(self, write, order, name):
        motion = read_sac(write, name, order=order)
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.01 * SINGLE, rtol=1e-14)
        assert motion.si.time_step == 0.01
        assert motion.metadata["format"] == "sac"
        assert motion.metadata["station"] == "MADE"
        assert motion.metadata["network"] == "XX"
        assert motion.metadata["record_time"] == "2018-01-24T10:51:00Z"
        assert (motion.metadata["component"], motion.metadata["azimuth"]) == ("HNE", 90.0)
        assert "event" not in motion.metadata

    def test_missing_unit_is_refused(self, write):
        for kind in (8, 5, -12345):
            with pytest.raises(RecordError, match=r"samples without a unit.*unit='m/s\^2'"):
                read_sac(write, unit=None, kind=kind)

    @needs_lxml
    def test_counts_and_a_response(self, write):
        write(station_xml(sensitivity=400.0), "XX.MADE.xml")
        motion = read_sac(write, unit=None)
        np.testing.assert_allclose(
            motion.si.horizontal.samples, (SINGLE - SINGLE.mean()) / 400.0, atol=1e-12
        )
        assert motion.metadata["sensitivity"] == 400.0

    @pytest.mark.parametrize(("kind", "words"), [(6, "a displacement"), (7, "a velocity")])
    def test_other_quantities(self, write, kind, words):
        with pytest.raises(RecordError, match=words):
            read_sac(write, kind=kind)

    def test_uneven_samples(self, write):
        with pytest.raises(RecordError, match="not evenly spaced"):
            read_sac(write, even=0)

    def test_cut_short(self, write):
        with pytest.raises(RecordError, match=f"after {COUNT - 1} samples; expected {COUNT}"):
            GroundMotion.read(write(sac()[:-4], "r.sac"), unit="gal")
        with pytest.raises(RecordError, match="announced"):
            read_sac(write, count=2**31 - 1)

    def test_bytes_after_last_sample_warn(self, write):
        own = read_sac(write)
        with pytest.warns(RecordWarning, match="8 bytes after the last sample are not read"):
            more = GroundMotion.read(write(sac() + bytes(8), "r.sac"), unit="gal")
        assert more.sha256 == own.sha256
        GroundMotion.read(write(sac() + bytes(176), "r.sac"), unit="gal")

    @pytest.mark.parametrize(("incidence", "sign"), [(0.0, 1.0), (180.0, -1.0)])
    def test_incidence_sets_sign_of_vertical_component(self, write, incidence, sign):
        motion = read_sac(write, incidence=incidence, channel="HNZ", component="U")
        expected = sign * 0.01 * SINGLE
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-14)

    def test_stated_peaks_and_length(self, write):
        data = bytearray(sac())
        data[8:12] = np.array([400.0], "<f4").tobytes()
        with pytest.warns(RecordWarning, match="states 400 as the largest sample"):
            GroundMotion.read(write(bytes(data), "r.sac"), unit="gal")
        data = bytearray(sac())
        data[24:28] = np.array([1.2], "<f4").tobytes()
        with pytest.warns(RecordWarning, match=r"a length of 1\.2 s"):
            GroundMotion.read(write(bytes(data), "r.sac"), unit="gal")


class TestAsdf:
    def test_unit_of_gmprocess_is_read(self, write, tmp_path):
        path = write(asdf(tmp_path), "w.h5")
        motion = GroundMotion.read(path, component=("N", "U"))
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.01 * VALUES["N"], rtol=1e-14)
        np.testing.assert_allclose(motion.si.vertical.samples, 0.01 * VALUES["U"], rtol=1e-14)
        assert motion.si.time_step == 0.01
        metadata = motion.metadata
        assert (metadata["network"], metadata["station"]) == ("XX", "MADE")
        assert metadata["processing"] == "made_default"
        assert metadata["record_time"] == "2018-01-24T10:51:00Z"
        assert metadata["unit_as_read"] == "cm/s^2"

    def test_without_a_unit(self, write, tmp_path):
        path = write(asdf(tmp_path, unit=None), "w.h5")
        with pytest.raises(RecordError, match=r"no unit of XX.*the argument unit"):
            GroundMotion.read(path, component="HNE")
        motion = GroundMotion.read(path, component="HNE", unit="gal")
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.01 * VALUES["E"], rtol=1e-14)

    @needs_lxml
    def test_counts_and_the_response_in_the_file(self, write, tmp_path):
        path = write(asdf(tmp_path, unit="raw counts", xml=station_xml(sensitivity=400.0)), "w.h5")
        motion = GroundMotion.read(path, component="HNE")
        values = VALUES["E"] - VALUES["E"].mean()
        np.testing.assert_allclose(motion.si.horizontal.samples, values / 400.0, atol=1e-12)
        assert motion.metadata["unit_as_read"] == "counts"

    def test_components_are_listed(self, write, tmp_path):
        with pytest.raises(RecordError, match=r"3 components: 'HNE' .* 'HNN' .* 'HNZ'"):
            GroundMotion.read(write(asdf(tmp_path), "w.h5"))

    def test_other_hdf5_file_is_refused(self, tmp_path):
        for group, words in (
            ("Wavefronts", "found no variable 'acceleration'"),
            ("Waveforms", "found no waveforms"),
        ):
            path = tmp_path / "w.h5"
            with netCDF4.Dataset(path, "w") as file:
                file.setncatts({"file_format": "ASDF"})
                file.createGroup(group).createGroup("XX.MADE")
            with pytest.raises(RecordError, match=words):
                GroundMotion.read(path)

    @pytest.mark.parametrize("rate", [0.0, -1.0, float("nan"), 1e-9])
    def test_invalid_sampling_rate_is_refused(self, write, tmp_path, rate):
        words = f"a sampling rate of {rate} Hz" if rate != 1e-9 else "a time step of 1000000000.0 s"
        with pytest.raises(RecordError, match=words):
            GroundMotion.read(write(asdf(tmp_path, rate=rate), "w.h5"), component="HNE")

    def test_history_names_format_and_unit(self, tmp_path, write):
        history = GroundMotion.read(write(asdf(tmp_path), "w.h5"), component="HNE").history
        assert re.match(
            r"read w\.h5 \(ASDF file \(HDF5\), as of gmprocess, unit cm/s\^2\)", history[0]
        )
