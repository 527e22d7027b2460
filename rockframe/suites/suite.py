"""A suite: labelled motions, their measures, and scaling and selection for a target."""

from collections.abc import Iterable
from typing import Any, Self

import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.measures import (
    average_spectral_acceleration,
    intensity_measures,
    response_spectrum,
    rotated_spectrum,
)
from rockframe.motion.quantities import ArrayLike
from rockframe.suggestions import suggests_names
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.scaling import compared_target, matched, scaled_motions, scaling_to
from rockframe.suites.selection import selection_for
from rockframe.suites.stored import stored_motions, suite_dataset
from rockframe.suites.target import TargetSpectrum
from rockframe.units import QuantityLike, RatioLike


@suggests_names
class MotionSuite(LabelledMotions):
    """An immutable ordered collection of labelled ground motions.

    A mapping of labels to motions, accepted wherever several motions are. It holds the horizontal
    components; vertical ones are in `verticals`, and :meth:`with_verticals` adds them to the
    motions. The metadata of a motion describe it. Create a suite with :func:`rockframe.read_suite`
    or from motions.

    Parameters
    ----------
    motions : mapping of str to GroundMotion, or iterable of GroundMotion
        The motions by label; motions of an iterable are labelled by their names.
    verticals : mapping of str to GroundMotion, optional
        Vertical components, upwards; they belong to the motions whose metadata have the same
        ``record``.
    unread : mapping of str to str, optional
        Files that were not read, and why.
    remarks : iterable of str, optional
        Remarks on the records, such as contradictions in a file.
    target : TargetSpectrum, optional
        The spectrum to which the motions were scaled, defined in the range of the comparison.

    Raises
    ------
    ComponentError
        There are no motions, an item is no motion, or two have the same name.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulses = [rf.GroundMotion.sine_pulse("1 m/s^2", f"{f} Hz") for f in (1, 2)]
    >>> suite = MotionSuite({"slow": pulses[0], "fast": pulses[1]})
    >>> suite.select(duration=("0.8 s", None))
    <MotionSuite of 1 motion: 'slow'>
    >>> suite.table["peak_ground_acceleration [m s^-2]"].tolist()
    [1.0, 1.0]
    """

    __slots__ = ()

    # measures -------------------------------------------------------------------------------

    def intensity_measures(self, **arguments: Any) -> xr.Dataset:
        """Compute the intensity measures of all motions, over ``motion``.

        Parameters
        ----------
        **arguments
            As for :func:`rockframe.intensity_measures`.

        Returns
        -------
        xarray.Dataset

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> suite.intensity_measures().peak_ground_velocity.values.round(3)
        array([0.637, 0.318])
        """
        return intensity_measures(self, **arguments)

    def response_spectrum(
        self,
        periods: ArrayLike | Iterable[QuantityLike] | None = None,
        damping_ratios: Iterable[RatioLike] | RatioLike = (0.05,),
        *,
        component: str = "horizontal",
        interpolation: str = "linear",
    ) -> xr.Dataset:
        """Compute the response spectra of all motions, over ``motion``.

        Parameters
        ----------
        periods, damping_ratios, component, interpolation : optional
            As for :func:`rockframe.response_spectrum` [s], [1].

        Returns
        -------
        xarray.Dataset

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> suite.response_spectrum(["0.5 s"]).pseudo_spectral_acceleration.values.round(2).ravel()
        array([3.24, 5.4 ])
        """
        return response_spectrum(
            self, periods, damping_ratios, component=component, interpolation=interpolation
        )

    def rotated_spectrum(
        self,
        periods: ArrayLike | Iterable[QuantityLike] | None = None,
        damping_ratios: Iterable[RatioLike] | RatioLike = (0.05,),
    ) -> xr.Dataset:
        """Compute RotD50, RotD100 and the geometric mean of all pairs, over ``motion``.

        Parameters
        ----------
        periods, damping_ratios : optional
            As for :func:`rockframe.rotated_spectrum` [s], [1].

        Returns
        -------
        xarray.Dataset
            Labelled by the records.

        Examples
        --------
        >>> import tempfile
        >>> import rockframe as rf
        >>> folder = tempfile.mkdtemp()
        >>> rows = [f"{0.01 * k:.2f}, {0.1 * k:.1f}, {0.2 * k:.1f}" for k in range(5)]
        >>> with open(f"{folder}/R1.csv", "w") as file:
        ...     print("time [s], N [g], E [g]", *rows, sep=chr(10), file=file)
        >>> spectrum = rf.read_suite(folder).rotated_spectrum(["0.5 s"])
        >>> spectrum.motion.values.tolist()
        ['R1.csv']
        """
        return rotated_spectrum(self.pairs, periods, damping_ratios)

    def average_spectral_acceleration(
        self, periods: ArrayLike | Iterable[QuantityLike], damping_ratio: RatioLike = 0.05
    ) -> xr.Dataset:
        """Compute Sa_avg of all motions, over ``motion``.

        Parameters
        ----------
        periods, damping_ratio : optional
            As for :func:`rockframe.average_spectral_acceleration` [s], [1].

        Returns
        -------
        xarray.Dataset

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> found = suite.average_spectral_acceleration("0.5 s")
        >>> found.average_spectral_acceleration.values.round(2)
        array([3.24, 5.4 ])
        """
        return average_spectral_acceleration(self, periods, damping_ratio)

    # a target -------------------------------------------------------------------------------

    def scaled_to(self, target: TargetSpectrum | xr.Dataset, **arguments: Any) -> Self:
        """Scale each motion so that its spectrum fits a target.

        Parameters
        ----------
        target : TargetSpectrum or xarray.Dataset
            The target, or the result of :meth:`scaling_to` or :meth:`selection_for` for it.
        **arguments
            As for :meth:`scaling_to`.

        Returns
        -------
        MotionSuite
            The scaled motions, all or those selected. Their metadata have ``scale_factor`` and
            ``spectral_misfit``; `target` is the spectrum with which they were compared.

        Raises
        ------
        UnitsError, ComponentError, SchemaError
            As for :meth:`scaling_to`.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> found = suite.scaling_to(rf.TargetSpectrum.eurocode_8("0.2 g_0"), bounds=None)
        >>> print(suite.scaled_to(found)["1 Hz"].peak_acceleration.round(2))
        1.67 meter / second ** 2
        """
        scaling = target
        if not isinstance(scaling, xr.Dataset):
            scaling = self.scaling_to(scaling, **arguments)
        motions, verticals = scaled_motions(self, scaling)
        return type(self)(
            motions, verticals=verticals, unread=self._unread, remarks=self._remarks,
            target=compared_target(scaling),
        )  # fmt: skip

    def chosen_for(self, target: TargetSpectrum, count: int, **arguments: Any) -> Self:
        """Choose and scale the set of motions that fits a target best.

        Parameters
        ----------
        target : TargetSpectrum
            The target.
        count : int
            Number of motions, or of records of both components.
        **arguments
            As for :meth:`selection_for`.

        Returns
        -------
        MotionSuite

        Raises
        ------
        UnitsError, ComponentError
            As for :meth:`selection_for`.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2, 3, 4)}
        ... )
        >>> [*suite.chosen_for(rf.TargetSpectrum.eurocode_8("0.2 g_0"), 2, bounds=None)]
        ['4 Hz', '1 Hz']
        """
        return self.scaled_to(self.selection_for(target, count, **arguments))

    scaling_to = scaling_to
    selection_for = selection_for

    matched = matched

    # keeping --------------------------------------------------------------------------------

    def to_dataset(self) -> xr.Dataset:
        """Write the suite as a dataset that plain xarray can store.

        Returns
        -------
        xarray.Dataset
            Over ``motion``: the metadata of each, vertical components last. Over ``sample``: the
            samples of all motions, concatenated, with ``sample_count`` (CF 9.3.3).

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> suite.to_dataset().sizes["motion"]
        2
        """
        return suite_dataset(self)

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> Self:
        """Read what :meth:`to_dataset` wrote, bit for bit.

        Parameters
        ----------
        dataset : xarray.Dataset
            As written.

        Returns
        -------
        MotionSuite

        Raises
        ------
        SchemaError
            The dataset is not one of :meth:`to_dataset`, or its samples were changed.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> rf.MotionSuite.from_dataset(suite.to_dataset())["2 Hz"] == suite["2 Hz"]
        True
        """
        owner = f"{cls.__name__}.from_dataset"
        motions, attributes = stored_motions(checked_dataset(dataset, owner=owner))
        count = len(motions) - attributes.pop("verticals")
        labels = list(motions)
        return cls(
            {label: motions[label] for label in labels[:count]},
            verticals={label: motions[label] for label in labels[count:]},
            **attributes,
        )
