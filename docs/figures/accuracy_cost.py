"""Error of the rod against computing time of a tick, from the table of settings in docs/measurements/accuracy.md."""

import matplotlib.pyplot as plt
from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, source
from matplotlib.lines import Line2D

KINDS = {"fast": (ORANGE, "o"), "balanced": (BLUE, "s"), "fine": (GREEN, "^")}
BELOW = ("balanced", 100), ("balanced", 154), ("balanced", 350), ("balanced", 500)  # number of nodes under its mark
PANELS = (("error of the knot, diameters", 5, [0.05, 0.1, 0.2, 0.5, 1.0], BELOW),
          ("error of the swing, % of the length", 4, [0.001, 0.003, 0.01, 0.03], BELOW + (("fast", 350),)))


def settings():
    """Rows of the table for the rod, cheapest first: (median us, worst us, nodes, setting, cells)."""
    rows = []
    for line in source("docs/measurements/accuracy.md").splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        model, nodes, setting = (cells[0].split("/") + ["", ""])[:3]
        if model == "rod" and setting in KINDS and len(cells) == 7:
            median, _, worst = (float(t) for t in cells[1].split("/"))
            rows.append((median, worst, int(nodes), setting, cells))
    assert len(rows) > 8
    return sorted(rows, key=lambda row: row[0])


def panel(axes, rows, label, column, ticks, below):
    front = []
    for median, worst, nodes, setting, cells in rows:
        error = float(cells[column].split()[0])
        colour, marker = KINDS[setting]
        if error > ticks[-1]:
            axes.annotate(f"{nodes} nodes:\n{error:g} diameters", (median, ticks[-1]), (0, -34), fontsize=9,
                          textcoords="offset points", ha="center",
                          arrowprops={"arrowstyle": "-|>", "color": colour})
        axes.plot([median, worst], [error] * 2, color=colour, linewidth=1)
        axes.plot(median, error, marker, color=colour, markersize=7)
        low = (setting, nodes) in below
        axes.annotate(str(nodes), (median, error), (0, -8 if low else 7), textcoords="offset points", ha="center",
                      va="top" if low else "bottom", fontsize=9, annotation_clip=True,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6})
        if not front or error < front[-1][1]:
            front.append((median, error))
    axes.step(*zip(*front), where="post", color=GREY, linewidth=1.2, linestyle=(0, (4, 3)), zorder=0)
    axes.axvline(1000.0, color=BLACK, linewidth=1)
    axes.set(xscale="log", yscale="log", xlim=(28, 1250), ylim=(ticks[0], ticks[-1]))
    axes.set_xlabel("computing time of a tick, us")
    axes.set_ylabel(label)
    axes.set_xticks([50, 100, 200, 500, 1000], ["50", "100", "200", "500", "1000"])
    axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.grid(color="#DDDDDD", linewidth=0.5)


def draw():
    figure, panels = plt.subplots(1, 2, figsize=(790 / 72, 340 / 72))
    figure.subplots_adjust(0.075, 0.14, 0.985, 0.87, 0.2)
    for axes, what in zip(panels, PANELS):
        panel(axes, settings(), *what)
    marks = [Line2D([], [], color=c, marker=m, linewidth=1, label=name) for name, (c, m) in KINDS.items()]
    marks.append(Line2D([], [], color=GREY, linestyle=(0, (4, 3)), label="best of these for their cost"))
    marks.append(Line2D([], [], color=BLACK, linewidth=1, label="1 ms"))
    figure.legend(handles=marks, loc="upper center", ncols=5, frameon=False, fontsize=10)
    return figure
