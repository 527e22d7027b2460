"""HTML that notebooks show for parts, systems and motions: a drawing and a table of numbers.

Texts have the colour of the page, so that they are legible on light and dark pages.
"""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any, Final, NamedTuple, cast

_PREFIXES: Final = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
_PREFIXED_UNITS: Final = ("Pa", "N", "J")
"""Large values in these units, or in units that begin with them, are written with a prefix."""
_DOT_STYLE: Final = 'stroke="currentColor" fill="currentColor"'
_FILLS: Final = {
    "block": 'fill="#0072b2" fill-opacity="0.25" stroke="#3a8fc7"',
    "member": 'fill="#0072b2" fill-opacity="0.35" stroke="#3a8fc7"',
    "cap": 'fill="#e69f00" fill-opacity="0.35" stroke="#e69f00"',
    "pad": 'fill="#808080" fill-opacity="0.6" stroke="#808080"',
    "soil": 'fill="#a6794f" fill-opacity="0.35" stroke="#a6794f"',
    "ground": 'fill="#808080" fill-opacity="0.35" stroke="none"',
}
_DRAWING_SIZE: Final = 130.0
"""Greater of width and height of a drawing, without its margins [px]."""
TABLE_STYLE: Final = "border-collapse:collapse;color:inherit;margin:0;font-size:inherit"
CELL_STYLE: Final = "text-align:left;padding:1px 12px 1px 0;background:transparent;border:none"


class Polygon(NamedTuple):
    """A polygon, or a dot if it has one point."""

    fill: str
    points: Sequence[tuple[float, float]]


def rectangle(
    half_width: float, height: float, x: float = 0.0, y: float = 0.0
) -> list[tuple[float, float]]:
    """Return the corners of a rectangle that stands on the middle of its lower side, at x and y."""
    left, right, top = x - half_width, x + half_width, y + height
    return [(left, y), (right, y), (right, top), (left, top)]


def readable_arguments(arguments: Mapping[str, Any]) -> dict[str, str]:
    """Return the names and values of arguments as texts to read, without long ones."""
    texts = {name.replace("_", " "): _formatted(value) for name, value in arguments.items()
             if name != "type"}  # fmt: skip
    return {name: words for name, words in texts.items() if len(words) <= _MAX_LENGTH}


_MAX_LENGTH: Final = 60


def html_summary(title: str, rows: Mapping[str, str], drawing: str = "", extra: str = "") -> str:
    """Return a title, a drawing and a table of names and values as HTML."""
    cells = "".join(
        '<tr style="background:transparent">'
        f'<th style="{CELL_STYLE};font-weight:normal;opacity:0.7">{escape(name)}</th>'
        f'<td style="{CELL_STYLE}">{escape(value)}</td></tr>'
        for name, value in rows.items()
    )
    table = f'<table style="{TABLE_STYLE}"><tbody>{cells}</tbody></table>' if cells else ""
    return (
        '<div style="display:flex;gap:16px;align-items:flex-start">'
        f"{drawing}<div><div><b>{escape(title)}</b></div>{table}{extra}</div></div>"
    )


def shapes_svg(shapes: Iterable[Polygon]) -> str:
    """Draw polygons to scale."""
    values = list(shapes)
    places = [point for shape in values for point in shape.points]
    left, right = min(x for x, _ in places), max(x for x, _ in places)
    low, high = min(y for _, y in places), max(y for _, y in places)
    scale = _DRAWING_SIZE / max(right - left, high - low, 1e-12)

    def at(point: tuple[float, float]) -> tuple[float, float]:
        return 4.0 + scale * (point[0] - left), 4.0 + scale * (high - point[1])

    drawn = "".join(_svg_element(shape, [at(point) for point in shape.points]) for shape in values)
    width, height = scale * (right - left) + 8.0, scale * (high - low) + 8.0
    return _svg(width, height, drawn)


def sparkline(values: Sequence[float], *, width: float = 260.0, height: float = 60.0) -> str:
    """Draw values over time."""
    peak = max((abs(value) for value in values), default=0.0) or 1.0
    count = len(values)
    step = max(1, -(-count // 300))
    ends = [
        (k, extreme) for k in range(0, count, step) for extreme in _extremes(values[k : k + step])
    ]
    points = " ".join(
        f"{width * k / max(count - 1, 1):.1f},{0.5 * height - 0.48 * height * value / peak:.1f}"
        for k, value in ends
    )
    axis = f'<path d="M0 {0.5 * height:.1f}H{width:.0f}" stroke="currentColor" opacity="0.3"/>'
    line = f'<polyline points="{points}" fill="none" stroke="#3a8fc7" stroke-width="1"/>'
    return _svg(width, height, axis + line)


def _extremes(values: Sequence[float]) -> tuple[float, ...]:
    return (values[0],) if len(values) == 1 else (min(values), max(values))


def _svg(width: float, height: float, drawn: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.1f} {height:.1f}" style="flex:none">{drawn}</svg>'
    )


def _svg_element(shape: Polygon, points: Sequence[tuple[float, float]]) -> str:
    if len(points) == 1:
        ((x, y),) = points
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" {_DOT_STYLE}/>'
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polygon points="{corners}" {_FILLS[shape.fill]}/>'


def _formatted(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return ", ".join(map(_formatted, cast("list[Any]", value)))
    number, _, unit = str(value).partition(" ")
    try:
        size = float(number)
    except ValueError:
        return str(value)
    return number_with_unit(size, unit)


def number_with_unit(size: float, unit: str) -> str:
    """Write a number in an SI unit with a prefix: 99 t, 9 MPa, 250 kN m^-1."""
    if unit == "kg" and abs(size) >= 1e3:
        return f"{1e-3 * size:.6g} t"
    if unit.split(" ")[0] in _PREFIXED_UNITS:
        for factor, prefix in _PREFIXES:
            if abs(size) >= factor:
                return f"{size / factor:.6g} {prefix}{unit}"
    return f"{size:.6g} {unit}".rstrip()
