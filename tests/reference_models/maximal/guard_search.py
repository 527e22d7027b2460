"""Search inside a step for the first guard that falls through zero."""

from .compiling import compiled, within
from .excitation import ground
from .guards import evaluate
from .layout import GUARDS
from .runge_kutta import step

SAMPLES = 8
POINTS, LAPS = 16, 5


@within
def sample_guards(
    t, h, z, first, new, last, piece, motion, contact, held, p, room, out, inner, samples
):
    """Fill in the guards at equally spaced times of a step.

    In between, positions are quintics through positions, rates and accelerations of both ends,
    rates are cubics through rates and accelerations. They only locate candidates, which are
    then evaluated by separate steps.
    """
    for m in range(SAMPLES + 1):
        u = m / SAMPLES
        if m == 0:
            inner[:] = z
        elif m == SAMPLES:
            inner[:] = new
        else:
            for j in range(6):
                r = new[j] - z[j] - h * z[6 + j] - 0.5 * h * h * first[6 + j]
                q = h * (new[6 + j] - z[6 + j]) - h * h * first[6 + j]
                w = h * h * (last[6 + j] - first[6 + j])
                c3 = 10.0 * r - 4.0 * q + 0.5 * w
                c4 = -15.0 * r + 7.0 * q - w
                c5 = 6.0 * r - 3.0 * q + 0.5 * w
                inner[j] = (
                    z[j]
                    + u * h * z[6 + j]
                    + 0.5 * u * u * h * h * first[6 + j]
                    + u * u * u * (c3 + u * (c4 + u * c5))
                )
                # no division by h, which may be tiny
                d, a0, a1 = new[6 + j] - z[6 + j], h * first[6 + j], h * last[6 + j]
                inner[6 + j] = (
                    z[6 + j] + u * a0 + u * u * (3.0 * d - 2.0 * a0 - a1 + u * (a0 + a1 - 2.0 * d))
                )
        gx, gy = ground(t + u * h, piece, motion[0], motion[1], motion[2])
        evaluate(inner, gx, gy, contact, held, p, room, out, samples[m])


@within
def earliest(
    t, h, z, first, piece, motion, contact, held, p, room, out, slopes, scale, trial, guards,
    armed, noise, samples,
):  # fmt: skip
    """Find the first guard that falls through zero in a step.

    Returns
    -------
    tuple
        Guard and time from the start of the step; -1 for none; -2 and a guard if that guard starts
        at zero and is negative at its first sample.
    """
    best, when = -1, 2.0 * h
    for k in range(GUARDS):
        ready = armed[k]
        start = 0
        if not ready:
            for m in range(1, SAMPLES + 1):
                if samples[m, k] < -noise[k]:
                    return -2, float(k)
                if samples[m, k] > noise[k]:
                    ready, start = True, m
                    break
            if not ready:
                continue
        m = start
        while m <= SAMPLES:
            low, high, hunt = -1.0, -1.0, False
            if m > start and samples[m, k] < 0.0:
                low, high = h * (m - 1) / SAMPLES, h * m / SAMPLES
            else:
                left, right = dip(samples, k, m, start)
                if right > left:
                    low, high, hunt = h * left / SAMPLES, h * right / SAMPLES, True
            if high > 0.0:
                if low >= when:
                    break
                root = _search(
                    low, high, hunt, noise[k], k, t, z, first, piece, motion, contact, held, p,
                    room, out, slopes, scale, trial, guards,
                )  # fmt: skip
                if root >= 0.0:
                    if root < when:
                        best, when = k, root
                    break
            m += 1
    return best, when


@compiled
def dip(samples, k, m, start):
    """Return the samples between which a positive guard may dip below zero."""
    if start == 0 and m == 0:
        g0, g1, g2 = samples[0, k], samples[1, k], samples[2, k]
        slope, bend = 0.5 * (-3.0 * g0 + 4.0 * g1 - g2), g2 - 2.0 * g1 + g0
        if g1 >= g0 and slope < 0.0 and bend > 0.0 and g0 - 0.5 * slope * slope / bend < bend:
            return 0, 1
        return 0, 0
    if m <= start:
        return 0, 0
    if m == SAMPLES:
        g0, g1, g2 = samples[m, k], samples[m - 1, k], samples[m - 2, k]
        slope, bend = 0.5 * (-3.0 * g0 + 4.0 * g1 - g2), g2 - 2.0 * g1 + g0
        if g1 >= g0 and slope < 0.0 and bend > 0.0 and g0 - 0.5 * slope * slope / bend < bend:
            return m - 1, m
        return 0, 0
    a, b, c = samples[m - 1, k], samples[m, k], samples[m + 1, k]
    if a > b and c >= b and c >= 0.0:
        bend = a - 2.0 * b + c
        if b - (c - a) * (c - a) / (8.0 * bend) < 0.25 * bend:
            return m - 1, m + 1
    return 0, 0


@within
def _search(
    low, high, hunt, tiny, slot, t, z, first, piece, motion, contact, held, p, room, out, slopes,
    scale, trial, guards,
):  # fmt: skip
    """Find the length of the step at whose end a guard falls through zero.

    With `hunt` the guard is positive at both ends of the interval: ever finer rows of points search
    for a value below -`tiny` first. False position and bisection then find the root.

    Returns
    -------
    float
        -1 if the guard stays positive.
    """
    phase = 0 if hunt else 1
    a, b = low, high
    m, lap, best, place = 1, 0, 1.0, low
    above = below = 0.0
    count, kept = 0, 0
    x = a + (b - a) / POINTS if hunt else low
    while True:
        step(t, x, z, first, piece, motion, contact, held, p, room, out, slopes, scale, trial)
        gx, gy = ground(t + x, piece, motion[0], motion[1], motion[2])
        evaluate(trial, gx, gy, contact, held, p, room, out, guards)
        value = guards[slot]
        if phase == 0:
            if value < best:
                best, place = value, x
            if value < -tiny:
                phase, high, x = 1, x, low
                continue
            m += 1
            if m == POINTS:
                lap += 1
                if lap == LAPS:
                    return -1.0
                part = (b - a) / POINTS
                a, b, m = max(a, place - part), min(b, place + part), 1
            x = a + (b - a) * m / POINTS
        elif phase == 1:
            if value <= 0.0:
                # it had fallen before
                if low == 0.0:
                    return 0.0
                low, high = max(0.0, 2.0 * low - high), low
                x = low
                continue
            phase, above, x = 2, value, high
        elif phase == 2 and value > 0.0:
            return -1.0
        else:
            if phase == 2:
                phase, below = 3, value
            elif value > 0.0:
                low, above = x, value
                below = 0.5 * below if kept == 1 else below
                kept = 1
            else:
                high, below = x, value
                above = 0.5 * above if kept == -1 else above
                kept = -1
            if abs(value) < 1e-15:
                return x
            count += 1
            if count > 80 or high - low <= 2e-17 * (t + high):
                return high
            x = low + (high - low) * above / (above - below)
            if not (low < x < high) or count % 4 == 0:
                x = 0.5 * (low + high)
