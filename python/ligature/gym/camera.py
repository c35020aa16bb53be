"""Pictures of the thread by a pinhole projection."""

import numpy as np

RAISED_RAD = np.radians(35.0)  # angle by which the camera looks down
LEFT_RGB, RIGHT_RGB = (230, 80, 60), (70, 130, 240)


class Camera:
    """A pinhole camera on the user's side that looks away from the user and 35 degrees down at a target point.

    A point p (world, m) has the camera coordinates c = R (p - eye): c_x to the right, c_y down, c_z away, and lies at
    column s/2 + f c_x / c_z and row s/2 + f c_y / c_z of a picture of s x s pixels. The distance from the eye to the
    target is 3 `reach_m`, and the focal length f is 3 s / 2 pixels. So at the target's distance the picture shows a
    square whose sides are 2 `reach_m` long.
    """

    def __init__(self, target_m: np.ndarray, reach_m: float, size_px: int) -> None:
        down, level = np.sin(RAISED_RAD), np.cos(RAISED_RAD)
        self.R_CW: np.ndarray = np.array([[1.0, 0.0, 0.0], [0.0, -down, -level], [0.0, level, -down]])
        self.distance_m: float = 3.0 * reach_m
        self.reach_m: float = reach_m
        self.size_px: int = size_px
        self.eye_m: np.ndarray = np.asarray(target_m) - self.distance_m * self.R_CW[2]

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixels (n x 2: column, row, as real numbers) and depths c_z (n, m) of points n x 3, m."""
        c = (points - self.eye_m) @ self.R_CW.T
        ahead = np.maximum(c[:, 2], 1e-6 * self.reach_m)  # a point behind the camera is left out by grey()
        return 0.5 * self.size_px + 1.5 * self.size_px * c[:, :2] / ahead[:, None], c[:, 2]

    def grey(self, nodes: np.ndarray) -> np.ndarray:
        """The thread as a line one pixel wide: size x size uint8, 0 where there is none.

        A pixel is 255 at the depth distance - 1.5 reach or nearer, 64 at distance + 1.5 reach or farther, and linear
        between. Where two strands cross, the nearer one is seen, so the picture shows which strand is above.
        """
        between = 1 + int(np.ceil(2.0 * self.size_px / (len(nodes) - 1)))  # points a segment: less than a pixel apart
        u = np.arange(between)[None, :, None] / between
        line = ((1.0 - u) * nodes[:-1, None] + u * nodes[1:, None]).reshape(-1, 3)
        pixels, depth_m = self.project(np.concatenate([line, nodes[-1:]]))
        seen = (depth_m > 0.0) & np.all((pixels >= 0.0) & (pixels < self.size_px), axis=1)
        far = (depth_m[seen] - self.distance_m + 1.5 * self.reach_m) / (3.0 * self.reach_m)
        value = np.rint(255.0 - 191.0 * np.clip(far, 0.0, 1.0)).astype(np.uint8)
        column, row = pixels[seen].astype(np.int64).T
        picture = np.zeros((self.size_px, self.size_px), dtype=np.uint8)
        np.maximum.at(picture, (row, column), value)
        return picture

    def coloured(self, nodes: np.ndarray, hands: np.ndarray, colours: list[tuple[int, int, int]]) -> np.ndarray:
        """grey() with a square for each hand: size x size x 3 uint8. hands: h x 3, m."""
        picture = np.repeat(self.grey(nodes)[:, :, None], 3, axis=2)
        half = max(1, self.size_px // 64)
        for (column, row), depth_m, colour in zip(*self.project(hands), colours):
            if depth_m > 0.0 and 0.0 <= column < self.size_px and 0.0 <= row < self.size_px:
                i, k = int(row), int(column)
                picture[max(0, i - half):i + half + 1, max(0, k - half):k + half + 1] = colour
        return picture
