"""Accelerograms of an earthquake that nobody recorded: the stochastic point source."""

from rockframe.motion.stochastic.point_source import PointSource
from rockframe.motion.stochastic.site import Site
from rockframe.motion.stochastic.source import Corners
from rockframe.motion.stochastic.synthesis import accelerogram

__all__ = ["Corners", "PointSource", "Site", "accelerogram"]
