"""Jobs on a Dask cluster: ``workers=over(client)``. Needs the extra ``cluster``.

What happens there is Dask's: a job whose worker dies is given to another, and given up after
more than ``distributed.scheduler.allowed-failures`` deaths (3, unless the scheduler is told
otherwise); a job that raises is not tried again. Workers that Dask's nanny starts, which is the
rule, have one BLAS thread each.
"""

import logging
import pickle
import re
import socket
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from compare.jobs.workers import MapLike, WorkersError

if TYPE_CHECKING:
    from distributed import Client

CONNECT_TIMEOUT, KNOCK_TIMEOUT = 10.0, 3.0
"""Seconds to wait for a scheduler to answer, and for anybody there at all."""

SCHEMES = ("tcp", "tls", "ws", "wss", "ucx")
"""How Dask speaks to a scheduler, in its addresses."""


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
    host, port = _host_and_port(address)
    try:
        import distributed  # noqa: F401 - whether it is there
    except ImportError:
        raise ValueError(
            'a cluster needs Dask: pip install "floquet-crosscheck[cluster]"'
        ) from None
    _silence()
    try:
        # Dask would try again and again where nobody listens
        socket.create_connection((host, port), KNOCK_TIMEOUT).close()
        client = _client(address)
    except OSError:
        raise ValueError(
            f"cluster = {address!r}: no scheduler answers; must be like tcp://host:8786"
        ) from None
    with client:
        yield over(client)


def _client(address: str) -> "Client":
    """A client, or `TimeoutError`: what is no scheduler may keep Dask waiting for ever."""
    from distributed import Client

    class Patient(Client):  # type: ignore[misc]
        """One that was never connected has nothing to close, and Dask would wait for it."""

        def __del__(self) -> None:
            if self.status == "running":
                super().__del__()

    made: list[Patient] = []

    def make() -> None:
        # whatever it is that Dask makes of another protocol
        with suppress(Exception):
            made.append(Patient(address, timeout=CONNECT_TIMEOUT, set_as_default=False))

    thread = threading.Thread(target=make, daemon=True)
    thread.start()
    thread.join(CONNECT_TIMEOUT)
    if not made:
        raise TimeoutError
    return made[0]


def _host_and_port(address: str) -> tuple[str, int]:
    scheme, _, rest = address.rpartition("://")
    host, _, port = rest.rpartition(":")
    known = scheme in ("", *SCHEMES) and host.strip("[]") and re.fullmatch(r"[0-9]{1,5}", port)
    if not known or not 0 < int(port) < 1 << 16:
        raise ValueError(
            f"cluster = {address!r}: no scheduler has such an address; like tcp://host:8786"
        )
    return host.strip("[]"), int(port)


def _silence() -> None:
    """What Dask has to say of a lost connection is said here, in one line."""
    for name in ("distributed", "asyncio", *logging.root.manager.loggerDict):
        # Dask has set a level for some of its loggers itself
        if name.partition(".")[0] in ("distributed", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


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
