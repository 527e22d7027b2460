"""Free bodies of the theory's pages: what acts on a block on pads, on a bed, and on a cap."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

INK = "#1f3a5f"
FORCE = "#a3261f"
_PAPER = "#e8eef5"
_B, _H = 1.0, 2.0


class _Body:
    """A body that is drawn about a turned middle of its base, with forces at its points."""

    def __init__(
        self, axes: Axes, middle: Sequence[float], angle: float, size: tuple[float, float]
    ) -> None:
        self.axes, self.middle, self.size = axes, np.array(middle), size
        self.t = np.array([np.cos(angle), -np.sin(angle)])
        self.n = np.array([np.sin(angle), np.cos(angle)])

    def at(self, s: float, height: float) -> np.ndarray:
        return self.middle + s * self.t + height * self.n

    def outline(self) -> None:
        half, whole = self.size
        corners = [self.at(s, z) for s, z in
                   ((-half, 0.0), (half, 0.0), (half, whole), (-half, whole))]  # fmt: skip
        self.axes.add_patch(Polygon(corners, facecolor=_PAPER, edgecolor=INK, lw=1.6))

    def point(self, s: float, height: float, name: str, shift: tuple[float, float]) -> None:
        place = self.at(s, height)
        self.axes.plot(*place, "o", color=INK, ms=4)
        self.axes.text(*(place + shift), name, color=INK)

    def force(
        self,
        place: np.ndarray,
        towards: Sequence[float] | np.ndarray,
        name: str,
        shift: tuple[float, float],
        *,
        tip: bool = False,
    ) -> None:
        """Draw an arrow that begins at a place, or ends there."""
        end = place + np.asarray(towards)
        start = place
        if tip:
            start, end = place - np.asarray(towards), place
        arrow = {"arrowstyle": "-|>", "color": FORCE, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", end, start, arrowprops=arrow)
        free = start if tip else end
        self.axes.text(*(free + shift), name, color=FORCE)


def two_pads_forces() -> Figure:
    """Draw the forces on a block on two pads, {eq}`eq-pad-force`, both of which bear."""
    figure, axes = _sheet(4.2, (-2.3, 2.3), (-1.5, 4.6))
    body = _on_ground(axes, 0.12)
    up = (0.0, 0.95)
    body.force(body.at(-_B, 0.0), (0.0, 0.55), "$N_L$", (-0.15, -0.35), tip=True)
    body.force(body.at(_B, 0.0), up, "$N_R$", (-0.15, -0.35), tip=True)
    _held(body)
    return figure


def winkler_bed_forces() -> Figure:
    """Draw the forces on a body on a bed whose left end is raised, {eq}`eq-bed`."""
    figure, axes = _sheet(4.2, (-2.3, 2.3), (-1.5, 4.6))
    body = _on_ground(axes, 0.12)
    _pressure(body, _B, np.linspace(-0.35, _B, 8))
    axes.text(0.85, -1.3, "$p(s)$", color=FORCE)
    axes.annotate("$u=0$", body.at(-0.35, 0.0), (-1.5, -0.75), color=INK,
                  arrowprops={"arrowstyle": "-", "color": INK, "lw": 0.8})  # fmt: skip
    _held(body)
    return figure


def coupled_forces() -> Figure:
    """Draw the forces on a block and on the cap below it, cut apart at the pads."""
    figure, axes = _sheet(5.4, (-3.0, 3.0), (-3.4, 5.5))
    cap = _Body(axes, (0.0, -2.0), 0.07, (1.9, 0.8))
    block = _Body(axes, (0.25, 0.75), 0.2, (_B, 2 * _H))
    for body, names in ((block, ("O", "$m\\,g$")), (cap, ("C", "$m_c\\,g$"))):
        body.outline()
        half = body.size[1] / 2
        body.point(0.0, half, names[0], (-0.35, 0.05))
        body.force(body.at(0.0, half), (0.0, -0.95 if body is block else -0.3), names[1],
                   (0.1, 0.05))  # fmt: skip
    for s, name in ((-_B, "L"), (_B, "R")):
        length = 0.45 if name == "L" else 0.75
        block.force(block.at(s, 0.0), length * cap.n, f"$N_{name}$", (-0.6, 0.0), tip=True)
        # the same force backwards, where the pad stands on the cap
        top = cap.at(s + 0.15, cap.size[1])
        cap.force(top, -length * cap.n, f"$N_{name}$", (0.15, -0.1), tip=True)
    block.force(block.at(0.0, 0.0), 0.8 * cap.t, "$P$", (-0.35, 0.15))
    cap.force(cap.at(0.15, cap.size[1]), -0.8 * cap.t, "$P$", (-0.1, 0.12))
    _pressure(cap, 1.9, np.linspace(-0.9, 1.9, 11), largest=0.6)
    axes.text(1.3, -3.1, "$p(s)$", color=FORCE)
    cap.force(cap.at(-1.9, 0.0), (0.75, 0.0), "$H_s$", (-0.4, -0.05), tip=True)
    return figure


def _sheet(
    height: float, across: tuple[float, float], upwards: tuple[float, float]
) -> tuple[Figure, Axes]:
    width = height * (across[1] - across[0]) / (upwards[1] - upwards[0])
    figure = Figure(figsize=(width + 0.6, height), layout="constrained", facecolor="white")
    axes = figure.subplots()
    axes.set(xlim=across, ylim=upwards, aspect="equal")
    axes.axis("off")
    return figure, axes


def _on_ground(axes: Axes, angle: float) -> _Body:
    """Draw a block, its centre of mass and its weight."""
    body = _Body(axes, (0.0, 0.0), angle, (_B, 2 * _H))
    body.outline()
    body.point(0.0, _H, "O", (-0.3, 0.05))
    body.force(body.at(0.0, _H), (0.0, -1.0), "$m\\,g$", (0.1, 0.05))
    body.point(-_B, 0.0, "L", (-0.3, 0.05))
    body.point(_B, 0.0, "R", (0.15, 0.05))
    return body


def _held(body: _Body) -> None:
    """Draw the horizontal reaction at the point that is held, here the middle of the base."""
    body.force(body.at(0.0, 0.0), (0.75, 0.0), "$H$", (-0.35, 0.1))


def _pressure(body: _Body, half: float, places: np.ndarray, *, largest: float = 0.85) -> None:
    """Draw a pressure upwards that grows from nothing at the first place to the end."""
    lengths = largest * (places - places[0]) / (half - places[0])
    feet = np.array([body.at(s, 0.0) for s in places])
    tails = feet - np.column_stack([np.zeros_like(lengths), lengths])
    for foot, length in zip(feet[1:], lengths[1:], strict=True):
        body.force(foot, (0.0, length), "", (0.0, 0.0), tip=True)
    body.axes.plot(*tails.T, color=FORCE, lw=1.0)
