"""Similar scenes of another size and mass, and comparison of their results.

Lengths are multiplied by L, masses by M and times by sqrt(L), accelerations are unchanged; all
other quantities scale by their dimension, see :func:`factor`. With L a power of four and M a power
of two all numbers keep their digits, except where a library rounds a square differently.
"""

import math
import re
from functools import cache

import numpy as np
import pint

import rockframe as rf

QUANTITY = re.compile(r"([-+0-9.e]+) (\S.*)")
PLACE = re.compile(r"\((\S+), (\S+)\) m")
NUMBER = re.compile(r"[-+]?\d[\d.e+-]*")
COUNTS = ("solver_steps", "solver_rejected_steps")
AS_THEY_ARE = ("accuracy", "outputs", "overturning", "second_look")


@cache
def dimensions(unit):
    """Return the powers of mass, length and time in a unit."""
    powers = pint.application_registry.Quantity(1.0, unit.replace(" ", "*")).dimensionality
    return [powers.get(f"[{name}]", 0) for name in ("mass", "length", "time")]


def factor(unit, length, mass):
    """Return the scale factor of a number with a unit."""
    if unit in (None, "", "1", "rad"):
        return 1.0
    heavy, long, lasting = dimensions(unit)
    return mass**heavy * length ** (long + 0.5 * lasting)


def scaled(value, length, mass):
    """Return arguments, or descriptions of parts, with all quantities in another size."""
    if isinstance(value, dict):
        return {name: scaled(one, length, mass) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [scaled(one, length, mass) for one in value]
    if not isinstance(value, str):
        return value
    if place := PLACE.fullmatch(value):
        return "({!r}, {!r}) m".format(*(length * float(one) for one in place.groups()))
    if found := QUANTITY.fullmatch(value):
        return f"{factor(found[2], length, mass) * float(found[1])!r} {found[2]}"
    return value


def similar_system(system, length, mass):
    """Return a system in another size."""
    return rf.System.from_dict(scaled(system.to_dict(), length, mass))


def similar_motion(motion, length, nudge=0.0):
    """Return the same accelerations with a scaled time step, or nudged."""
    step, vertical = f"{math.sqrt(length) * motion.si.time_step!r} s", motion.si.vertical
    up = {} if vertical is None else {"vertical": (vertical.samples, "m/s^2")}
    across = (1.0 + nudge) * motion.si.horizontal.samples
    return rf.GroundMotion.from_arrays((across, "m/s^2"), step, **up)


def similar_arguments(arguments, length, mass):
    """Return the arguments of a run in another size."""
    scaled_arguments = {
        name: value if name in AS_THEY_ARE else scaled(value, length, mass)
        for name, value in arguments.items()
    }
    if arguments.get("initial") is not None:
        start = scaled(arguments["initial"].to_dict(), length, mass)
        scaled_arguments["initial"] = rf.InitialState.from_dict(start)
    return scaled_arguments


def without_numbers(text):
    """Return a text with all numbers removed."""
    return NUMBER.sub("#", str(text))


def differences(one, other, length, mass):
    """Return the differences between two datasets, the other one scaled back.

    By name, the greatest difference over the greatest value; infinite if not a number.
    """
    alike = {name: one.attrs.get(name) == other.attrs.get(name) for name in COUNTS}
    alike["sizes"] = one.sizes == other.sizes and set(one.variables) == set(other.variables)
    # not the verdict, which mentions slips above a micrometre
    texts = (without_numbers(each.attrs.get("cautions")) for each in (one, other))
    alike["cautions"] = len(set(texts)) == 1
    differences_found = {name: math.inf for name, same in alike.items() if not same}
    for name in set(one.variables) & set(other.variables):
        ours, theirs = one[name].to_numpy(), other[name].to_numpy()
        number = ours.dtype.kind == "f"
        if number:
            theirs = theirs / factor(one[name].attrs.get("units"), length, mass)
        if np.array_equal(ours, theirs, equal_nan=number):
            continue
        differences_found[name] = math.inf
        if number and ours.shape == theirs.shape:
            difference = np.where(ours == theirs, 0.0, np.abs(ours - theirs))
            difference = np.where(np.isnan(ours) & np.isnan(theirs), 0.0, difference)
            differences_found[name] = float(
                np.max(difference) / np.nanmax(np.abs(ours), initial=1e-300)
            )
    return differences_found
