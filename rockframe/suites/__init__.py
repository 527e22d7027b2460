"""Suites of motions: reading them, choosing among them, fitting them to a target spectrum."""

from rockframe.suites.reading import read_suite as read_suite
from rockframe.suites.scaling import scale_to_target as scale_to_target
from rockframe.suites.selection import select_for_target as select_for_target
from rockframe.suites.suite import MotionSuite as MotionSuite
from rockframe.suites.target import TargetSpectrum as TargetSpectrum
