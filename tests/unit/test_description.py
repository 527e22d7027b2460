"""Descriptions of systems: model, numbers and limits."""

import math
import re

import numpy as np
import pytest
from scipy import linalg
from unit.usual_scenes import SCENES, assembled, block, cap, pads, soil

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.unit


# description -----------------------------------------------------------------------------------


class TestDescription:
    def test_describes_two_springs(self):
        text = rf.System(block(), pads(restitution=0.8)).describe()
        theta = math.atan(0.25)
        radius = math.sqrt(17.0)
        omega = math.sqrt(0.75 * 9.80665 / radius)
        uplift = math.asin(4.0 / (3.0 * 400.0 * math.sin(theta)))
        stiffness = 0.5 * 5e4 * (20.0 * omega) ** 2
        base = 5e4 * (17.0 / 3.0 + 16.0)
        rocking = math.sqrt((2.0 * stiffness - 5e4 * 9.80665 * 4.0) / base)
        damping = 0.1 * 5e4 * 20.0 * omega
        for word in (
            "Model: two-spring",
            "Block(",
            "TwoSpringSupport(",
            f"{theta:.6g} rad",
            f"{uplift:.6g} rad",
            f"{omega:.6g} rad/s",
            f"{20.0 * omega:.6g} rad/s",
            f"{rocking:.6g} rad/s",
            f"period {2.0 * math.pi / rocking:.6g} s",
            "damping ratio 0.1",
            f"damping ratio {damping / (base * rocking):.6g}",
            f"{stiffness:.6g} N/m",
            f"{0.5 * 5e4 * 9.80665 / stiffness:.6g} m",
            "0.8",
            "Eq. (12)",
            "Eq. (15)",
            "Eqs. (2)-(4)",
            "sliding",
            "tension",
            "Winkler Foundation",
        ):
            assert word in text, word
        states = re.findall(r"^  (full|left|right|flight|impact) ", text, re.MULTILINE)
        assert states == ["full", "left", "right", "flight", "impact"]

    @pytest.mark.parametrize("base", [pads, soil])
    def test_rocking_mode_of_an_eccentric_body(self, base):
        """As it rocks about the middle of its base, its centre of mass rises and falls."""
        part, b, e, mass = base(), 1.0, 0.1, 5e4
        eccentric = block(centre_of_mass=("4 m", f"{e} m"))
        system = rf.System(eccentric, part)
        support = system.setting.support
        # about the foot of the centre of mass: rise, and rotation
        matrix = np.array([[2.0, -2.0 * e], [-2.0 * e, 2.0 * (b * b + e * e)]])
        if base is soil:
            matrix = np.array(
                [[2.0 * b, -2.0 * b * e], [-2.0 * b * e, 2.0 * b * (b * b / 3 + e * e)]]
            )
        inertias = np.diag([mass, eccentric.si.inertia + mass * 4.0**2])
        springs, dashpots = support.stiffness * matrix, support.damping * matrix
        springs[1, 1] -= mass * 9.80665 * 4.0
        squares, shapes = linalg.eigh(springs, inertias)
        rate, shape = math.sqrt(squares[0]), shapes[:, 0]
        ratio = shape @ dashpots @ shape / (2.0 * rate)
        match = re.search(
            r"omega_r = (\S+) rad/s .*?damping ratio (\S+)", system.describe(), re.DOTALL
        )
        assert [float(one) for one in match.groups()] == pytest.approx([rate, ratio], rel=1e-5)
        mode = system.frequencies().isel(mode=0)
        found = [mode.angular_frequency.item(), mode.damping_ratio.item()]
        assert found == pytest.approx([rate, ratio], rel=1e-3)

    def test_describes_rigid_ground(self):
        text = rf.System(block()).describe()
        for word in (
            "Model: rigid ground",
            "omega^2",
            "sin(theta s - a)",
            "Housner",
            f"{9.80665 * 0.25:.4g} m s^-2",
            f"{1.0 - 1.5 / 17.0:.6g}",
            "sliding",
            "flight",
        ):
            assert word in text, word

    @pytest.mark.parametrize("capped", [False, True])
    def test_describes_soil(self, capped):
        parts = (block(), soil(), cap()) if capped else (block(), soil())
        text = rf.System(*parts).describe()
        mass, half, centre = 5e4, 1.0, 4.0
        about_base = 5e4 * (4.0 + 64.0) / 12.0 + 5e4 * 16.0
        if capped:
            mass, half = 7e4, 1.25
            centre = (5e4 * 4.4 + 2e4 * 0.2) / mass
            about_base = 5e4 * (68.0 / 12.0 + 4.4**2) + 2e4 * ((2.5**2 + 0.16) / 12.0 + 0.04)
        settled = 0.5 * mass * 9.80665 / (half * 9e6)
        vertical = math.sqrt(2.0 * half * 9e6 / mass)
        damping = 0.2 * mass * vertical / half
        rocking = math.sqrt((9e6 * half**3 / 1.5 - mass * 9.80665 * centre) / about_base)
        ratio = damping * half**3 / 3.0 / about_base / rocking
        for word in (
            "Model: Winkler",
            "WinklerSoil(",
            "CushionCap(" if capped else "Block(",
            f"{mass:.6g} kg",
            f"centre {centre:.6g} m",
            f"{9e6:.6g} Pa",
            f"{damping:.6g} Pa s",
            f"settlement delta                    {settled:.6g} m",
            f"{math.atan(half / centre):.6g} rad",
            f"{math.asin(settled / half):.6g} rad",
            f"omega_v = {vertical:.6g} rad/s",
            f"omega_r = {rocking:.6g} rad/s",
            f"period {2.0 * math.pi / rocking:.6g} s",
            "damping ratio 0.2",
            f"damping ratio {ratio:.6g}",
            "Eq. (18)",
            "Eq. (19)",
            "without impact law",
            "sliding",
        ):
            assert word in text, word
        states = re.findall(r"^  (full|left, right|flight|contact) ", text, re.MULTILINE)
        assert states == ["full", "left, right", "flight", "contact"]

    def test_describes_a_block_and_cap_stack(self):
        coupled = rf.System(block(), pads(), cap(), soil()).describe()
        cascade = rf.System(block(), pads(), cap(), soil(), coupling="cascade").describe()
        omega = math.sqrt(0.75 * 9.80665 / math.sqrt(17.0))
        for text in (coupled, cascade):
            for word in (
                "TwoSpringSupport(",
                "CushionCap(",
                f"{math.atan(0.25):.6g} rad",
                f"{20.0 * omega:.6g} rad/s",
                "2.5 m by 0.4 m, 20000 kg",
                "70000 kg",
                f"omega_v = {math.sqrt(2.5 * 9e6 / 7e4):.6g} rad/s",
                "Eq. (16)",
                "Eq. (18a)",
                "Eqs. (2)-(4)",
                "of the block on the cap and of the cap on the soil alike",
                "tension",
                "Winkler Foundation",
                "yielding of the soil",
            ):
                assert word in text, word
        assert "Model: coupled" in coupled
        assert "four degrees of freedom" in coupled
        assert "impulse between block and cap" in coupled
        assert "Eq. (20)" not in coupled
        assert "Model: cascade" in cascade
        assert "Eq. (20)" in cascade
        for stage in ("stage 1, full", "stage 1, flight", "stage 2, full", "stage 2, impact"):
            assert stage in cascade
        assert "what the block's motion on the pads does to cap and soil" in cascade

    @pytest.mark.parametrize("name", ["Winkler", "Winkler with a cap", "coupled", "cascade"])
    @pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
    def test_of_soil_names_the_restraint_rule(self, name, rule):
        text = assembled(name, restraint=rule).describe()
        others = {"contact-state", "leading-corner", "centre"} - {rule}
        assert f"{rule}:" in text
        assert not any(f"{other}:" in text for other in others)

    def test_soil_description_states_the_separation_rule(self):
        texts = {
            separation: rf.System(block(), soil(separation=separation)).describe()
            for separation in ("displacement", "pressure")
        }
        assert "above the level of the unloaded bed" in texts["displacement"]
        assert "dashpots would pull" not in texts["displacement"]
        assert "dashpots would pull" in texts["pressure"]

    def test_soil_too_soft_to_uplift_says_never(self):
        with pytest.warns(ModelWarning, match="too soft") as caught:
            system = rf.System(block(), soil(stiffness="0.2 MPa"))
        assert caught[0].filename == __file__
        assert "never" in system.describe()
        with pytest.warns(ModelWarning, match="too soft"):
            rf.System(block(), pads(), cap(), soil(stiffness="0.2 MPa"))

    @pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
    def test_names_the_restraint_rule(self, rule):
        assert rule in rf.System(block(), pads(), restraint=rule).describe()
        others = {"contact-state", "leading-corner", "centre"} - {rule}
        text = rf.System(block(), pads(), restraint=rule).describe()
        assert not any(f"{other}:" in text for other in others)

    def test_says_when_rotations_are_small(self):
        for name, parts in SCENES.items():
            small = assembled(name, rotation="small").describe()
            assert "small rotation" in small
            assert small != assembled(name).describe()
            if len(parts) < 3 and "Winkler" not in name:  # Eq. (18) is cited for small rotations
                assert "small rotation" not in assembled(name).describe()

    def test_states_gravity(self):
        moon = rf.System(block(), pads(), gravity="1.62 m/s^2").describe()
        omega = math.sqrt(0.75 * 1.62 / math.sqrt(17.0))
        assert f"{omega:.6g} rad/s" in moon
        assert "1.62" in moon

    @pytest.mark.parametrize("coupling", ["coupled", "cascade"])
    def test_stack_description_assigns_uplift_angles(self, coupling):
        parts = (block(), pads(), cap(), soil())
        system = rf.System(*parts, coupling=coupling)
        rest = system.equilibrium()
        text = re.sub(r"\s+", " ", system.describe())
        on_soil = float(rest.soil_settlement) / 1.25
        for words in (
            f"uplift angle on the pads, Eq. (16) {float(rest.uplift_angle):.6g} rad",
            f"of block against cap, at a moment of {float(rest.uplift_moment):.6g} N m",
            f"uplift angle on the soil, arcsin(delta/b) {math.asin(on_soil):.6g} rad",
            f"of cap against ground, at a moment of {float(rest.soil_uplift_moment):.6g} N m",
        ):
            assert words in text, words
        assert text.count("uplift angle") == 2
        with pytest.warns(ModelWarning, match="too soft"):
            soft = rf.System(block(), pads(), cap(), soil(stiffness="0.1 MPa"), coupling=coupling)
        assert "arcsin(delta/b) never" in re.sub(r" +", " ", soft.describe())

    def test_is_aligned_in_two_columns(self):
        for name in SCENES:
            lines = assembled(name).describe().splitlines()
            assert max(len(line) for line in lines) <= 100
            numbers = lines[lines.index("Numbers:") + 1 : lines.index("Left out:")]
            names = [line for line in numbers if not line.startswith("   ")]
            starts = {re.match(r"  (?:\S+ )*\S+  +", line).end() for line in names}
            assert len(starts) == 1, name
            (start,) = starts
            for line in numbers:
                assert line[start] != " ", line
                if line not in names:  # a continued line is indented below its beginning
                    assert not line[:start].strip()

    def test_is_plain_text(self):
        for name in SCENES:
            text = assembled(name).describe()
            assert text.replace("°", "").isascii()
            assert "nan" not in text
            assert not any(line != line.rstrip() for line in text.splitlines())
            assert not text.endswith("\n")
