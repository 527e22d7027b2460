"""Blocks of one shape and all sizes, by their rocking period and slenderness."""

import math
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.components import Block
from rockframe.errors import ComponentError, heard, shown
from rockframe.results.dataset import build_dataset
from rockframe.results.variables.studies import CASE
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System
from rockframe.studies.sweeps.axes import numbers_of
from rockframe.units import LENGTH, PERIOD, Measure, Unit

SIZE: Final = ("slenderness", "rocking_period")
_SLENDER: Final = Measure("a pure ratio", Unit.ONE, "4")
_ROUNDING: Final = 1e-9
"""Relative to the height: a centre of mass that is less beside the middle is there."""


class BlockSizes:
    """A system whose block has other sizes.

    Its attribute ``system`` is that system, with the block told by its shape factor.
    """

    def __init__(self, system: System, periods: Any, slenderness: Any, *, owner: str) -> None:
        self.system = _by_shape_factor(system, _block(system, owner))
        si = self.system.parts.the_block
        self.periods = _above_zero(periods, PERIOD, "periods", owner)
        ratio = si.height / si.width
        given = [ratio] if slenderness is None else slenderness
        self.slenderness = _above_zero(given, _SLENDER, "slenderness", owner)
        # omega^2 = mu g / ((1 + mu) R0), Eq. (6)
        scale = si.frequency_at(system.gravity_si) ** 2 * si.radius
        radius = scale * (0.5 * self.periods / math.pi) ** 2
        angle = np.arctan(1.0 / self.slenderness)
        self.width = 2.0 * np.sin(angle)[:, None] * radius
        self.height = 2.0 * np.cos(angle)[:, None] * radius

    @property
    def columns(self) -> dict[str, tuple[Array, str]]:
        """Sizes, in rows of a table: slenderness by slenderness."""
        unit = str(LENGTH.unit)
        return {"width": (self.width.ravel(), unit), "height": (self.height.ravel(), unit)}

    def arranged(self, runs: xr.Dataset) -> xr.Dataset:
        """Give what runs over the rows of the table the dimensions of the sizes."""
        shape = {
            "slenderness": len(self.slenderness),
            "rocking_period": len(self.periods),
        }
        found: dict[str, xr.Variable] = {}
        for name, one in runs.variables.items():
            if name != CASE:
                found[str(name)] = one.unstack({CASE: shape}) if CASE in one.dims else one
                dims = [dim for dim in SIZE if dim in found[str(name)].dims]
                others = [dim for dim in found[str(name)].dims if dim not in dims]
                found[str(name)] = found[str(name)].transpose(*dims, *others)
        labels = build_dataset(
            {"slenderness": self.slenderness, "rocking_period": self.periods}, {}
        )
        coordinates = [name for name in runs.coords if name != CASE]
        made = xr.Dataset(found, attrs=runs.attrs).set_coords(coordinates)
        return made.assign_coords(labels.coords)


def _by_shape_factor(system: System, block: Block) -> System:
    """Give a system whose block keeps its shape factor where width and height change.

    An inertia and a height of the centre of mass that were given would stay as they are.
    """
    if block.given.inertia is None and block.given.centre_height is None:
        return system
    with heard():  # block and system have warned when they were made
        scaling = block.replace(shape_factor=block.shape_factor, centre_height=None)
        others = [part for part in system.parts.structural() if part is not block]
        return System(
            scaling,
            *others,
            restraint=system.restraint,
            rotation=system.rotation,
            gravity=system.gravity,
            inclination=system.inclination,
        )


def _block(system: System, owner: str) -> Block:
    block = system.parts.block
    fault = ""
    if block is None or type(block) is not Block:
        fault = f"a {type(block).__name__}"
    elif not _in_the_middle(block):
        fault = "a block whose centre of mass is not in its middle"
    elif system.parts.cap is not None:
        fault = "a scene with a cap"
    if fault or block is None:
        msg = f"{owner}: system needs a block of width and height on its base, got {fault}"
        raise ComponentError(msg)
    return block


def _in_the_middle(block: Block) -> bool:
    si = block.si
    above = abs(si.centre_height - si.half_height)
    return si.eccentricity == 0.0 and above <= _ROUNDING * si.height


def _above_zero(given: Any, measure: Measure, name: str, owner: str) -> Array:
    values = np.unique(numbers_of(given, measure, name))
    if not len(values) or values[0] <= 0.0:
        msg = f"{owner}: {name} must be above zero, got {shown(given)}"
        raise ComponentError(msg)
    return values
