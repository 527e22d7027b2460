"""Figures of results; matplotlib is imported when the first is drawn."""

from rockframe.plot.response import response as response
