"""Jobs on a Dask cluster: ``workers=over(client)``. Needs the extra ``cluster``.

What happens there is Dask's: a job whose worker dies is given to another, and given up after
more than ``distributed.scheduler.allowed-failures`` deaths (3, unless the scheduler is told
otherwise); a job that raises is not tried again. Workers that Dask's nanny starts, which is the
rule, have one BLAS thread each.
"""

import logging
import pickle
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from compare.jobs.workers import MapLike, WorkersError

if TYPE_CHECKING:
    from distributed import Client

CONNECT_TIMEOUT = 10.0
"""Seconds to wait for a scheduler to answer."""


def over(client: "Client") -> MapLike:
    """A Dask cluster as a map, for ``workers=``.

    Parameters
    ----------
    client : distributed.Client
        Connected; it stays open. Its workers need this distribution, the same version.

    Returns
    -------
    map-like
        Keeps the order. Jobs that are still out when the caller stops are called back; nothing is
        kept on the cluster.
    """
    return _Cluster(client)


@contextmanager
def connect(address: str) -> Iterator[MapLike]:
    """The cluster of a scheduler as a map, while it is needed.

    Parameters
    ----------
    address : str
        Of the scheduler, such as "tcp://scheduler:8786".

    Raises
    ------
    ValueError
        No scheduler answers there, or Dask is not installed.
    """
    host, colon, port = address.rpartition(":")
    if not (host and colon and port.isdigit()):
        raise ValueError(
            f"cluster = {address!r}: no scheduler has such an address; like tcp://host:8786"
        )
    try:
        from distributed import Client
    except ImportError:
        raise ValueError(
            'a cluster needs Dask: pip install "floquet-crosscheck[cluster]"'
        ) from None
    # what Dask has to say of a lost connection is said here, in one line
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
    except (OSError, ValueError):
        raise ValueError(
            f"cluster = {address!r}: no scheduler answers; must be like tcp://host:8786"
        ) from None
    with client:
        yield over(client)


class _Cluster:
    """A client as a map: in order when called, as they are ready by `unordered`."""

    def __init__(self, client: "Client") -> None:
        self._client = client

    def __call__(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        return self._results(function, jobs, iter)

    def unordered(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        """Results as they are ready."""
        from distributed import as_completed

        return self._results(
            function, jobs, lambda futures: as_completed(futures, loop=self._client.loop)
        )

    def _results(
        self,
        function: Callable[[Any], Any],
        jobs: Iterable[Any],
        arranged: Callable[[list[Any]], Iterable[Any]],
    ) -> Iterator[Any]:
        # pure=False: the cluster shall not take one job for another of the same arguments
        futures = self._client.map(_unpacked, _packed(function, jobs), pure=False)
        out = {future.key: future for future in futures}
        try:
            for future in arranged(futures):
                with _translate_losses():
                    result = future.result()
                del out[future.key]
                future.release()
                yield result
        finally:
            if out and self._client.status == "running":
                self._client.cancel(list(out.values()))


def _packed(function: Callable[[Any], Any], jobs: Iterable[Any]) -> list[bytes]:
    """Each job as bytes, with the code of the user's own modules in it: no worker need have it."""
    import cloudpickle

    packed = []
    for job in jobs:
        own = [sys.modules[name] for name in getattr(job, "own_modules", ()) if name in sys.modules]
        for module in own:
            cloudpickle.register_pickle_by_value(module)
        try:
            packed.append(cloudpickle.dumps((function, job)))
        finally:
            for module in own:
                cloudpickle.unregister_pickle_by_value(module)
    return packed


def _unpacked(packed: bytes) -> Any:
    """Run a job, on a worker."""
    function, job = pickle.loads(packed)
    return function(job)


@contextmanager
def _translate_losses() -> Iterator[None]:
    from distributed import CancelledError, KilledWorker
    from distributed.comm import CommClosedError

    try:
        yield
    except KilledWorker:
        raise WorkersError(
            "workers: a job lost every worker that it was given to, killed or out of memory"
        ) from None
    except (CancelledError, CommClosedError):
        raise WorkersError("workers: the cluster was closed before the jobs were done") from None
