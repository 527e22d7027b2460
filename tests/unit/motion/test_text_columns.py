"""Text of several columns, leading counts and time steps, stated steps, tables of spectra."""

import warnings

import numpy as np
import pytest
from unit.motion.motion_files import G, numbers

import rockframe as rf
from rockframe.command.main import main
from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

COUNT = 64
VALUES = numbers(COUNT)


def read(write, text, name="r.txt", **options):
    return GroundMotion.read(write(text, name), **options)


def column(head: str = "", values=VALUES) -> str:
    return head + "".join(f"{value:.7f}\n" for value in values)


def table(head: str, columns, separator=",", step=0.01) -> str:
    rows = zip(*columns, strict=True)
    return head + "".join(
        separator.join([f"{step * k:.2f}", *(f"{value:.7f}" for value in row)]) + "\n"
        for k, row in enumerate(rows)
    )


class TestSpectra:
    @pytest.mark.parametrize(
        "head",
        [
            "Period (s),Sa (g)\n",
            "T (s),PSA (g)\n",
            "T (s),Sa_RotD50 (g)\n",
            "T,Spectral acceleration (g)\n",
            "time (s),PSA (g)\n",
            "Tn (s),acceleration (g)\n",
            "Frequency (Hz),acceleration (g)\n",
            "# 5 % damped response spectrum (g)\n",
            "# design spectrum, units: g\n",
        ],
    )
    @pytest.mark.parametrize("separator", [",", " "])
    def test_a_table_of_a_spectrum_at_even_periods_is_refused(self, write, head, separator):
        text = table(head.replace(",", separator), [np.abs(VALUES)], separator)
        for options in ({}, {"unit": "g"}, {"format": "text", "unit": "g"}):
            with pytest.raises(RecordError, match="a spectrum") as caught:
                read(write, text, **options)
            assert caught.value.line == 1

    @pytest.mark.parametrize(
        "head",
        [
            "T (s),a (g)\n",
            "t,acc (g)\n",
            "# matched to the target spectrum\ntime (s),acc (g)\n",
            "# artificial, compatible with a response spectrum, unit: g\n",
            "# station Sa Pobla\ntime (s),acc (g)\n",
            "time (s),SV04 (g)\n",
        ],
    )
    def test_motions_are_not_taken_for_spectra(self, write, head):
        assert len(read(write, table(head, [VALUES]))) == COUNT


class TestStatedSteps:
    @pytest.mark.parametrize(
        ("head", "step"),
        [
            ("# dt = 0.005 s, unit: g\n", 0.005),
            ("# unit: g\n# DT=.01\n", 0.01),
            ("% time step (ms): 4, unit: g\n", 0.004),
            ("# Time Increment (s)   : 0.02\n# unit: g\n", 0.02),
            ("# sampling rate: 200 Hz, unit: g\n", 0.005),
            ("# Sampling Frequency (Hz) = 128\n# unit: g\n", 1.0 / 128.0),
        ],
    )
    def test_time_step_of_header_is_used(self, write, head, step):
        assert read(write, column(head)).si.time_step == step
        assert read(write, column(head), time_step=f"{step!r} s").si.time_step == step
        with pytest.raises(RecordError, match=r"line \d: .*expected the 0\.03 s given by"):
            read(write, column(head), time_step="0.03 s")

    @pytest.mark.parametrize("head", ["# dt = 10/2000 s\n", "# sampling rate = 0.25 kHz\n"])
    def test_time_step_in_other_notation_is_ignored(self, write, head):
        with pytest.raises(RecordError, match="no times"):
            read(write, column(head), unit="g")

    def test_times_override_header_time_step_with_warning(self, write):
        text = table("# dt = 0.005 s\ntime (s),acc (g)\n", [VALUES])
        with pytest.warns(RecordWarning, match=r"line 1: .* 0\.005 s, but the times are 0\.01 s"):
            assert read(write, text).si.time_step == 0.01


