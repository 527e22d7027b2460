"""Fehlberg's Runge-Kutta formula of orders 7 and 8 with thirteen stages (NASA TR R-287, 1968)."""

import numpy as np

from .bed import bed_energy
from .compiling import compiled, within
from .excitation import ground
from .forces import accelerate, corner, has_lower
from .impulses import lower_slip, slip
from .kinematics import relative
from .layout import (
    CASCADE,
    DAMPING,
    HOLD,
    KIND,
    LEFT,
    LOWER_HOLD,
    LOWER_MASS,
    MASS,
    RIGID,
    SETTLEMENT,
    SLIDING,
    STATES,
    STIFFNESS,
    TOUCHING,
)

STAGES = 13
NODES = np.array(
    [0, 2 / 27, 1 / 9, 1 / 6, 5 / 12, 1 / 2, 5 / 6, 1 / 6, 2 / 3, 1 / 3, 1, 0, 1], dtype=np.float64
)
_ROWS = (
    (),
    (2 / 27,),
    (1 / 36, 1 / 12),
    (1 / 24, 0, 1 / 8),
    (5 / 12, 0, -25 / 16, 25 / 16),
    (1 / 20, 0, 0, 1 / 4, 1 / 5),
    (-25 / 108, 0, 0, 125 / 108, -65 / 27, 125 / 54),
    (31 / 300, 0, 0, 0, 61 / 225, -2 / 9, 13 / 900),
    (2, 0, 0, -53 / 6, 704 / 45, -107 / 9, 67 / 90, 3),
    (-91 / 108, 0, 0, 23 / 108, -976 / 135, 311 / 54, -19 / 60, 17 / 6, -1 / 12),
    (
        2383 / 4100,
        0,
        0,
        -341 / 164,
        4496 / 1025,
        -301 / 82,
        2133 / 4100,
        45 / 82,
        45 / 164,
        18 / 41,
    ),
    (3 / 205, 0, 0, 0, 0, -6 / 41, -3 / 205, -3 / 41, 3 / 41, 6 / 41, 0),
    (
        -1777 / 4100,
        0,
        0,
        -341 / 164,
        4496 / 1025,
        -289 / 82,
        2193 / 4100,
        51 / 82,
        33 / 164,
        12 / 41,
        0,
        1,
    ),
)
MATRIX = np.zeros((STAGES, STAGES))
for _i, _row in enumerate(_ROWS):
    MATRIX[_i, : len(_row)] = _row
WEIGHTS = np.array(
    [0, 0, 0, 0, 0, 34 / 105, 9 / 35, 9 / 35, 9 / 280, 9 / 280, 0, 41 / 840, 41 / 840]
)
ERROR_WEIGHT = 41 / 840


@within
def rates(t, z, piece, motion, contact, held, p, room, out, slope):
    """Fill in the derivative of the state: rates, accelerations and the powers of both works."""
    gx, gy = ground(t, piece, motion[0], motion[1], motion[2])
    accelerate(z, gx, gy, contact, held, p, room, out)
    for j in range(6):
        slope[j] = z[6 + j]
        slope[6 + j] = out[j]
    slope[12] = slope[13] = 0.0
    if int(p[KIND]) == CASCADE:
        return
    slope[13] = -p[MASS] * (gx * z[9] + gy * z[10])
    if int(p[KIND]) == RIGID:
        return
    if p[MASS] > 0.0:
        rel = room[0]
        relative(z, p, rel, room[1])
        for i in range(2):
            y, _, _, speed, _ = corner(p, rel, i)
            if contact[LEFT + i] == TOUCHING:
                slope[12] += p[DAMPING] * speed * speed
            elif y < p[SETTLEMENT]:
                slope[12] += p[STIFFNESS] * (p[SETTLEMENT] - y) * speed
        if contact[HOLD] == SLIDING:
            slope[12] -= out[7] * slip(z, held, p, room)
    if has_lower(p):
        slope[12] += bed_energy(contact, z, p)[1]
        slope[13] -= p[LOWER_MASS] * (gx * z[6] + gy * z[7])
        if contact[LOWER_HOLD] == SLIDING:
            slope[12] -= out[6] * lower_slip(z, held, p)


@compiled
def step(t, h, z, first, piece, motion, contact, held, p, room, out, slopes, scale, new):
    """Take one step; give the greatest difference of both orders over `scale`.

    `first` is the derivative at the start; `new` is filled with the state at the end.
    """
    slopes[0] = first
    for i in range(1, STAGES):
        for j in range(STATES):
            total = 0.0
            for k in range(i):
                total += MATRIX[i, k] * slopes[k, j]
            new[j] = z[j] + h * total
        rates(t + NODES[i] * h, new, piece, motion, contact, held, p, room, out, slopes[i])
    worst = 0.0
    for j in range(STATES):
        total = 0.0
        for k in range(5, STAGES):
            total += WEIGHTS[k] * slopes[k, j]
        new[j] = z[j] + h * total
        if j < 12:
            off = slopes[0, j] + slopes[10, j] - slopes[11, j] - slopes[12, j]
            worst = max(worst, abs(h * ERROR_WEIGHT * off) / scale[j])
    return worst
