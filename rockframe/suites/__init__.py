"""Suites of motions: reading them, choosing among them, fitting them to a target spectrum."""

from rockframe.suites.reading import read_suite as read_suite
from rockframe.suites.suite import MotionSuite as MotionSuite
from rockframe.suites.target import TargetSpectrum as TargetSpectrum