class TestNames:
    @pytest.mark.parametrize("head", [",time (s),acc (g)\n", "No,t (s),acc (g)\n"])
    def test_times_after_first_column_are_refused(self, write, head):
        text = head + "".join(f"{k},{0.01 * k:.2f},{a:.7f}\n" for k, a in enumerate(VALUES))
        for options in ({}, {"time_step": "0.02 s"}, {"time_step": "0.01 s", "component": "acc"}):
            with pytest.raises(RecordError, match=r"line 1: found the times 't.* after"):
                read(write, text, **options)

    def test_columns_v_and_d_are_not_read_as_vertical(self, write):
        path = write(table("t,a,v,d\n", [VALUES, 2.0 * VALUES, 3.0 * VALUES]), "r.csv")
        suite = rf.read_suite(path, unit="g")
        assert (list(suite), len(suite.verticals)) == (["r"], 0)
        with pytest.raises(RecordError, match="expected the component 'v'"):
            GroundMotion.read(path, unit="g", component="v")
        assert read(write, table("t,h,v\n", [VALUES] * 2), unit="g", component="v").si.peak > 0.0

    @pytest.mark.parametrize("unit", ["V", "mm/s^9", "cm//s^2"])
    def test_unknown_unit_is_not_replaced_by_that_of_other_column(self, write, unit):
        path = write(table(f"time (s),N ({unit}),E (g)\n", [VALUES, VALUES]), "r.csv")
        with pytest.raises(RecordError, match="the unknown unit"):
            GroundMotion.read(path, component="N")
        assert GroundMotion.read(path, component="E").si.peak == pytest.approx(G * VALUES.max())
        assert GroundMotion.read(path, component="N", unit="gal").metadata["unit_as_read"] == "gal"

    @pytest.mark.parametrize("head", ["time (s),N (g)\n", "t,N,E,vN (cm/s)\n", "time,N,E,U,\n"])
    def test_number_of_names_must_match_columns(self, write, head):
        path = write(table(head, [VALUES, VALUES]), "r.csv")
        with pytest.raises(RecordError, match=r"line 1: found \d names .* expected 3, as there"):
            rf.read_suite(path, unit="g")
        assert len(rf.read_suite(write(table("time,N,E\n", [VALUES] * 2), "r.csv"), unit="g")) == 2


class TestBreaks:
    @pytest.mark.parametrize("between", ["# a second record\n", "\n", "\n\n# more\n"])
    @pytest.mark.parametrize("columns", [1, 2])
    def test_interrupting_lines_among_samples_warn(self, write, between, columns):
        row = "".join(f"{value:.7f} " * columns + "\n" for value in VALUES)
        names = "# dt = 0.01 s\n" + "NS EW\n" * (columns == 2)
        options = {"unit": "g", "component": "NS" if columns == 2 else None}
        assert len(read(write, names + row, **options)) == COUNT
        first = names.count("\n") + COUNT + 1
        with pytest.warns(RecordWarning, match=rf"line {first}: .* among the numbers, in 1 places"):
            assert len(read(write, names + row + between + row, **options)) == 2 * COUNT

    def test_double_spaced_lines_are_one_record(self, write):
        assert len(read(write, column().replace("\n", "\n\n"), unit="g", time_step="0.02 s"))

    def test_second_record_with_restarting_times_is_refused(self, write):
        text = table("time (s),acc (g)\n", [VALUES])
        assert len(read(write, text.replace("0.30,", "# here\n0.30,"))) == COUNT
        with pytest.raises(RecordError, match=r"the time 0\.00 after 0\.63"):
            read(write, text + "# again\n" + text.split("\n", 1)[1])


class TestFirstLines:
    @pytest.mark.parametrize("first", ["0.01\n", ".0050\n", "0.02\n", "1e-2\n"])
    def test_time_step_above_column_is_not_read_as_sample(self, write, first):
        text = first + column()
        ambiguous = "e" not in first
        if ambiguous:
            with pytest.raises(RecordError, match="looks like a time step"):
                read(write, text, unit="g")
            with pytest.raises(RecordError, match="above the samples"):
                read(write, text, unit="g", time_step="0.5 s")
        with pytest.warns(RecordWarning, match="the time step"):
            motion = read(write, text, unit="g", time_step=f"{float(first)} s")
        assert len(motion) == COUNT + (not ambiguous)

    def test_small_first_sample_is_not_mistaken_for_time_step(self, write):
        motion = read(write, column(values=[0.005, *VALUES]), unit="g", time_step="0.01 s")
        assert len(motion) == COUNT + 1

    @pytest.mark.parametrize(
        "head", ["{n} 0.01\n", "0.01 {n}\n", "{n}\n0.01\n", "made up\n{n} 0.01\n", "# x\n{n} .01\n"]
    )
    @pytest.mark.parametrize("per_line", [1, 5, 8])
    def test_a_count_and_a_time_step(self, write, head, per_line):
        printed = [f"{value:.7f}" for value in VALUES]
        body = "\n".join(" ".join(printed[k : k + per_line]) for k in range(0, COUNT, per_line))
        motion = read(write, f"{head.format(n=COUNT)}{body}\n", unit="g")
        assert motion.si.horizontal.samples.tolist() == (VALUES * G).tolist()
        assert motion.si.time_step == 0.01
        with pytest.raises(RecordError, match=r"expected the 0\.02 s given by"):
            read(write, f"{head.format(n=COUNT)}{body}\n", unit="g", time_step="0.02 s")

    def test_wrong_leading_count_warns_or_is_refused(self, write):
        rows = "\n".join(" ".join(f"{v:.7f}" for v in VALUES[k : k + 8]) for k in range(0, 64, 8))
        with pytest.warns(RecordWarning, match="declares 66 samples, but the file holds 64"):
            read(write, f"66 0.01\n{rows}\n", unit="g")
        with pytest.raises(RecordError, match="expected 640 samples"):
            read(write, f"640 0.01\n{rows}\n", unit="g")


