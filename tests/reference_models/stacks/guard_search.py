"""Search inside a step for the first guard that falls through zero."""

from reference_models.maximal.guard_search import LAPS, POINTS, SAMPLES, dip

from .stepping import value_at


def earliest(t, h, z, piece, motion, stack, contact, room, path):
    """Find the first guard that falls through zero in a step.

    Returns
    -------
    tuple
        Guard and time from the start of the step; -1 for none; -2 and a guard if that guard starts
        at zero and is negative at its first sample.
    """
    samples, noise = path.samples, path.noise
    best, when = -1, 2.0 * h
    for k in range(noise.size):
        start = 0
        if not path.armed[k]:
            start = -1
            for m in range(1, SAMPLES + 1):
                if samples[m, k] < -noise[k]:
                    return -2, float(k)
                if samples[m, k] > noise[k]:
                    start = m
                    break
            if start < 0:
                continue
        for m in range(start, SAMPLES + 1):
            root = -1.0
            if m > start and samples[m, k] < 0.0:
                low, high = h * (m - 1) / SAMPLES, h * m / SAMPLES
                if low >= when:
                    break
                root = _root(low, high, k, t, z, piece, motion, stack, contact, room, path)
            else:
                left, right = dip(samples, k, m, start)
                if right == left:
                    continue
                low, high = h * left / SAMPLES, h * right / SAMPLES
                if low >= when:
                    break
                below = _hunt(low, high, k, t, z, piece, motion, stack, contact, room, path)
                if below >= 0.0:
                    root = _root(low, below, k, t, z, piece, motion, stack, contact, room, path)
            if root >= 0.0:
                if root < when:
                    best, when = k, root
                break
    return best, when


def _hunt(low, high, slot, t, z, piece, motion, stack, contact, room, path):
    """Find a time at which a guard, positive at both ends of an interval, is negative; else -1."""
    best, place = 1e300, low
    for _ in range(LAPS):
        part = (high - low) / POINTS
        for m in range(1, POINTS):
            x = low + part * m
            value = value_at(x, slot, t, z, piece, motion, stack, contact, room, path)
            if value < -path.noise[slot]:
                return x
            if value < best:
                best, place = value, x
        low, high = max(low, place - part), min(high, place + part)
    return -1.0


def _root(low, high, slot, t, z, piece, motion, stack, contact, room, path):
    """Find the length of the step at whose end a guard has fallen through zero; else -1."""
    below = value_at(high, slot, t, z, piece, motion, stack, contact, room, path)
    if below > 0.0:
        return -1.0
    above = value_at(low, slot, t, z, piece, motion, stack, contact, room, path)
    while above <= 0.0:  # it had fallen before
        if low == 0.0:
            return 0.0
        low, high, below = max(0.0, 2.0 * low - high), low, above
        above = value_at(low, slot, t, z, piece, motion, stack, contact, room, path)
    kept = 0
    for lap in range(80):
        x = low + (high - low) * above / (above - below)
        if not low < x < high or lap % 4 == 3:
            x = 0.5 * (low + high)
        if high - low <= 2e-17 * (t + high) or not low < x < high:
            break
        value = value_at(x, slot, t, z, piece, motion, stack, contact, room, path)
        if abs(value) < 1e-15:
            return x
        # false position with halved weights (Illinois)
        if value > 0.0:
            low, above = x, value
            below = 0.5 * below if kept == 1 else below
            kept = 1
        else:
            high, below = x, value
            above = 0.5 * above if kept == -1 else above
            kept = -1
    return high
