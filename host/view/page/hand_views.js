// Which way is right, up and away in the world for who looks at a picture.

/** Each of the picture's axes as the world's nearest one, so that a key moves along one axis alone. @returns {right, up, away}. */
export function nearestAxes(pane) {
  const left = [0, 1, 2], pick = (direction) => {
    const axis = left.reduce((best, i) => (Math.abs(direction[i]) > Math.abs(direction[best]) ? i : best), left[0]);
    left.splice(left.indexOf(axis), 1);
    return [0, 1, 2].map((i) => (i === axis ? Math.sign(direction[axis]) || 1 : 0));
  };
  const up = pick(pane.up), right = pick(pane.right);
  return { right, up, away: pick(pane.away) };
}

/** right, up and away, so far each, as one step in the world. */
export function along({ right, up, away }, [r, u, a]) { return right.map((x, i) => x * r + up[i] * u + away[i] * a); }
