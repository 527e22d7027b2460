"""Processing of sampled motions: plain functions on SI arrays."""
