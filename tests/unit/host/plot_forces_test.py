"""The picture of the forces: scaled to its data, labels that do not cover each other, and axes that fill it."""

import pathlib
import sys
import tempfile
import unittest
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "host/plots"))

import matplotlib.pyplot as plt  # noqa: E402
import plot_forces  # noqa: E402

HAND = ("device_f_N", "node")
HEAD = ["tick", "t_s", "session", "state"] + [f"{hand}_{name}" for hand in plot_forces.HANDS for name in HAND]


class PlotForces(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        warnings.simplefilter("error")  # matplotlib warns of a layout that has no room
        self.addCleanup(warnings.resetwarnings)
        self.addCleanup(plt.close, "all")

    def draw(self, left_N, nodes):
        """@return the axes of a recording of 10 s, left force and node by time, the right hand at rest."""
        rows = [[k, k / 100, 1, 4, left_N(k / 100), nodes(k / 100), 0.0, -1] for k in range(1000)]
        (self.folder / "f.csv").write_text("\n".join(",".join(map(str, row)) for row in [HEAD, *rows]))
        plot_forces.draw(str(self.folder / "f.csv"), str(self.folder / "f.png"), "test", 3.3, False)
        return plt.gcf().axes

    def test_the_axis_ends_a_little_above_the_largest_force_of_both_hands(self):
        left, right, _ = self.draw(lambda t: 0.2 if 3 < t < 4 else 0.1, lambda t: -1)
        self.assertAlmostEqual(left.get_ylim()[1], 0.23)
        self.assertEqual(left.get_ylim(), right.get_ylim())

    def test_the_axis_shows_the_limit_when_a_force_comes_near_it(self):
        left, _, _ = self.draw(lambda t: 0.8 * t / 4, lambda t: -1)
        self.assertGreater(left.get_ylim()[1], 3.3)

    def test_axes_fill_the_picture_when_nothing_is_grasped(self):
        left, right, _ = self.draw(lambda t: 0.1, lambda t: -1)
        for axes in (left, right):
            self.assertGreater(axes.get_position().height, 0.25)

    def test_labels_of_many_grasps_do_not_cover_each_other(self):
        left, _, _ = self.draw(lambda t: 0.1, lambda t: 20 if int(t * 20) % 2 else -1)  # a grasp every 0.1 s
        plt.gcf().canvas.draw()
        boxes = sorted((label.get_window_extent() for label in left.texts), key=lambda box: box.x0)
        self.assertGreater(len(boxes), 5)
        for a, b in zip(boxes, boxes[1:]):
            self.assertLessEqual(a.x1, b.x0)


if __name__ == "__main__":
    unittest.main()
