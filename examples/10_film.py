"""A film of an overhand knot being tied, as an animated GIF.

usage: 10_film.py [FILE.gif]"""

import sys

import matplotlib.pyplot as plt
from matplotlib.animation import FuncAnimation, PillowWriter

import ligature

PICTURES, FROM_S, TO_S = 100, 2.0, 22.0
out = sys.argv[1] if len(sys.argv) > 1 else "knot.gif"
scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": 35})
script = ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")
run = ligature.Simulation(scene).run(script, TO_S, shape_every_s=(TO_S - FROM_S) / PICTURES)
first = len(run.shapes) - PICTURES

figure = plt.figure(figsize=(5, 5))
axes = figure.add_subplot(projection="3d")
low, high = run.shapes[first:].min(axis=(0, 1)), run.shapes[first:].max(axis=(0, 1))
axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), xlabel="x in m", ylabel="y in m", zlabel="z in m")
axes.set_box_aspect(high - low, zoom=0.85)
axes.locator_params(nbins=3)
(thread,) = axes.plot([], [], [], color="tab:purple", linewidth=3)
hands = [axes.plot([], [], [], "o", color=colour)[0] for colour in ("tab:blue", "tab:red")]


def draw(picture):
    thread.set_data_3d(*run.shapes[first + picture].T)
    for hand, tool in zip(hands, script.tools(run.shape_t_s[first + picture]), strict=True):
        hand.set_data_3d(*([x] for x in tool.p_W_m))
    axes.set_title(f"{run.shape_t_s[first + picture]:.1f} s")


FuncAnimation(figure, draw, PICTURES).save(out, writer=PillowWriter(fps=25), dpi=80)
print(f"{out}: {PICTURES} pictures, at the end {run.knot().type}")
