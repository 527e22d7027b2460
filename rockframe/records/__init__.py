"""Readers of record files: one module per format, one list of them.

What a reader of another format needs is here, too; see :func:`register`.
"""

from rockframe.records.checks import choose_unit as choose_unit
from rockframe.records.components import FileComponent as FileComponent
from rockframe.records.components import choose_component as choose_component
from rockframe.records.components import orientation_of as orientation_of
from rockframe.records.known_formats import Format as Format
from rockframe.records.known_formats import Reader as Reader
from rockframe.records.known_formats import formats as formats
from rockframe.records.known_formats import register as register
from rockframe.records.known_formats import unregister as unregister
from rockframe.records.read import read_record as read_record
from rockframe.records.record_file import Record as Record
from rockframe.records.record_file import Request as Request
from rockframe.records.record_file import Source as Source

Component = FileComponent
"""The same, as readers of users' own have called it before."""
