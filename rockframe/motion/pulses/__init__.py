"""Analytic motions, sampled so finely that a simulation cannot tell the difference."""
