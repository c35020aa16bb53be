// The thread as a smooth tube of its true radius; the geometry is allocated once and updated in place.
import * as THREE from './three.module.js';

const SIDES = 14, MOST_RINGS = 4000;
const STRIPE = 0.22; // brightness of the stripe that shows the twist
const RIM = 0.09; // width of the dark rim beyond the tube, in tube radii

export class Tube {
  constructor(scene) {
    this.group = new THREE.Group();
    scene.add(this.group);
    this.material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.55, metalness: 0.0 });
    // A second, slightly thicker tube of which only the inside is drawn. It is visible just beyond the edge of a
    // strand, so that a strand that passes over another one has a dark rim, as in a drawing of a knot.
    this.rimMaterial = new THREE.MeshBasicMaterial({ color: 0x05070a, side: THREE.BackSide });
    this.rimMaterial.onBeforeCompile = (shader) => {
      shader.uniforms.grow = this.grow = this.grow ?? { value: 0 };
      shader.vertexShader = shader.vertexShader.replace('#include <common>', '#include <common>\nuniform float grow;')
        .replace('#include <begin_vertex>', 'vec3 transformed = position + normal * grow;');
    };
    this.grow = { value: 0 };
    // This line keeps the thread visible where the tube is thinner than a pixel.
    this.lineMaterial = new THREE.LineBasicMaterial({ color: 0xd9bf8c });
    this.rings = 0;
  }

  /**
   * @param p_W n x 3 node positions, m. @param colours n x 3, linear RGB. @param turn_rad n: twist angle, drawn as a
   * stripe.
   */
  update(p_W, radius_m, colours, turn_rad) {
    const n = p_W.length / 3, per = Math.max(1, Math.min(10, Math.floor(MOST_RINGS / n)));
    const rings = (n - 1) * per + 1;
    this.per = per;
    if (rings !== this.rings) this.#allocate(rings);
    this.#centreline(p_W, colours, turn_rad, n, per);
    this.#skin(radius_m);
    this.grow.value = radius_m * RIM;
    for (const name of ['position', 'normal', 'color']) this.geometry.attributes[name].needsUpdate = true;
    this.line.attributes.position.needsUpdate = true;
    this.geometry.computeBoundingSphere();
    this.line.computeBoundingSphere();
  }

  /** Draws only the piece between two nodes, or with null all. */
  only(piece) {
    const [first, count] = piece ? [piece[0] * this.per, (piece[1] - piece[0]) * this.per] : [0, Infinity];
    this.geometry?.setDrawRange(6 * SIDES * first, 6 * SIDES * count);
    this.line?.setDrawRange(first, count + 1);
  }

  #allocate(rings) {
    this.rings = rings;
    this.group.clear();
    this.geometry?.dispose();
    this.line?.dispose();
    this.centre = new Float32Array(3 * rings);
    this.tint = new Float32Array(3 * rings);
    this.turn = new Float32Array(rings);
    const vertices = rings * SIDES + 2;
    this.geometry = new THREE.BufferGeometry();
    for (const name of ['position', 'normal', 'color'])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(THREE.DynamicDrawUsage));
    const index = [];
    for (let r = 0; r + 1 < rings; ++r)
      for (let s = 0; s < SIDES; ++s) {
        const a = r * SIDES + s, b = r * SIDES + ((s + 1) % SIDES);
        index.push(a, b, a + SIDES, b, b + SIDES, a + SIDES);
      }
    for (let s = 0; s < SIDES; ++s) { // end caps
      const t = (s + 1) % SIDES, last = (rings - 1) * SIDES;
      index.push(rings * SIDES, t, s, rings * SIDES + 1, last + s, last + t);
    }
    this.geometry.setIndex(index);
    const mesh = new THREE.Mesh(this.geometry, this.material);
    mesh.castShadow = mesh.receiveShadow = true;
    this.line = new THREE.BufferGeometry();
    this.line.setAttribute('position', new THREE.BufferAttribute(this.centre, 3).setUsage(THREE.DynamicDrawUsage));
    const parts = [mesh, new THREE.Mesh(this.geometry, this.rimMaterial), new THREE.Line(this.line, this.lineMaterial)];
    for (const part of parts) part.frustumCulled = false;
    this.group.add(...parts);
  }

  /** Catmull-Rom curve through the nodes, `per` pieces per edge; colours are interpolated linearly. */
  #centreline(p, colours, turn, n, per) {
    const out = this.centre, tint = this.tint;
    for (let i = 0, o = 0; i < n; ++i) {
      const a = 3 * Math.max(i - 1, 0), b = 3 * i, c = 3 * Math.min(i + 1, n - 1), d = 3 * Math.min(i + 2, n - 1);
      for (let k = 0; k < (i + 1 < n ? per : 1); ++k, o += 3) {
        const t = k / per, t2 = t * t, t3 = t2 * t;
        this.turn[o / 3] = turn[i] + (turn[Math.min(i + 1, n - 1)] - turn[i]) * t;
        for (let j = 0; j < 3; ++j) {
          out[o + j] = 0.5 * (2 * p[b + j] + (p[c + j] - p[a + j]) * t + (2 * p[a + j] - 5 * p[b + j] + 4 * p[c + j] - p[d + j]) * t2
            + (3 * p[b + j] - p[a + j] - 3 * p[c + j] + p[d + j]) * t3);
          tint[o + j] = colours[b + j] + (colours[c + j] - colours[b + j]) * t;
        }
      }
    }
  }

  /**
   * A circle around each point. Its frame is carried along the curve without twist (smallest rotation from tangent to
   * tangent) and then rotated by the thread's own twist angle; its first side is the stripe.
   */
  #skin(radius) {
    const x = this.centre, n = this.rings;
    const position = this.geometry.attributes.position.array, normal = this.geometry.attributes.normal.array;
    const color = this.geometry.attributes.color.array;
    let tx = 0, ty = 0, tz = 1, ux = 1, uy = 0, uz = 0;
    for (let i = 0; i < n; ++i) {
      const a = 3 * Math.max(i - 1, 0), b = 3 * Math.min(i + 1, n - 1);
      const dx = x[b] - x[a], dy = x[b + 1] - x[a + 1], dz = x[b + 2] - x[a + 2], length = Math.hypot(dx, dy, dz);
      if (length > 0) { tx = dx / length; ty = dy / length; tz = dz / length; }
      let along = ux * tx + uy * ty + uz * tz; // removes u's component along the tangent
      ux -= along * tx; uy -= along * ty; uz -= along * tz;
      let size = Math.hypot(ux, uy, uz);
      if (size < 1e-6) { // u was parallel to the tangent: take any direction normal to it
        ux = Math.abs(tx) < 0.9 ? 1 : 0; uy = Math.abs(tx) < 0.9 ? 0 : 1; uz = 0;
        along = ux * tx + uy * ty;
        ux -= along * tx; uy -= along * ty; uz = -along * tz;
        size = Math.hypot(ux, uy, uz);
      }
      ux /= size; uy /= size; uz /= size;
      const vx = ty * uz - tz * uy, vy = tz * ux - tx * uz, vz = tx * uy - ty * ux;
      for (let s = 0; s < SIDES; ++s) {
        const angle = (2 * Math.PI * s) / SIDES + this.turn[i], shade = s === 0 ? STRIPE : 1, c = Math.cos(angle), q = Math.sin(angle), o = 3 * (i * SIDES + s);
        normal[o] = c * ux + q * vx; normal[o + 1] = c * uy + q * vy; normal[o + 2] = c * uz + q * vz;
        for (let j = 0; j < 3; ++j) { position[o + j] = x[3 * i + j] + radius * normal[o + j]; color[o + j] = shade * this.tint[3 * i + j]; }
      }
      if (i === 0 || i === n - 1) {
        const o = 3 * (n * SIDES + (i ? 1 : 0)), sign = i ? 1 : -1;
        normal.set([sign * tx, sign * ty, sign * tz], o);
        position.set([x[3 * i], x[3 * i + 1], x[3 * i + 2]], o);
        color.set(this.tint.subarray(3 * i, 3 * i + 3), o);
      }
    }
  }
}
