"""Where the runs are done: processes of this machine, a running Dask scheduler, or jobs of Slurm. One thread a worker."""

import contextlib
import logging
import os
from collections.abc import Iterator
from typing import Any

import dask
from distributed import Client, LocalCluster
from distributed.core import Status
from tornado.ioloop import PeriodicCallback

from ligature._core import Refusal

# Numerical libraries in a worker use one thread, because every core has a worker.
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS",
                                     "NUMEXPR_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")}
ANSWER_S = 10  # limit for the scheduler's first answer
LOOK_MS = 1000  # between two looks for lost workers


def slurm_cluster(options: dict[str, Any]) -> Any:
    """A cluster of Slurm jobs, each with one worker of one thread; `job_script()` shows what is submitted.

    options: further keywords of dask_jobqueue.SLURMCluster. Raises Refusal.
    """
    try:
        from dask_jobqueue import SLURMCluster
    except ModuleNotFoundError:
        raise Refusal("--slurm: dask-jobqueue is not installed; remedy: pip install .[study]") from None
    asked = {"cores": 1, "processes": 1, "memory": "2GB", "walltime": "01:00:00",
             "scheduler_options": {"dashboard_address": ":0"}} | options
    prologue = [f"export {name}={value}" for name, value in ONE_THREAD.items()]
    try:
        return SLURMCluster(**asked, job_script_prologue=prologue)
    except (TypeError, ValueError, RuntimeError) as why:
        raise Refusal(f"--slurm-set: {str(why).splitlines()[0]}, allowed keywords of dask_jobqueue.SLURMCluster") from None


def _keep(cluster: LocalCluster, count: int, stack: contextlib.ExitStack) -> None:
    """Replaces workers that Dask gives up: on a busy machine a restart may take longer than it waits for."""

    def look() -> None:
        for name, worker in list(cluster.workers.items()):
            if worker.status in (Status.failed, Status.closed):
                del cluster.workers[name]
        cluster.scale(count)

    keeper = PeriodicCallback(look, LOOK_MS)
    cluster.loop.add_callback(keeper.start)
    stack.callback(cluster.loop.add_callback, keeper.stop)


def _reached(scheduler: str) -> Client:
    try:
        client = Client(scheduler, timeout=ANSWER_S)
    except (OSError, TimeoutError, ValueError) as why:
        raise Refusal(f"--scheduler {scheduler}: {str(why).splitlines()[0]}; remedy: start it with 'dask scheduler', and its "
                      "workers with 'dask worker ADDRESS --nthreads 1'") from None
    for address, worker in client.scheduler_info(n_workers=-1)["workers"].items():
        if worker["nthreads"] != 1:
            client.close()
            raise Refusal(f"--scheduler {scheduler}: worker {address} has {worker['nthreads']} threads, allowed 1; remedy: "
                          "start it with --nthreads 1")
    return client


@contextlib.contextmanager
def workers_of(workers: int | None = None, scheduler: str | None = None, slurm: int | None = None,
               slurm_options: dict[str, Any] | None = None) -> Iterator[Client]:
    """A client of the wanted cluster, which ends with it, but for a scheduler that somebody else has started."""
    if sum(chosen is not None for chosen in (workers, scheduler, slurm)) > 1:
        raise Refusal("--workers, --scheduler, --slurm: found several, allowed one")
    logging.getLogger("distributed").setLevel(logging.ERROR)
    with contextlib.ExitStack() as stack:
        # A run that ends its worker twice is given up; else it would end all workers of a large cluster. No second run
        # waits in a worker, since it would be blamed too.
        stack.enter_context(dask.config.set({"distributed.scheduler.allowed-failures": 1,
                                             "distributed.scheduler.worker-saturation": 1.0,
                                             "distributed.nanny.pre-spawn-environ": ONE_THREAD}))
        if scheduler is not None:
            yield stack.enter_context(_reached(scheduler))
            return
        if slurm is not None:
            cluster = stack.enter_context(slurm_cluster(slurm_options or {}))
            cluster.scale(jobs=slurm)
        else:
            count = workers or len(os.sched_getaffinity(0))
            cluster = stack.enter_context(LocalCluster(n_workers=count, threads_per_worker=1, processes=True,
                                                       dashboard_address="127.0.0.1:0", silence_logs=logging.ERROR))
            _keep(cluster, count, stack)
        yield stack.enter_context(Client(cluster))
