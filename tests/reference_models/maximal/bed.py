"""Resultants of the bed by Gauss's quadrature over the bearing part of the base."""

import math

from .compiling import compiled, within
from .kinematics import height, is_small
from .layout import (
    BED_DAMPING,
    BED_LEFT,
    BED_RIGHT,
    BED_SETTLEMENT,
    BED_STIFFNESS,
    CUT_END,
    CUT_START,
    LOWER_ECCENTRICITY,
    LOWER_HALF_WIDTH,
    LOWER_HEIGHT,
    NO_SUCTION,
    TOUCHING,
)

_GAUSS = math.sqrt(0.6)


@compiled
def down(contact, z, p):
    """Return the coordinates s of the ends of the part of the base that is down.

    They are measured from the foot of the centre of mass.
    """
    b, delta, small = p[LOWER_HALF_WIDTH], p[BED_SETTLEMENT], is_small(p)
    to_left, to_right = b + p[LOWER_ECCENTRICITY], b - p[LOWER_ECCENTRICITY]
    left, right = contact[BED_LEFT] == TOUCHING, contact[BED_RIGHT] == TOUCHING
    if left and right:
        return -to_left, to_right
    if not (left or right):
        return 0.0, 0.0
    u_left = delta - height(small, z[1], z[2], to_left, p[LOWER_HEIGHT], 1.0)[0]
    u_right = delta - height(small, z[1], z[2], to_right, p[LOWER_HEIGHT], -1.0)[0]
    if left:
        apart = u_left - u_right
        return -to_left, -to_left + (2.0 * b * u_left / apart if apart > 0.0 else 0.0)
    apart = u_right - u_left
    return to_right - (2.0 * b * u_right / apart if apart > 0.0 else 0.0), to_right


@within
def bed_pressure(z, p, s):
    """Return compression, rate of the height, pressure and lever at a point of the base."""
    w, lever, _ = height(is_small(p), z[1], z[2], -s, p[LOWER_HEIGHT], 1.0)
    rate = z[7] + lever * z[8]
    u = p[BED_SETTLEMENT] - w
    return u, rate, p[BED_STIFFNESS] * u - p[BED_DAMPING] * rate, lever


@within
def no_suction(p):
    """Tell whether parts of the base where dashpots would pull separate."""
    return p[NO_SUCTION] > 0.5 and p[BED_DAMPING] > 0.0


@within
def bearing(contact, z, p):
    """Return the ends of the bearing part: below the bed's level, and pressed without suction.

    The contact state says which end is cut off, so that forces are smooth within a state.
    """
    start, end = down(contact, z, p)
    if not no_suction(p) or not (contact[CUT_START] or contact[CUT_END]):
        return start, end
    if contact[CUT_START] and contact[CUT_END]:
        return start, start
    first, last = bed_pressure(z, p, start)[2], bed_pressure(z, p, end)[2]
    root = start + (end - start) * first / (first - last) if first != last else start
    return (root, end) if contact[CUT_START] else (start, root)


@within
def end_pressures(contact, z, p):
    """Return the pressures at both ends of the part below the bed's level, over the static one."""
    start, end = down(contact, z, p)
    scale = p[BED_STIFFNESS] * p[BED_SETTLEMENT]
    return bed_pressure(z, p, start)[2] / scale, bed_pressure(z, p, end)[2] / scale


@within
def cut_off(contact, z, p, noise):
    """Record which ends are cut off; pressures within `noise` of zero change nothing."""
    if not no_suction(p):
        return
    first, last = end_pressures(contact, z, p)
    if abs(first) > noise:
        contact[CUT_START] = 1 if first < 0.0 else 0
    if abs(last) > noise:
        contact[CUT_END] = 1 if last < 0.0 else 0


@within
def resultants(contact, z, p):
    """Return force and generalised force on the rotation from the bearing part."""
    start, end = bearing(contact, z, p)
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    force = moment = 0.0
    for i in range(3):
        weight = 5.0 / 9.0 if i != 1 else 8.0 / 9.0
        _, _, pressure, lever = bed_pressure(z, p, middle + (i - 1.0) * _GAUSS * half)
        force += weight * half * pressure
        moment += weight * half * pressure * lever
    return force, moment


@compiled
def bed_energy(contact, z, p):
    """Return the energy of the springs of the bed and the power of its dashpots."""
    start, end = down(contact, z, p)
    first, last = bearing(contact, z, p)
    energy = power = 0.0
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    for i in range(3):
        weight = 5.0 / 9.0 if i != 1 else 8.0 / 9.0
        u, rate, _, _ = bed_pressure(z, p, middle + (i - 1.0) * _GAUSS * half)
        energy += 0.5 * weight * half * p[BED_STIFFNESS] * u * u
        power += weight * half * p[BED_STIFFNESS] * u * rate
    middle, half = 0.5 * (first + last), 0.5 * (last - first)
    for i in range(3):
        weight = 5.0 / 9.0 if i != 1 else 8.0 / 9.0
        u, rate, _, _ = bed_pressure(z, p, middle + (i - 1.0) * _GAUSS * half)
        # springs dissipate outside the bearing part, dashpots inside
        power += weight * half * rate * (p[BED_DAMPING] * rate - p[BED_STIFFNESS] * u)
    return energy, power
