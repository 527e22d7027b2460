"""Readers of record files: one module per format, one list of them.

What a reader of another format needs is here, too; see :func:`register`.
"""

from rockframe.motion.readers.checks import choose_unit as choose_unit
from rockframe.motion.readers.components import FileComponent as FileComponent
from rockframe.motion.readers.components import choose_component as choose_component
from rockframe.motion.readers.orientation import orientation_of as orientation_of
from rockframe.motion.readers.reading import read_record as read_record
from rockframe.motion.readers.registry import Format as Format
from rockframe.motion.readers.registry import Reader as Reader
from rockframe.motion.readers.registry import formats as formats
from rockframe.motion.readers.registry import register as register
from rockframe.motion.readers.registry import unregister as unregister
from rockframe.motion.readers.source import Record as Record
from rockframe.motion.readers.source import Request as Request
from rockframe.motion.readers.source import Source as Source

Component = FileComponent
"""The same, as readers of users' own have called it before."""
