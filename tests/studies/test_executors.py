"""All executors give bit-identical results, and lose nothing when a worker dies."""

import concurrent.futures
import os
import shutil
import signal
import subprocess
import sys
import threading

import pytest
import xarray
from small import AXES, PAD, PAD_FORCES, environment, long_study, run, write

import mfv
from mfv.studies.cases import one_blas_thread, solve
from mfv.studies.namelist import read_study


class InOneProcess(concurrent.futures.ProcessPoolExecutor):
    """An executor of the user's own."""

    def __init__(self):
        super().__init__(1)


@pytest.mark.parametrize("workers", [2, 5])
def test_threads(study, workers):
    folder, table = study
    assert xarray.Dataset.identical(table, mfv.study(folder / "base.nml", AXES, reference="full", workers=workers))


def test_processes(study):
    folder, table = study
    assert table.identical(mfv.study(folder / "base.nml", AXES, reference="full", executor="processes", workers=2))


def test_warnings_and_bars_are_the_same_everywhere(tmp_path):
    """In processes, and read from the store: NaN of what is not resolved, nothing of what has no bar."""
    (tmp_path / "pad.nml").write_text(PAD)

    def solved(**options):
        return mfv.study(tmp_path / "pad.nml", {"Q": PAD_FORCES}, error_estimate=True, store=tmp_path / "pad.sqlite", **options)

    first = solved()
    assert first.attrs["cases_flagged"] == 1 and "cycle_dissipation_error" in first and "cycles_error" not in first
    assert first.identical(solved()) and first.identical(solved(executor="processes", workers=1, again=True))


def test_an_executor_of_the_users_own(study):
    folder, table = study
    with InOneProcess() as pool:
        assert table.identical(mfv.study(folder / "base.nml", AXES, reference="full", executor=pool))
        assert pool.submit(int, "7").result() == 7  # it stays open


def test_dask(study):
    distributed = pytest.importorskip("distributed")
    folder, table = study
    assert table.identical(mfv.study(folder / "base.nml", AXES, reference="full", executor="dask", workers=2))
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        by_address = mfv.study(folder / "base.nml", AXES, reference="full", executor=f"dask:{cluster.scheduler_address}")
    assert table.identical(by_address)


@pytest.mark.parametrize("ranks", [3])
def test_mpi(study, ranks, tmp_path):
    """One rank hands out, the others solve."""
    pytest.importorskip("mpi4py")
    if shutil.which("mpiexec") is None:
        pytest.skip("there is no mpiexec")
    folder, _ = study
    launcher = ["mpiexec", "-n", str(ranks), sys.executable, "-m", "mpi4py.futures"]
    done = subprocess.run(
        [*launcher, "-m", "mfv", "study", str(folder / "study.nml"), "-o", "by_mpi.nc", "--executor", "mpi"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        env=environment(),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    done = run(folder / "study.nml", "-o", "by_threads.nc", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    with xarray.open_dataset(tmp_path / "by_mpi.nc") as one, xarray.open_dataset(tmp_path / "by_threads.nc") as other:
        assert one.identical(other)


def test_a_dask_worker_is_killed(tmp_path):
    """What it was at is solved by the others."""
    distributed = pytest.importorskip("distributed")
    long_study(tmp_path)
    undisturbed = read_study(tmp_path / "study.nml").run()
    killed, is_done = [], threading.Event()
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        client = distributed.Client(cluster)

        def kill_when_at_work():
            while not client.processing() or not all(client.processing().values()):
                if is_done.wait(0.01):
                    return
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

        killer = threading.Thread(target=kill_when_at_work)
        killer.start()
        table = read_study(tmp_path / "study.nml").run(executor=client.get_executor())
        is_done.set()
        killer.join()
        client.close()
    assert killed and table.identical(undisturbed)


def die(jobs):
    """What a worker that runs out of memory does."""
    if dict(jobs[0].settings)["friction%mu"] == 0.7:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(jobs)


def test_a_worker_process_is_killed(study, tmp_path, monkeypatch):
    """The study ends with its solved cases saved, and can be continued."""
    folder, table = study
    kept = {"reference": "full", "executor": "processes", "workers": 1, "store": tmp_path / "cases.sqlite"}
    monkeypatch.setattr("mfv.studies.executors.solve", die)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    with pytest.raises(concurrent.futures.process.BrokenProcessPool):
        mfv.study(folder / "base.nml", AXES, **kept)
    monkeypatch.undo()
    planned = mfv.Study(folder / "base.nml", AXES, reference="full")
    assert 0 < planned.so_far(tmp_path / "cases.sqlite").attrs["cases_done"] < len(planned)
    assert table.identical(mfv.study(folder / "base.nml", AXES, **kept))


def test_blas_is_left_as_it_was(study):
    threadpoolctl = pytest.importorskip("threadpoolctl")

    def threads():
        return [pool["num_threads"] for pool in threadpoolctl.threadpool_info() if pool["user_api"] == "blas"]

    with threadpoolctl.threadpool_limits(2, user_api="blas"):
        before = threads()
        with one_blas_thread():  # another study, in another thread
            mfv.study(study[0] / "base.nml", {"friction%mu": [0.5]})
            assert set(threads()) == {1}
        assert threads() == before


def test_names_of_executors(study, tmp_path):
    folder, _ = study
    with pytest.raises(ValueError, match="unknown executor 'thread'; choose from threads, processes, mpi, dask, dask:ADDRESS"):
        mfv.study(folder / "base.nml", AXES, executor="thread")
    with pytest.raises(ValueError, match="workers must be 1 or more, not 0"):
        mfv.study(folder / "base.nml", AXES, workers=0)
    with InOneProcess() as pool, pytest.raises(ValueError, match="workers= has no effect with an Executor object"):
        mfv.study(folder / "base.nml", AXES, executor=pool, workers=2)
    write(tmp_path)
    done = run("study.nml", "--executor", "treads", cwd=tmp_path)
    assert done.returncode == 2 and "unknown executor 'treads'" in done.stderr
