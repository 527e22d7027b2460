"""Many runs at once: what users call."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import xarray as xr

from rockframe.arguments import whole_number
from rockframe.errors import SolverWarning, StudyError, shown, warn
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.studies.sweeps.axes import OWNER
from rockframe.studies.sweeps.case import remember
from rockframe.studies.sweeps.chunk import Rows
from rockframe.studies.sweeps.execution import Chunk, carry_out, worker_count
from rockframe.studies.sweeps.grid import chunks_of
from rockframe.studies.sweeps.labelling import labelled, labels_of, say_what_is_missing
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.progress import progress_of
from rockframe.studies.sweeps.store import Store, begin_with
from rockframe.studies.sweeps.study import Study
from rockframe.system.options import Overturning

if TYPE_CHECKING:
    from rockframe.components import InitialState
    from rockframe.motion import GroundMotion
    from rockframe.simulation.system import System
    from rockframe.system.options import OverturningLike, PointsLike, SweepAccuracyLike
    from rockframe.units import QuantityLike

_LARGEST_CHUNK: Final = 1_000_000


def sweep(
    scene: "System | Callable[..., System]",
    motions: "GroundMotion | Mapping[str, GroundMotion] | Sequence[GroundMotion] | None" = None,
    *,
    axes: Mapping[str, Any] | None = None,
    cases: Any = None,
    period: "QuantityLike | None" = None,
    duration: "QuantityLike | None" = None,
    free_vibration: "QuantityLike | None" = None,
    initial: "InitialState | None" = None,
    accuracy: "SweepAccuracyLike" = AccuracyLevel.STANDARD,
    output_step: "QuantityLike | None" = None,
    outputs: Sequence[str] | None = None,
    points: "PointsLike | None" = None,
    overturning: "OverturningLike" = Overturning.STOP,
    store: "str | PathLike[str] | None" = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    progress: bool | None = None,
    **more_axes: Any,
) -> xr.Dataset:
    """Run a scene at all combinations of values, or at all rows of a table.

    Parameters
    ----------
    scene : System or callable
        A system with parts whose parameters the axes name; or a function that takes the axes
        by their names and returns a System.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each is combined with all cases; the one among the parts of the system, or of the
        systems that the function returns, unless given.
    axes : mapping of str to values, optional
        Axes whose names no keyword can have, such as ``"Block.mass"``, or that are also
        arguments here.
    cases : pandas.DataFrame or mapping of str to values, optional
        A table with a row for each case, and columns like axes, with units in their heads
        (``width [m]``) or in their values. A column ``motion`` picks motions by name or
        number.
    period : str or Quantity, optional
        Of the oscillator of ``pseudo_spectral_acceleration`` [s].
    duration, free_vibration, initial, overturning : optional
        As for :meth:`rockframe.System.simulate`; `initial` cannot be a dataset.
    accuracy : {"fast", "standard", "reference", "screen"}, float or Accuracy
        As for :meth:`rockframe.System.simulate`; or ``"screen"``: all cases at ``"fast"``, and
        those near a flip of their verdict again at ``"standard"``, :eq:`eq-screened`.
    output_step : str or Quantity, optional
        Spacing of the histories; the time step of the motions unless given [s].
    outputs : sequence of str, optional
        Histories that are kept: names and groups, or, of an empty sequence, those that every
        run has, those of points among them. None keeps none.
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points of the body, as for :meth:`rockframe.System.simulate`. Peaks of their
        displacements and absolute accelerations are given over ``point``, and their histories
        as far as `outputs` keeps them [m].
    store : str or path, optional
        A folder in which what has been run is kept. The same call goes on with what it
        finds there.
    executor : concurrent.futures.Executor, optional
        Runs the cases; threads, one for each processor, unless given.
    chunk : int, optional
        Cases that are handed out, and kept, together; what takes about a second unless
        given. A `store` keeps to what it was begun with.
    progress : bool, optional
        Whether a bar shows how far it is (needs tqdm); where it can be seen unless given.
    **more_axes : values
        Axes, by the name of a parameter of one part (``frequency_ratio``) or of an option of
        the system (``gravity``), by an argument of the function, by where runs start
        (``initial_rotation``), or by what scales the
        motion: ``scale``, ``peak_ground_acceleration``, ``peak_ground_velocity`` or
        ``pseudo_spectral_acceleration``. Values with a unit are ``([1, 2], "m")``, a
        Quantity, or ``["1 m", "2 m"]``.

    Returns
    -------
    xarray.Dataset
        All scalars of a run, over ``case`` if there is a table, the axes in the order given,
        and ``motion``; histories over ``time`` too. Of a case that could not be
        assembled or finished ``status`` tells, its ``message_number`` gives the place of the
        reason along ``message``, and its scalars are NaN. Truth values, flags and counts are
        floats where that leaves gaps. Screened sweeps have ``repeated`` and ``verdict_changed``.

    Raises
    ------
    StudyError
        The sweep cannot be planned, with every fault found; its store is another's, damaged
        or cannot be written; or the executor failed.
    ComponentError
        `executor`, `chunk` or `progress` is no such thing.

    Warns
    -----
    SolverWarning
        Cases have no result, or have not been run after an interrupt (Ctrl-C).
    ModelWarning
        Values are unusual, or runs are to be used with care.

    Notes
    -----
    What a case gives depends on that case alone: not on the chunk it is in, on who runs it,
    or on how many do. It is what ``simulate`` gives, to the last bit; :func:`rockframe.case`
    gives any case back.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    >>> system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10))
    >>> pulse = rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz")
    >>> runs = rf.sweep(system, pulse, scale=[0.4, 0.8], frequency_ratio=[10, 20, 40])
    >>> dict(runs.overturned.sizes)
    {'scale': 2, 'frequency_ratio': 3, 'motion': 1}
    """
    given = dict(axes or {})
    twice = sorted(set(given) & set(more_axes))
    if twice:
        raise StudyError(*(f"axis {name!r} is given twice" for name in twice))
    study = plan_study(
        scene,
        motions,
        {**given, **more_axes},
        cases,
        period=period,
        duration=duration,
        free_vibration=free_vibration,
        initial=initial,
        accuracy=accuracy,
        output_step=output_step,
        outputs=outputs,
        points=points,
        overturning=overturning,
    )
    size = (
        study.chunk_size(worker_count())
        if chunk is None
        else whole_number(chunk, owner=OWNER, name="chunk", lowest=1, highest=_LARGEST_CHUNK)
    )
    remember(study)
    if store is None:
        dataset, whole = _in_memory(study, size, executor, progress)
    else:
        dataset, whole = _kept(study, _folder(store), size, executor, progress)
    if not whole:
        warn(f"{OWNER}: interrupted; {dataset.attrs['verdict']}", SolverWarning)
    say_what_is_missing(dataset)
    return dataset


def open_study(path: "str | PathLike[str]") -> xr.Dataset:
    """Read what a sweep has kept so far, also while it runs.

    Parameters
    ----------
    path : str or path
        The `store` of a :func:`rockframe.sweep`.

    Returns
    -------
    xarray.Dataset
        As of the sweep itself; the status of cases that are still to come is ``not_run``.

    Raises
    ------
    StudyError
        There is no study, it is damaged, or another version of rockframe wrote it.
    """
    return _opened(Store.at(_folder(path)))


def _in_memory(
    study: Study, size: int, executor: Executor | None, progress: bool | None
) -> tuple[xr.Dataset, bool]:
    chunks = [Chunk(k, cases) for k, cases in enumerate(chunks_of(study.grid.count, size))]
    found: list[tuple[range, Rows]] = []
    bar = progress_of(progress, total=study.grid.count, done=0)

    def take(one: Chunk, rows: Rows) -> None:
        found.append((one.cases, rows))
        bar.update(len(one.cases))

    try:
        whole = carry_out(chunks, lambda one: study.job(one.cases), take, executor)
    finally:
        bar.close()
    return labelled(labels_of(study), found), whole


def _kept(
    study: Study, folder: Path, size: int, executor: Executor | None, progress: bool | None
) -> tuple[xr.Dataset, bool]:
    kept = Store.of_study(folder, study, size)
    every = kept.chunks()
    missing = [one for one in every if not kept.has(one)]
    some = len(missing) < len(every)
    if some:  # before hours of work
        for _ in kept.found():
            pass
    done = study.grid.count - sum(len(one.cases) for one in missing)
    bar = progress_of(progress, total=study.grid.count, done=done)

    def still_missing() -> Any:
        for one in begin_with(missing) if some else missing:
            if kept.has(one):  # another process has run it meanwhile
                bar.update(len(one.cases))
            else:
                yield one

    def take(one: Chunk, rows: Rows) -> None:
        kept.put(one, rows)
        bar.update(len(one.cases))

    try:
        whole = carry_out(still_missing(), lambda one: study.job(one.cases), take, executor)
    finally:
        bar.close()
    return _opened(kept), whole


def _opened(kept: Store) -> xr.Dataset:
    dataset = labelled(kept.labels(), kept.found())
    dataset.attrs["history"] = kept.history
    return dataset


def _folder(path: object) -> Path:
    if isinstance(path, str | PathLike):
        return Path(path)  # pyright: ignore[reportUnknownArgumentType]
    msg = f"store must be the path of a folder, got {shown(path)}"
    raise StudyError(msg)
