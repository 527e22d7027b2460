"""Figures of results and motions; matplotlib is imported when the first is drawn."""

from rockframe.plot.motion import motion as motion
from rockframe.plot.response import response as response
from rockframe.plot.spectra import spectra as spectra
from rockframe.plot.tradeoff import tradeoff as tradeoff
