"""A mark for tests with intended supercritical damping."""

import pytest

overdamped = pytest.mark.filterwarnings("ignore:.* of critical:rockframe.errors.ModelWarning")
