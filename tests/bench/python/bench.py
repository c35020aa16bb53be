"""Cost of Python over C++: the overhead per tick, and how much faster 64 runs are on two cores than on one.

    PYTHONPATH=build/dev/python-package build/venv/bin/python tests/bench/python/bench.py

Both sides alternate within one process, and the fastest of several rounds counts, so that other load on the machine
affects both. The overhead is CPU time of this thread. The ratio of cores is of elapsed time and needs a quiet machine."""

import time

import ligature

ROUNDS = 7
ROLLOUT_S = 8.0  # of the script, in each of the 64 runs


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


def rollout_s(sim, scripts):
    """Times of 64 runs, s: on one core and on two. A round is some seconds, so that starting the threads does not count."""
    times = {1: [], 2: []}
    for _ in range(ROUNDS):
        for threads, rounds in times.items():
            rounds.append(timed(lambda: sim.rollout(scripts, threads, duration_s=ROLLOUT_S)))
    return min(times[1]), min(times[2])


def main():
    for nodes in (20, 50):
        scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": nodes})
        inside, outside = overhead_us(scene, 5000)
        print(f"paper, {nodes} nodes: {inside:.2f} us a tick in C++, {outside:.2f} us from Python: overhead {outside - inside:.2f} us")
    sim = ligature.Simulation(ligature.Scene.load(ligature.SCENES / "paper.toml"))
    scripts = [ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")] * 64
    one, two = rollout_s(sim, scripts)
    print(f"64 runs of {round(ROLLOUT_S / sim.scene.tick_s)} ticks: {one:.2f} s on one core, {two:.2f} s on two: {one / two:.2f} times")


if __name__ == "__main__":
    main()
