"""Constructors of ground motions: from files and arrays, from formulas, from models."""
