"""Spectral matching in the time domain by wavelets that are added to a motion."""
