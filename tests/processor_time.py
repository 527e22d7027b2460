"""Processor time that a call needs, without what happens to come between."""

import time
from collections.abc import Callable
from typing import Any


def processor_time(call: Callable[[], Any], enough: float) -> float:
    """Seconds that a call takes of the processor.

    A call that took longer than `enough` is asked once more, and the lesser time told: a garbage
    collection of a process with much in it takes a second by itself.
    """
    times = []
    while len(times) < 2 and min(times, default=enough) >= enough:
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)
