// Directions of a picture (right, up, away from the viewer) in world coordinates.

/**
 * Replaces each of the picture's axes by the nearest world axis, so that a key moves along one axis only. @returns
 * {right, up, away}.
 */
export function nearestAxes(pane) {
  const left = [0, 1, 2], pick = (direction) => {
    const axis = left.reduce((best, i) => (Math.abs(direction[i]) > Math.abs(direction[best]) ? i : best), left[0]);
    left.splice(left.indexOf(axis), 1);
    return [0, 1, 2].map((i) => (i === axis ? Math.sign(direction[axis]) || 1 : 0));
  };
  const up = pick(pane.up), right = pick(pane.right);
  return { right, up, away: pick(pane.away) };
}

/** World displacement for r, u and a along right, up and away. */
export function along({ right, up, away }, [r, u, a]) { return right.map((x, i) => x * r + up[i] * u + away[i] * a); }
