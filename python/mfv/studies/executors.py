"""Executors by name, and the loop that submits cases to one of them."""

from __future__ import annotations

import contextlib
import functools
import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from concurrent.futures import TimeoutError as FuturesTimeout
from ctypes import c_int
from typing import Any

from .._packages import require
from .cases import Job, Solved, one_blas_thread, solve, solve_here

#: Names of executors; 'dask:ADDRESS' is a running cluster.
NAMES = ("threads", "processes", "mpi", "dask")

#: Longest wait for the first case and longest duration of a task [seconds]; smallest number of tasks.
LONGEST_WAIT, LONGEST_TASK, LEAST_TASKS = 1.0, 0.25, 64


def solve_all(jobs: Mapping[str, Job], executor: str | Executor, workers: int | None, keep: Callable[[str, Solved], None]) -> None:
    """Solve cases with an executor, and call `keep` in this process with the hash and the results of each.

    Errors are raised after the remaining tasks have been stopped; results saved before stay saved.
    """
    with opened(executor, workers) as pool, contextlib.ExitStack() as stack:
        stop = c_int(0)
        function: Callable[[Sequence[Job]], tuple[float, list[Solved | None]]] = solve
        if isinstance(pool, ThreadPoolExecutor):
            function = functools.partial(solve_here, stop)
            stack.enter_context(one_blas_thread())
        tasks: dict[Future[Any], list[str]] = {}
        try:
            for names in _cut(list(jobs), tasks, isinstance(pool, ThreadPoolExecutor)):
                tasks[pool.submit(function, [jobs[name] for name in names])] = names
            for task in as_completed(tasks):
                for name, solved in zip(tasks[task], task.result()[1]):
                    if solved is not None:
                        keep(name, solved)
        except BaseException:
            stop.value = 1
            if isinstance(executor, Executor) or not isinstance(pool, ProcessPoolExecutor):  # ours ends its processes
                for task in tasks:
                    task.cancel()
            raise


def _cut(names: list[str], tasks: Mapping[Future[Any], Any], one_by_one: bool) -> Iterator[list[str]]:
    """The hashes of the cases of every task. The overhead of a task may exceed a short case: the duration of the first case is
    measured, and tasks last up to a quarter of a second. There are at least 64 tasks, to balance the workers."""
    size = 1
    if names and not one_by_one:
        yield names[:1]
        names = names[1:]
        with contextlib.suppress(TimeoutError, FuturesTimeout):
            seconds, _ = next(iter(tasks)).result(timeout=LONGEST_WAIT)
            size = max(1, min(int(LONGEST_TASK / max(seconds, 1e-6)), len(names) // LEAST_TASKS))
    for at in range(0, len(names), size):
        yield names[at : at + size]


def check(executor: Any, workers: int | None) -> None:
    """Raises TypeError for an object other than an executor, ValueError for an unknown name or an invalid number of workers."""
    if isinstance(executor, Executor):
        if workers is not None:
            raise ValueError("workers= has no effect with an Executor object; remove it")
        return
    if not isinstance(executor, str):
        raise TypeError(f"executor must be a concurrent.futures.Executor or a name, not {executor!r}")
    name, _, address = executor.partition(":")
    if name not in NAMES or (address and name != "dask"):
        raise ValueError(f"unknown executor '{executor}'; choose from {', '.join(NAMES)}, dask:ADDRESS")
    if workers is not None and (workers < 1 or address):
        raise ValueError(
            "workers has no effect with a running cluster; remove it" if address else f"workers must be 1 or more, not {workers}"
        )


@contextlib.contextmanager
def opened(executor: str | Executor, workers: int | None) -> Iterator[Executor]:
    """An executor by name, closed at the end, or one of the caller, which stays open.

    Raises ModuleNotFoundError if its package is not installed.
    """
    if isinstance(executor, Executor):
        yield executor
        return
    name, _, address = executor.partition(":")
    with contextlib.ExitStack() as stack:
        if name == "threads":
            yield stack.enter_context(ThreadPoolExecutor(workers or processors()))
        elif name == "processes":
            yield stack.enter_context(_processes(workers or processors()))
        elif name == "mpi":
            require("mpi4py")
            from mpi4py.futures import MPIPoolExecutor

            pool = MPIPoolExecutor(max_workers=workers)
            stack.callback(pool.shutdown, cancel_futures=True)
            yield pool
        else:
            require("dask", "distributed")
            from dask.distributed import Client, LocalCluster

            cluster = address or stack.enter_context(
                LocalCluster(
                    n_workers=workers or processors(),
                    threads_per_worker=1,
                    dashboard_address=":0",
                    silence_logs=logging.CRITICAL,
                )
            )
            yield stack.enter_context(Client(cluster)).get_executor()


def processors() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextlib.contextmanager
def _processes(workers: int) -> Iterator[Executor]:
    """Spawned processes, which are ended at once when the study is interrupted."""
    method = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
    context: Any = multiprocessing.get_context(method)
    with ProcessPoolExecutor(workers, context, _belong_to_the_study) as pool:
        try:
            yield pool
        except BaseException:
            ours = list((getattr(pool, "_processes", None) or {}).values())
            pool.shutdown(wait=False, cancel_futures=True)
            for process in ours:
                process.terminate()
            raise


def _belong_to_the_study() -> None:
    """Ignore Ctrl-C, which the study handles, and end with the study."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_the_study, daemon=True).start()


def _end_with_the_study() -> None:
    study = multiprocessing.parent_process()
    if study is not None:
        study.join()
        os._exit(1)
