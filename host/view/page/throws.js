// Throws of the knot: pieces of the thread that hold one summand each, e.g. two in a square knot.

/** Nodes [first, last] of each throw of this knot that the shape still has. */
export function throwsOf(knot, shape) {
  const n = shape.p_W.length / 3;
  return (knot?.throws ?? []).map(({ nodes }) => nodes).filter(([first, last]) => first < last && last < n);
}

/** Middle of nodes first .. last. */
export function middleOf(p_W, [first, last]) {
  const sum = [0, 0, 0];
  for (let i = first; i <= last; ++i) for (let j = 0; j < 3; ++j) sum[j] += p_W[3 * i + j];
  return sum.map((s) => s / (last - first + 1));
}

/**
 * The piece to keep in the middle of the picture: the throw nearest to `near`, so that the picture stays with it and
 * never stands between two throws. Without a knot: the held nodes. @returns [first, last] pairs, or [].
 */
export function followed(knot, shape, near) {
  const throws = throwsOf(knot, shape);
  if (!throws.length) return shape.grasped.filter((node) => node >= 0).map((node) => [node, node]);
  const off = (piece) => Math.hypot(...middleOf(shape.p_W, piece).map((x, j) => x - near[j]));
  return [throws.reduce((best, piece) => (off(piece) < off(best) ? piece : best))];
}
