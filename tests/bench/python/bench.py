"""Cost of Python over C++: the overhead per tick, and how much faster 64 runs are on two cores than on one.

    PYTHONPATH=build/dev/python-package build/venv/bin/python tests/bench/python/bench.py

Both sides alternate within one process, so that other load on the machine affects both. The overhead is CPU time of this
thread, in the fastest of several rounds. The ratio of cores is of elapsed time and needs a quiet machine: it is taken in
each round, and the median counts, as a core's clock changes from round to round. Beside it stands the ratio of two separate
processes, which share nothing: it is what the machine itself gives."""

import multiprocessing
import statistics
import time

import ligature

ROUNDS, PAIRS = 7, 15
RUNS, ROLLOUT_S = 64, 8.0  # number of runs, and duration of each


def timed(work, clock=time.perf_counter):
    """Time of work(), s, without that of freeing its results: they are dropped after the clock was read."""
    begun_s = clock()
    kept = work()
    took_s = clock() - begun_s
    del kept
    return took_s


def overhead_us(scene, ticks):
    """CPU times per tick, us: of Simulation.run() in C++, and of a Python loop that calls tick() with two resting tools."""
    sim = ligature.Simulation(scene)
    away = [0.0, 0.0, -1000.0, 0]
    script = ligature.Script.of_keys([[0.0, *away]], [[0.0, *away]])
    inside_s, outside_s = [], []

    def loop():
        tick, left, right = sim.tick, ligature.Tool(away[:3]), ligature.Tool(away[:3])
        for _ in range(ticks):
            left.p_W_m = (0.0, 0.0, -1000.0)
            tick(left, right)

    for _ in range(ROUNDS):
        sim.reset()
        inside_s.append(timed(lambda: sim.run(script, ticks * scene.tick_s, shape_every_s=1e6), time.thread_time))
        sim.reset()
        outside_s.append(timed(loop, time.thread_time))
    return 1e6 * min(inside_s) / ticks, 1e6 * min(outside_s) / ticks


def rig():
    """A simulation of the paper's scene, and 64 scripts."""
    sim = ligature.Simulation(ligature.Scene.load(ligature.SCENES / "paper.toml"))
    return sim, [ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")] * RUNS


def half_of_the_runs(start, end):
    """One of the two processes: waits for the start, does its runs, and reports at the end."""
    sim, scripts = rig()
    for _ in range(PAIRS):
        start.wait()
        sim.rollout(scripts[: RUNS // 2], 1, duration_s=ROLLOUT_S)
        end.wait()


def rollout_ratios():
    """How many times as fast 64 runs are as on one core: on two cores, and in two processes of one core. A round is some
    seconds, so that starting the threads does not count."""
    sim, scripts = rig()
    spawn = multiprocessing.get_context("spawn")
    start, end = spawn.Barrier(3), spawn.Barrier(3)
    processes = [spawn.Process(target=half_of_the_runs, args=(start, end)) for _ in range(2)]
    for process in processes:
        process.start()
    two, apart = [], []
    for _ in range(PAIRS):
        one_s = timed(lambda: sim.rollout(scripts, 1, duration_s=ROLLOUT_S))
        two.append(one_s / timed(lambda: sim.rollout(scripts, 2, duration_s=ROLLOUT_S)))
        start.wait()
        apart.append(one_s / timed(end.wait))
    for process in processes:
        process.join()
    return two, apart


def main():
    for nodes in (20, 50):
        scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": nodes})
        inside, outside = overhead_us(scene, 5000)
        print(f"paper, {nodes} nodes: {inside:.2f} us a tick in C++, {outside:.2f} us from Python: overhead {outside - inside:.2f} us")
    two, apart = rollout_ratios()
    print(f"{RUNS} runs of {ROLLOUT_S:g} s: {statistics.median(two):.2f} times as fast on two cores as on one ({min(two):.2f} .. "
          f"{max(two):.2f}), {statistics.median(apart):.2f} times in two separate processes ({min(apart):.2f} .. {max(apart):.2f})")


if __name__ == "__main__":
    main()
