"""Cost of Python over C++: the overhead per tick, and how much faster 64 runs are on two cores than on one.

    PYTHONPATH=build/dev/python-package build/venv/bin/python tests/bench/python/bench.py

Ratios are measured within one process, both sides alternating, with the fastest of several rounds each, so that other
load on the machine affects both."""

import time

import ligature

ROUNDS = 7


def timed(work):
    begun_s = time.perf_counter()
    work()
    return time.perf_counter() - begun_s


def overhead_us(scene, ticks):
    """Times per tick, us: of Simulation.run() in C++, and of a Python loop that calls tick() with two resting tools."""
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
        inside_s.append(timed(lambda: sim.run(script, ticks * scene.tick_s, shape_every_s=1e6)))
        sim.reset()
        outside_s.append(timed(loop))
    return 1e6 * min(inside_s) / ticks, 1e6 * min(outside_s) / ticks


def rollout_s(sim, scripts, threads):
    return min(timed(lambda: sim.rollout(scripts, threads, duration_s=0.5)) for _ in range(3))


def main():
    for nodes in (20, 50):
        scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": nodes})
        inside, outside = overhead_us(scene, 5000)
        print(f"paper, {nodes} nodes: {inside:.2f} us a tick in C++, {outside:.2f} us from Python: overhead {outside - inside:.2f} us")
    sim = ligature.Simulation(ligature.Scene.load(ligature.SCENES / "paper.toml"))
    scripts = [ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")] * 64
    one, two = rollout_s(sim, scripts, 1), rollout_s(sim, scripts, 2)
    print(f"64 runs of 500 ticks: {one:.2f} s on one core, {two:.2f} s on two: {one / two:.2f} times")


if __name__ == "__main__":
    main()