class TestColumns:
    COLUMNS = (VALUES, 0.5 * VALUES, -0.25 * VALUES)

    def test_three_components_with_names(self, write):
        text = table("time (s),N (g),E (g),DWN (g)\n", self.COLUMNS)
        motion = read(write, text, component=("N", "U"))
        assert motion.si.horizontal.samples.tolist() == (VALUES * G).tolist()
        np.testing.assert_allclose(motion.si.vertical.samples, 0.25 * VALUES * G, atol=1e-6)
        assert motion.history[-1] == "component DWN turned over: positive upwards"
        with pytest.raises(RecordError, match=r"3 components: 'N' .*, 'E' .*, 'DWN'"):
            read(write, text)

    def test_component_names_of_other_styles_are_recognised(self, write):
        text = table("Time,acc_x,HNE,Acc_Z\ns,m/s2,m/s2,m/s2\n", self.COLUMNS)
        assert read(write, text, component="acc_x").si.horizontal.samples[3] == VALUES[3]
        assert read(write, text, component="E").metadata["component"] == "HNE"
        assert read(write, text, component="U").metadata["component"] == "Acc_Z"

    @pytest.mark.parametrize(
        "name",
        [
            "up_acceleration [m s^-2]",
            "UD ground acceleration (m/s2)",
            "Up Acc. (m/s2)",
            "z accel (m/s2)",
            "acceleration up component (m/s2)",
            "up 1 (m/s2)",
            "az (m/s2)",
            "AccZ (m/s2)",
        ],
    )
    def test_direction_before_the_word_acceleration_is_recognised(self, write, name):
        text = table(f"time [s],acceleration [m s^-2],{name}\n", self.COLUMNS[:2])
        motion = read(write, text)
        assert motion.metadata["component"] == "acceleration"
        assert motion.si.horizontal.samples.tolist() == VALUES.tolist()
        vertical = read(write, text, component="U")
        np.testing.assert_allclose(vertical.si.horizontal.samples, 0.5 * VALUES, atol=1e-6)

    def test_a_number_of_a_component_is_no_azimuth(self, write):
        text = table("time [s],Horizontal 1 (g),Horizontal 2 (g),Vertical (g)\n", self.COLUMNS)
        motion = read(write, text, component="Horizontal 2")
        assert "azimuth" not in motion.metadata
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RecordWarning)
            suite = rf.read_suite(write(text, "r.txt"))
        assert len(suite.pairs) == len(suite.verticals) == 1

    def test_converted_vertical_component_is_read_as_vertical(self, tmp_path):
        both = rf.GroundMotion.from_arrays(
            (VALUES, "m/s^2"), "0.01 s", vertical=(0.5 * VALUES, "m/s^2"), name="both"
        )
        both.to_dataset().to_netcdf(tmp_path / "both.nc")
        assert main(["convert", str(tmp_path / "both.nc"), "-o", str(tmp_path / "both.csv")]) == 0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RecordWarning)
            suite = rf.read_suite(tmp_path / "both.csv")
        assert len(suite) == len(suite.verticals) == 1
        assert not suite.pairs

    def test_columns_without_times_need_time_step(self, write):
        rows = "".join(f"{a:.7f} {b:.7f} {c:.7f}\n" for a, b, c in zip(*self.COLUMNS, strict=True))
        named = "N  E  Z\n" + rows
        motion = read(write, named, component="E", unit="g", time_step="0.02 s")
        assert (motion.si.time_step, motion.metadata["azimuth"]) == (0.02, 90.0)
        bare = read(write, rows, component="column 2", unit="g", time_step="0.02 s")
        assert bare.sha256 == motion.sha256
        with pytest.raises(RecordError, match="no times"):
            read(write, named, component="E", unit="g")

    def test_rising_unnamed_column_is_read_as_times(self, write):
        text = table("", self.COLUMNS)
        motion = read(write, text, component="column 3", unit="g")
        assert motion.si.time_step == 0.01
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.5 * VALUES * G, atol=1e-6)

    def test_velocity_and_displacement_columns_are_ignored(self, write):
        head = "Time (s),Acceleration (g),Velocity (cm/s),Displacement (cm)\n"
        motion = read(write, table(head, self.COLUMNS))
        assert motion.si.horizontal.samples.tolist() == (VALUES * G).tolist()
        with pytest.raises(RecordError, match="expected accelerations"):
            read(write, table("time (s),vx (cm/s),vy (cm/s),vz (cm/s)\n", self.COLUMNS))


def test_short_final_zero_is_not_mistaken_for_cut_number(write):
    rows = [f"{0.02 * k:20.15f}{value:20.15f}" for k, value in enumerate(VALUES)]
    text = "\n".join(rows[:-1]) + f"\n{0.02 * (COUNT - 1):20.15f}{'0':>20}"
    motion = read(write, text, unit="g")
    assert len(motion) == COUNT
    assert motion.si.horizontal.samples[-1] == 0.0
    with pytest.raises(RecordError, match="inside a number"):
        read(write, "\n".join(rows)[:-3], unit="g")
