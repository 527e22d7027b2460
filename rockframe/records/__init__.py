r"""Reading of ground-motion files into records, from which motions are made.

All public names of the package are imported from here.

>>> from io import BytesIO
>>> text = b"time (s),acceleration (g)\n0,0\n0.01,0.1\n0.02,-0.1\n"
>>> reading = read_record(BytesIO(text))
>>> reading.si.time_step, reading.metadata["format"]
(0.01, 'text')

``read_record`` reads one component, ``read_components`` all components of a file, and
``files_of`` opens the files of a folder or an archive. Names for readers of other formats are
here, too; see :func:`register`.
"""

from rockframe.records.checks import USUAL_TIME_STEPS
from rockframe.records.components import (
    DOWNWARDS,
    SENSE,
    UPWARDS,
    VERTICAL,
    FileComponent,
    choose_component,
    orientation_of,
)
from rockframe.records.files import PathLike, RecordLike, Unread, files_of, read_source
from rockframe.records.known_formats import formats, register, unregister
from rockframe.records.netcdf import (
    LONG_NAMES,
    is_netcdf,
    motion_of_arrays,
    opened_netcdf,
    stored_arrays,
    stored_motion,
)
from rockframe.records.numbers import epoch_seconds, same_start, time_after, uniform_step
from rockframe.records.peer import Known, peer_table
from rockframe.records.read import Reading, read_components, read_record, read_traces, request_of
from rockframe.records.reader import (
    MAXIMUM_SAMPLES,
    Format,
    Metadata,
    Reader,
    Record,
    Request,
    Source,
    choose_unit,
)
from rockframe.records.unit_names import acceleration_unit, argument_unit

__all__ = [
    "DOWNWARDS",
    "LONG_NAMES",
    "MAXIMUM_SAMPLES",
    "SENSE",
    "UPWARDS",
    "USUAL_TIME_STEPS",
    "VERTICAL",
    "Component",
    "FileComponent",
    "Format",
    "Known",
    "Metadata",
    "PathLike",
    "Reader",
    "Reading",
    "Record",
    "RecordLike",
    "Request",
    "Source",
    "Unread",
    "acceleration_unit",
    "argument_unit",
    "choose_component",
    "choose_unit",
    "epoch_seconds",
    "files_of",
    "formats",
    "is_netcdf",
    "motion_of_arrays",
    "opened_netcdf",
    "orientation_of",
    "peer_table",
    "read_components",
    "read_record",
    "read_source",
    "read_traces",
    "register",
    "request_of",
    "same_start",
    "stored_arrays",
    "stored_motion",
    "time_after",
    "uniform_step",
    "unregister",
]

Component = FileComponent
"""Former name of :class:`FileComponent`, for readers that users have written."""
