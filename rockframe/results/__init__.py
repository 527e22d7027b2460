"""Labelled results: one table of variables (the schema), and the dataset built from it."""
