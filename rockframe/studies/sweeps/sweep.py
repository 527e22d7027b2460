"""Many runs at once: what users call."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import Any

import xarray as xr

from rockframe.arguments import several, truth
from rockframe.components import InitialState
from rockframe.errors import ModelWarning, StudyError, shown, warn
from rockframe.proposals import hinted
from rockframe.shared_arguments import documented_by
from rockframe.simulation.system import System
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.axes import OWNER
from rockframe.studies.sweeps.execution import bar_of
from rockframe.studies.sweeps.lazily import lazy_dataset
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.running import folder_of, run_study, stored_dataset
from rockframe.studies.sweeps.store import Store
from rockframe.system.options import Overturning, OverturningLike, PointsLike, SweepAccuracyLike
from rockframe.units import QuantityLike
from rockframe.version import __version__


@hinted()
@documented_by(SweepArguments)
def sweep(
    scene: System | Callable[..., System],
    motions: MotionsLike | None = None,
    *,
    axes: Mapping[str, Any] | None = None,
    cases: Any = None,
    period: QuantityLike | None = None,
    duration: QuantityLike | None = None,
    free_vibration: QuantityLike | None = None,
    initial: InitialState | None = None,
    accuracy: SweepAccuracyLike = AccuracyLevel.STANDARD,
    output_step: QuantityLike | None = None,
    outputs: Sequence[str] | None = None,
    points: PointsLike | None = None,
    overturning: OverturningLike = Overturning.STOP,
    store: str | PathLike[str] | None = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    progress: bool | None = None,
    known: str | PathLike[str] | Sequence[str | PathLike[str]] = (),
    **more_axes: Any,
) -> xr.Dataset:
    """Run a scene at all combinations of values, or at all rows of a table.

    Parameters
    ----------
    scene : System or callable
        A system with parts whose parameters the axes name; or a function that takes the axes
        by their names and returns a System.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each is combined with all cases; of a HorizontalPair each of its two components. The
        one among the parts of the system, or of the systems that the function returns, unless
        given.
    axes : mapping of str to values, optional
        Axes whose names no keyword can have, such as ``"Block.mass"``, or that are also
        arguments here.
    cases : pandas.DataFrame or mapping of str to values, optional
        A table with a row for each case, and columns like axes, with units in their heads
        (``width [m]``) or in their values. A column ``motion`` picks motions by name or
        number.
    period : str or Quantity, optional
        Of the oscillator of ``pseudo_spectral_acceleration`` [s].
    output_step : str or Quantity, optional
        Spacing of the histories; the time step of the motions, of unlike ones the shortest,
        unless given [s].
    outputs : sequence of str, optional
        Histories that are kept: names and groups, or, of an empty sequence, those that every
        run has, those of points among them. None keeps none.
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points of the body, as for :meth:`rockframe.System.simulate`. Peaks of their
        displacements and absolute accelerations are given over ``point``, and their histories
        as far as `outputs` keeps them [m].
    overturning : {"stop", "continue"}, optional
        Whether a run ends when the rotation reaches the overturning angle, or goes on until
        the block lies flat.
    known : str or path, or sequence of them, optional
        Stores of other sweeps, which differ in motions and in values of the axes alone: cases that
        they have are copied into `store`, and not run again.
    **more_axes : values
        Axes, by the name of a parameter of one part (``frequency_ratio``) or of an option of
        the system (``gravity``), by an argument of the function, by where runs start
        (``initial_rotation``), or by what scales the
        motion: ``scale``, ``peak_ground_acceleration`` (or ``PGA``), ``peak_ground_velocity``
        (``PGV``) or ``pseudo_spectral_acceleration`` (``SA``). Values with a unit are
        ``([1, 2], "m")``, a Quantity, or ``["1 m", "2 m"]``.

    Returns
    -------
    xarray.Dataset
        All scalars of a run, over ``case`` if there is a table, the axes in the order given,
        and ``motion``; histories over ``time`` too. Of a case that could not be
        assembled or finished ``status`` tells, the coordinate ``message`` says why, and its
        scalars are NaN. Truth values, flags and counts are
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
        Cases have no result, or have not been run after an interrupt (Ctrl-C). It will take more
        than a day. The result does not fit into memory: then it is opened lazily from the store.
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
    named = axes is None or isinstance(axes, Mapping)  # pyright: ignore[reportUnnecessaryIsInstance]
    if not named:
        found = f"axes must be a mapping of names to values, got {shown(axes)}"
        msg = f"{found}; write for example axes={{'Block.mass': ['1 t', '2 t']}}"
        raise StudyError(msg)
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
        kept=store is not None,
    )
    with bar_of(progress, owner=OWNER) as bar:
        others = [known] if isinstance(known, PathLike) else several(
            known, owner=OWNER, name="known", of="folders"
        )  # fmt: skip
        return run_study(study, bar, store=store, executor=executor, chunk=chunk, known=others)


@hinted()
def open_study(path: str | PathLike[str], *, lazy: bool = False) -> xr.Dataset:
    """Read what a sweep has kept so far, also while it runs.

    Parameters
    ----------
    path : str or path
        The `store` of a :func:`rockframe.sweep`.
    lazy : bool, optional
        Whether numbers are read from the folder when they are used, and not before: for studies
        that are larger than the memory. Truth values, flags and counts are floats then. Where
        dask is installed the variables are arrays of dask.

    Returns
    -------
    xarray.Dataset
        As of the sweep itself; the status of cases that are still to come is ``not_run``.

    Raises
    ------
    StudyError
        There is no study, it is damaged, or of a format that cannot be read.

    Warns
    -----
    ModelWarning
        Another version of rockframe has run it, whose numbers may be others.

    Examples
    --------
    >>> import rockframe as rf
    >>> so_far = rf.open_study("study")  # doctest: +SKIP
    >>> so_far.verdict  # doctest: +SKIP
    """
    kept = Store.at(folder_of(path))
    if kept.version != __version__:
        warn(
            f"open_study: {kept.folder} was run by rockframe {kept.version}, whose numbers may be "
            f"others than those of this one, {__version__}",
            ModelWarning,
        )
    later = truth(lazy, owner="open_study", name="lazy")
    found = lazy_dataset(kept) if later else stored_dataset(kept)
    found.encoding["source"] = str(kept.folder)  # as of a dataset that was read from a file
    return found
