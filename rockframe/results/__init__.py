"""Labelled results: one table of variables, and the dataset built by it."""
