"""An executor that raises KeyboardInterrupt."""

from concurrent.futures import Executor, Future


class Interrupting(Executor):
    """Runs chunks immediately, and raises KeyboardInterrupt after some of them."""

    def __init__(self, after):
        self.left = after

    def submit(self, function, /, *arguments, **options):
        future = Future()
        if self.left:
            self.left -= 1
            future.set_result(function(*arguments, **options))
        else:
            future.set_exception(KeyboardInterrupt())
        return future
