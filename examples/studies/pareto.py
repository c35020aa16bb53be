"""One run of pareto.toml: what a tick costs, and how far a swinging thread is from the model's finest setting."""

import functools
import time
import tomllib

import numpy as np

import ligature

THREADS = {"rod": ("suture-3-0.toml", 10), "paper": ("paper.toml", 40)}  # scene, and ms between compared places: 20 of them
FINEST = {"rod": (200, 64, "fine"), "paper": (200, 64, None)}  # nodes, time steps in a tick, suture.accuracy


def thread(model, nodes):
    """Settings of a thread whose properties per length do not depend on the number of its nodes."""
    if model == "rod":
        return {}
    finer = 49 / (nodes - 1)  # segments against those of the paper, whose table is for 50 nodes
    table = tomllib.loads((ligature.SCENES / "paper.toml").read_text())["suture"]
    powers = {"node_mass_kg": 1, "stretch_damping": -1, "bend": -1, "bend_damping": -1, "swivel_damping": -2}
    return {f"suture.{key}": table[key] * finer**power for key, power in powers.items()}


def swing(model, nodes, substeps, accuracy=None):
    """The thread starts level and swings from its fixed end. @returns places of the free end, of the length; us a tick."""
    file, every = THREADS[model.split("-")[0]]
    settings = {"suture.model": model, "suture.nodes": nodes, "time.substeps": substeps, "contact.solver": "none",
                "world.fixed": [{"node": 0, "position_m": [0.0, 0.0, 0.0]}], **thread(model, nodes)}
    scene = ligature.Scene.load(ligature.SCENES / file, settings | ({"suture.accuracy": accuracy} if accuracy else {}))
    sim = ligature.Simulation(scene)
    sim.set_state(np.linspace((0.0, 0.0, 0.0), (scene.length_m, 0.0, 0.0), nodes))
    ends, us = [], []
    for tick in range(1, 20 * every + 1):
        begun_s = time.thread_time()
        if not sim.tick(None, None):
            raise RuntimeError(f"the thread diverged in tick {tick}")
        us.append(1e6 * (time.thread_time() - begun_s))
        if tick % every == 0:
            ends.append(sim.nodes[-1] / scene.length_m)
    return np.array(ends), np.median(us)


@functools.cache
def finest(model):
    return swing(model, *FINEST[model.split("-")[0]])[0]


def trial(parameters, seed):
    """tick_us, and swing: the root mean square of the free end's distance from the finest one's, in lengths of the thread."""
    model = parameters["model"]
    ends, us = swing(model, parameters["nodes"], parameters["substeps"], "fast" if model == "rod" else None)
    return {"tick_us": us, "swing": np.sqrt(((ends - finest(model)) ** 2).sum(axis=1).mean())}
