// Extracts from the scene's text the facts that the picture needs. Regular expressions suffice instead of a TOML
// parser, because our files have one key per line.

export function sceneFacts(status) {
  const toml = status.scene_toml ?? '', number = (key) => { const m = toml.match(new RegExp(`^\\s*${key}\\s*=\\s*([-+0-9.eE_]+)`, 'm')); return m ? Number(m[1]) : null; };
  const fixed = [...toml.matchAll(/\{\s*node\s*=\s*-?\d+\s*,\s*position_m\s*=\s*\[([^\]]+)\]/g)].map((m) => m[1].split(',').map(Number));
  return { deskHeight_m: number('desk_height_m'), restLength_m: number('length_m') ?? 0, fixed: fixed.filter((p) => p.length === 3 && p.every(Number.isFinite)), maxForce_N: status.max_force_N || 3.3 };
}
