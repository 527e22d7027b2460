"""Fragility: the probability that a limit state is exceeded, over the intensity of the motion."""
