"""One trial of extremes.toml: two hands tug at a thread, one parameter of which is changed by a power of ten."""

import tomllib

import numpy as np

import ligature

FREE = [(0.0, (0, 0, 3.0), (0.3, 0, 3.2)), (0.0, (0, 0, 0.5), (1.0, 0, 1.0))]
SUTURE = [(0.0, (0, 0, 0.2), (0.075, 0, 0.22)), (0.0, (0, 0, 0.05), (0.25, 0, 0.15), (0, 0, 0.1))]
DAMPERS = ("suture.stretch_damping", "suture.bend_damping", "suture.swivel_damping", "hands.coupling_N_s_per_m")
ROD_DAMPERS = ("suture.damping_s", "suture.stretch_damping_s", "suture.air_drag_per_s", "hands.coupling_N_s_per_m")
KEYS = {
    "paper": {"stretch": ("suture.stretch_N",), "bend": ("suture.bend",), "damping": DAMPERS, "coupling": ("hands.coupling_N_per_m",),
              "mass": ("suture.node_mass_kg",)},
    "suture-3-0": {"stretch": ("suture.EA_N",), "bend": ("suture.EI_N_m2",), "damping": ROD_DAMPERS,
                   "coupling": ("hands.coupling_N_per_m",), "mass": ("suture.density_kg_per_m",)},
}
DEFAULTS = {"suture.air_drag_per_s": 5.0}  # of the rod; suture-3-0.toml leaves it out


def script(hands, whole_s):
    """Where each hand is at the start, in the middle and, if it lets go, at the end."""
    keys = []
    for start_s, *places in hands:
        times = (start_s, 0.5 * whole_s, whole_s)
        keys.append([[time_s, *place, number < 2] for number, (time_s, place) in enumerate(zip(times, places))])
    return ligature.Script.of_keys(*keys)


def trial(parameters, seed):
    """How it ended: finite, stopped (with tick and likely cause), refused, or LEAKED: a number that is not finite got out."""
    name = parameters["thread"]
    path = ligature.SCENES / f"{name}.toml"
    file = tomllib.loads(path.read_text())
    overrides = {"time.tick_s": parameters["step_s"]}
    for key in KEYS[name][parameters["dial"]]:
        table, entry = key.split(".")
        overrides[key] = file[table].get(entry, DEFAULTS.get(key)) * 10.0 ** parameters["decade"]
    ticks, hands = (2000, FREE) if name == "paper" else (300, SUTURE)
    try:
        simulation = ligature.Simulation(ligature.Scene.load(path, overrides))
    except ligature.Refusal as why:
        return {"ending": "refused", "stays_finite": False, "ticks": 0, "cause": str(why)}
    whole_s = ticks * parameters["step_s"]
    run = simulation.run(script(hands, whole_s), whole_s, shape_every_s=1e6)
    leaked = np.isnan(run.trace).any() or not np.isfinite(run.trace[:, :9]).all() or not np.isfinite(run.shapes).all()
    ending = "LEAKED" if leaked else "finite" if run.finite else "stopped"
    return {"ending": ending, "stays_finite": ending == "finite", "ticks": len(run.trace), "cause": run.failure}
