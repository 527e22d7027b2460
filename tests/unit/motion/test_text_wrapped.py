"""Records wrapped to several values a line, and their distinction from columns."""

import itertools

import numpy as np
import pytest
from records import record_path
from unit.motion.motion_files import G, rows

import rockframe as rf
from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion
from rockframe.records.files import read_source
from rockframe.records.read import read_components
from rockframe.records.reader import Request
from rockframe.records.text_columns import COLUMNS, ROWS, reading_order

ARGUMENTS = {"unit": "g", "time_step": "0.02 s"}
WRAPPED = GroundMotion.example("loma-prieta").si.horizontal.samples[:2998]
FILES = (
    *("PEERSMD_CHICHI_TCU128-N.AT2", "ElCentro1940_Peknold.AT2", "NIS090.AT2"),
    *("PEERSMD_IMPVALL_IELC180.AT2", "RSN763_LOMAP_GIL067.AT2", "more2/ALH360.AT2"),
    *("SMC_LomaPrieta1989_0111a.smc", "ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC"),
    *("GEONET_20180212_211557_WPWS_20.V2A", "CWA_20180206_1-EAS.dat"),
    *("more/AFAD_20170720223109_4801.txt", "more/BHRC_5526-1.V1", "more/CSMIP_CE89146.V1"),
    *("more/COSMOS_CE23837.V1C", "more/UNAM_CUP50401.012", "more/USC_274o42pv.s0b"),
)
SEVERAL = [name for name in FILES if name.startswith(("GEO", "CWA", "more/"))]


def components(name: str):
    """Samples of all components of a recorded file."""
    records = read_components(read_source(record_path(name)), None, Request())
    return [record.si.horizontal.samples for record in records]


def table(samples, columns: int):
    count = len(samples) // columns
    return samples[: count * columns].reshape(count, columns)


class TestWrapped:
    @pytest.mark.parametrize("columns", [2, 3, 5, 8, 10])
    @pytest.mark.parametrize("head", ["", "A made-up record of an earthquake\n"])
    def test_is_read_row_by_row_to_the_short_last_line(self, write, columns, head):
        path = write(head + rows(WRAPPED, columns), "wrapped.dat")
        motion = GroundMotion.read(path, **ARGUMENTS)
        np.testing.assert_allclose(motion.si.horizontal.samples, G * WRAPPED, rtol=1e-6)
        assert motion.history[-1] == f"2998 samples, {columns} to a line, read row by row"
        assert GroundMotion.read(path, component="row by row", **ARGUMENTS) == motion
        (only,) = rf.read_suite(path, **ARGUMENTS).values()
        assert only.sha256 == motion.sha256

    def test_column_of_wrapped_record_is_refused(self, write):
        path = write(rows(WRAPPED, 5), "wrapped.dat")
        with pytest.raises(RecordError, match=r"2998 samples, 5 to a line.*component='row by row'"):
            GroundMotion.read(path, component="column 1", **ARGUMENTS)

    def test_cut_first_line_is_not_mistaken_for_header(self, write):
        cut = rows(WRAPPED, 5)[37:]  # "...E+00" and two numbers
        with pytest.raises(RecordError, match=r"line 1: found .* expected numbers"):
            GroundMotion.read(write(cut.replace("E", "E-", 1), "wrapped.dat"), **ARGUMENTS)

    def test_blank_line_among_numbers_warns(self, write):
        text = rows(WRAPPED, 5)
        path = write(text[: 76 * 100] + "\n" + text[76 * 100 :], "wrapped.dat")
        with pytest.warns(RecordWarning, match="line 101: a blank line among the numbers"):
            assert len(GroundMotion.read(path, **ARGUMENTS)) == 2998

    def test_record_cut_inside_number_is_refused(self, write):
        path = write(rows(WRAPPED, 5)[:-5], "wrapped.dat")
        with pytest.raises(RecordError, match="inside a number"):
            GroundMotion.read(path, **ARGUMENTS)

    def test_downloaded_wrapped_file_equals_at2_file(self):
        plain, headed = record_path("more2/ALH360.dat"), record_path("more2/ALH360.AT2")
        motion = GroundMotion.read(plain, unit="g", time_step="0.02 s")
        expected = GroundMotion.read(headed).si.horizontal.samples
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-6)


class TestAmbiguousLayout:
    def test_ambiguous_layout_raises_and_lists_both_readings(self, write):
        noise = np.random.default_rng(1).uniform(-0.1, 0.1, size=300)
        path = write(rows(noise, 3), "noise.dat")
        with pytest.raises(RecordError, match=r"'row by row', or .*component='column 1'"):
            GroundMotion.read(path, **ARGUMENTS)
        with pytest.raises(RecordError, match="'row by row'"):
            rf.read_suite(path, **ARGUMENTS)
        by_rows = GroundMotion.read(path, component="row by row", **ARGUMENTS)
        first_column = GroundMotion.read(path, component="column 1", **ARGUMENTS)
        assert (len(by_rows), len(first_column)) == (300, 100)

    @pytest.mark.parametrize("last", [1, 4])
    def test_a_short_last_line_of_columns_is_refused(self, write, last):
        noise = np.random.default_rng(1).uniform(-0.1, 0.1, size=320 + last)
        text = rows(noise, 5)
        with pytest.raises(RecordError, match=f"{last} fields .* expected 5 fields"):
            GroundMotion.read(write(text, "r.txt"), component="column 1", **ARGUMENTS)


class TestReadingOrder:
    @pytest.mark.parametrize("columns", range(2, 11))
    def test_wrapped_example_motion_is_read_by_rows(self, columns):
        samples = GroundMotion.example("loma-prieta").si.horizontal.samples
        assert reading_order(table(samples, columns)) == ROWS

    @pytest.mark.parametrize(
        "name", [*FILES[::2], *(pytest.param(file, marks=pytest.mark.long) for file in FILES[1::2])]
    )
    def test_no_recorded_motion_is_taken_for_columns(self, name):
        orders = [
            reading_order(table(samples, columns))
            for samples, columns in itertools.product(components(name), range(2, 11))
        ]
        assert COLUMNS not in orders
        assert orders.count(ROWS) >= 0.3 * len(orders)

    @pytest.mark.parametrize(
        "stride", [5, *(pytest.param(step, marks=pytest.mark.long) for step in (1, 2, 10, 20))]
    )
    @pytest.mark.parametrize("name", SEVERAL)
    def test_no_components_are_taken_for_one_record(self, name, stride):
        recorded = components(name)
        for count in (2, 3):
            for chosen in itertools.permutations(recorded, count) if len(recorded) >= count else ():
                assert reading_order(np.stack(chosen, axis=1)[::stride]) != ROWS

    @pytest.mark.parametrize("shared", [0.0, 0.5, 0.9, 1.0])
    @pytest.mark.parametrize("memory", [-0.5, 0.0, 0.5, 0.9, 0.98])
    def test_noise_columns_are_not_mistaken_for_one_record(self, shared, memory):
        rng = np.random.default_rng(7)
        for columns in (2, 3, 6):
            own, common = rng.normal(size=(500, columns)), rng.normal(size=(500, 1))
            values = np.sqrt(1.0 - shared) * own + np.sqrt(shared) * common
            for row in range(1, 500):
                values[row] += memory * values[row - 1]
            assert reading_order(values) != ROWS
            assert reading_order(values + np.arange(columns)) != ROWS

    def test_smooth_columns_are_recognised(self):
        pulses = np.random.default_rng(3).normal(size=(600, 3)).cumsum(axis=0)
        assert reading_order(pulses) == COLUMNS
