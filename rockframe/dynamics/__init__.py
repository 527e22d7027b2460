"""Equations of motion, guards and switches of every contact state; SI floats only."""
