"""Ground motions in numbers: integrals, durations, oscillators, transforms; SI arrays only."""
