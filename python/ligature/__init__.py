"""Ligature for Python: the simulated suture thread, scenes, knots and recordings.

    import ligature
    scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": 35})
    run = ligature.Simulation(scene).run(ligature.Script.load(ligature.SCENES / "operators/overhand.csv"))
    print(ligature.knot(run.shapes[-1]).type)  # 3_1

SI units; vectors are x, y, z in the world frame W (x right, y away from the user, z up). Invalid input raises
`Refusal`, a ValueError, with the one-line message that the programs print.
"""

import pathlib

from ligature import cpu

cpu.require()

from ligature._core import Diagnostics, Hand, Knot, Refusal, Tool, __version__  # noqa: E402
from ligature.inputs import Scene, Script, knot  # noqa: E402
from ligature.recording import TICK_COLUMNS, Recording, Rerun, rerun  # noqa: E402
from ligature.simulation import Contacts, Run, Simulation  # noqa: E402

SCENES = pathlib.Path(__file__).parent / "scenes"  # the shipped scenes

__all__ = [
    "SCENES", "TICK_COLUMNS", "Contacts", "Diagnostics", "Hand", "Knot", "Recording", "Refusal", "Rerun", "Run", "Scene",
    "Script", "Simulation", "Tool", "__version__", "knot", "rerun",
]
