"""Sweeps over every executor: equal to the bit, no result is lost with a worker, no work is done twice."""

from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path

import pytest
from sweep.cluster import cluster
from sweep.work import counted, dies_always, dies_once, fails, moved

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.sweep import Journal, Pool, open_pool, sweep
from pneumo_ros.sweep.sweep import TRIES

VOLTS = {f"{volts:g} V": (volts,) for volts in (-3.0, -1.0, 0.1, 1.1, 2.5, 7.0)}
NAMES = ("a", "b", "deadly", "c", "d", "e")


@pytest.fixture(scope="module")
def dask(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A cluster for all tests of this file."""
    with cluster(tmp_path_factory.mktemp("dask")) as address:
        yield f"dask={address}"


def answers(executor: str, work: object, jobs: dict[str, tuple[object, ...]]) -> dict[str, object]:
    """Results by key."""
    with open_pool(executor) as pool:
        return {done.key: done.result for done in sweep(work, jobs, pool)}


def times(folder: Path) -> dict[str, int]:
    """How often each name was counted."""
    return {name: len((folder / name).read_text()) for name in NAMES if (folder / name).exists()}


def test_one_process_many_and_a_cluster_give_the_same_to_the_bit(dask: str) -> None:
    here = answers("one", moved, VOLTS)
    assert len({tuple(row) for row in here.values()}) == len(VOLTS)
    assert here == answers("processes=2", moved, VOLTS) == answers(dask, moved, VOLTS)


def test_any_executor_will_do() -> None:
    with Pool(lambda: ThreadPoolExecutor(2), 2) as pool:
        assert {done.key: done.result for done in sweep(moved, VOLTS, pool)} == answers("one", moved, VOLTS)


@pytest.mark.parametrize("executor", ["processes=2", "dask"])
def test_a_killed_workers_work_is_done_again(executor: str, dask: str, tmp_path: Path) -> None:
    jobs = {name: (str(tmp_path), name) for name in NAMES}
    found = answers(dask if executor == "dask" else executor, dies_once, jobs)
    assert found == {name: name for name in NAMES}
    assert (tmp_path / "dead").exists()


def test_work_that_kills_every_worker_is_given_up_and_the_rest_is_done(tmp_path: Path) -> None:
    with open_pool("processes=2") as pool:
        found = {d.key: d for d in sweep(dies_always, {name: (str(tmp_path), name) for name in NAMES}, pool)}
    assert found["deadly"].problem == f"its worker died {TRIES} times, possibly for lack of memory"
    assert {key for key, done in found.items() if done.result == key} == set(NAMES) - {"deadly"}


def test_work_whose_worker_always_dies_is_tried_three_times() -> None:
    """Alone each time: also an executor that loses every worker gets it only that often."""
    tried: list[str] = []

    class Deadly(Executor):
        """Every worker dies at once."""

        def submit(self, work: object, key: str) -> Future[None]:
            tried.append(key)
            future: Future[None] = Future()
            future.set_exception(BrokenExecutor())
            return future

    (done,) = sweep(str, {"deadly": ("deadly",)}, Pool(Deadly, 1))
    assert done.problem.startswith(f"its worker died {TRIES} times")
    assert tried == ["deadly"] * TRIES


def test_an_interrupted_sweep_goes_on_with_what_it_had(tmp_path: Path) -> None:
    jobs = {name: (str(tmp_path), name) for name in NAMES}
    with open_pool("one") as pool:
        with Journal(tmp_path / "results", {"seed": 1}) as journal:
            course = sweep(counted, jobs, pool, journal)
            first = [next(course).key for _ in range(3)]  # and then the machine is switched off
        with (tmp_path / "results").open("ab") as file:
            file.write(b'{"key": "half a li')
        with Journal(tmp_path / "results", {"seed": 1}) as journal:
            again = list(sweep(counted, jobs, pool, journal))
    assert sorted(done.key for done in again if not done.fresh) == sorted(first)
    assert {done.key: done.result for done in again} == {name: name for name in NAMES}
    assert all(times(tmp_path)[name] == 1 for name in first)
    with Journal(tmp_path / "results", {"seed": 1}) as journal:
        assert set(journal.results) == set(NAMES)


def test_problems_are_results_and_mistakes_end_the_sweep(tmp_path: Path) -> None:
    with open_pool("one") as pool, Journal(tmp_path / "results", {}) as journal:
        (unfit,) = sweep(fails, {"unfit": ("unfit",)}, pool, journal)
        assert (unfit.result, unfit.problem) == (None, "this recording is unfit")
        (again,) = sweep(fails, {"unfit": ("unfit",)}, pool, journal)
        assert (again.problem, again.fresh) == ("this recording is unfit", False)
        with pytest.raises(ZeroDivisionError):
            list(sweep(fails, {"wrong": ("wrong",)}, pool, journal))


@pytest.mark.parametrize(
    ("content", "error", "said"),
    [
        (b'{"sweep": {"seed": 2}}\n', UsageError, "of another sweep"),
        (b"a diary\n", UsageError, "of another sweep"),
        (b"a diary", UsageError, "no file of results"),
        (b'{"sweep": {"seed": 1}}\n{"key": 1}\n', DataError, "line 2"),
        (b'{"sweep": {"seed": 1}}\nnonsense\n', DataError, "line 2"),
    ],
)
def test_a_file_of_another_kind_is_left_alone(
    content: bytes, error: type[Exception], said: str, tmp_path: Path
) -> None:
    (tmp_path / "results").write_bytes(content)
    with pytest.raises(error, match=said):
        Journal(tmp_path / "results", {"seed": 1})
    assert (tmp_path / "results").read_bytes() == content


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("process", "did you mean processes"),
        ("processes=0", "from 1 on"),
        ("processes=x", "from 1 on"),
        ("one=2", "unknown executor"),
        ("dask", "takes the address of a scheduler"),
        ("dask=localhost", "takes the address of a scheduler"),
    ],
)
def test_an_unknown_executor(name: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        open_pool(name)
