"""What to do when a file holds another number of samples than it announces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from rockframe.records.source import Metadata, Source

_FEWEST_SHARE: Final = 0.9
_FEWEST_MISSING: Final = 5


def settle_count(
    source: Source, *, declared: int, counted: int, what: str, line: int
) -> tuple[Metadata, list[str]]:
    """Compare the announced number of samples with the data; the data count."""
    missing = declared - counted
    if counted < 2 or missing > max(_FEWEST_MISSING, (1.0 - _FEWEST_SHARE) * declared):
        raise source.refuse(
            found=f"the end of the file after {counted} samples",
            expected=f"{declared} samples ({what} in line {line})",
            line=source.last_line,
        )
    if not missing:
        return {}, []
    words = (
        f"{source.path}, line {line}: {what} declares {declared} samples, but the file "
        f"holds {counted}; the {counted} are used"
    )
    return {"declared_samples": declared, "counted_samples": counted}, [words]
