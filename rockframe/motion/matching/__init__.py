"""Spectral matching in time: wavelets added to a motion until its spectrum is the target's."""
