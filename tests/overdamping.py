"""Tests whose bases are damped beyond critical on purpose."""

import pytest

overdamped = pytest.mark.filterwarnings("ignore:.* of critical:rockframe.errors.ModelWarning")
