// Magnified views of the knot's throws: small windows in the 3-D picture, each with its name and a scale bar.
import * as THREE from './three.module.js';
import { middleOf, throwsOf } from './throws.js';
import { roundLength } from './round_length.js';

// How many throws have a view; radius of the view in radii of the throw; how much thread is drawn beyond each end.
const MOST = 3, ROOM = 1.15, BEYOND = 0.15;

export class ThrowViews {
  constructor(box) {
    Object.assign(this, { box, views: [] });
    this.camera = new THREE.PerspectiveCamera(20, 1, 0.001, 1000);
  }

  /** @param knot with its throws; null: no view. */
  show(knot, shape) {
    const throws = knot ? throwsOf(knot, shape).slice(0, MOST) : [];
    while (this.views.length > throws.length) this.views.pop().element.remove();
    while (this.views.length < throws.length) this.views.push(this.#window());
    throws.forEach((nodes, i) => {
      const { element } = this.views[i], diameters = knot.throws[i].diameters.toFixed(0);
      const more = Math.ceil(BEYOND * (nodes[1] - nodes[0])), last = shape.p_W.length / 3 - 1;
      Object.assign(this.views[i], { piece: [Math.max(0, nodes[0] - more), Math.min(last, nodes[1] + more)], middle: middleOf(shape.p_W, nodes), radius_m: reach(shape, nodes) });
      element.firstChild.textContent = `${throws.length > 1 ? `${i + 1}: ` : ''}${diameters} d`;
      element.title = `${throws.length > 1 ? `throw ${i + 1}` : 'the knot'}, magnified: ${diameters} diameters of thread`;
    });
  }

  #window() {
    const element = document.createElement('div');
    element.className = 'throw';
    element.innerHTML = '<b></b><div class="scale-bar"><span></span></div>';
    this.box.append(element);
    return { element, middle: [0, 0, 0], radius_m: 1 };
  }

  /**
   * Draws the views over the picture, from the direction of its camera, each with its piece of the tube only. The shadows
   * are those of the picture.
   */
  draw(renderer, scene, tube, from, target, canvas) {
    if (!this.views.length) return;
    const page = canvas.getBoundingClientRect(), direction = from.position.clone().sub(target).normalize(), { camera } = this;
    renderer.shadowMap.autoUpdate = false;
    for (const { element, piece, middle, radius_m } of this.views) {
      const r = element.getBoundingClientRect(), x = r.left - page.left, y = page.bottom - r.bottom;
      if (!r.width) continue; // hidden
      const distance = (ROOM * radius_m) / Math.sin((camera.fov * Math.PI) / 360);
      camera.up.copy(from.up);
      camera.position.set(...middle).addScaledVector(direction, distance);
      camera.lookAt(...middle);
      camera.near = Math.max(distance - 3 * radius_m, 0.05 * distance);
      camera.far = distance + 3 * radius_m;
      camera.updateProjectionMatrix();
      renderer.setViewport(x, y, r.width, r.height);
      renderer.setScissor(x, y, r.width, r.height);
      tube.only(piece);
      renderer.render(scene, camera);
      showScale(element, (2 * ROOM * radius_m) / r.height, r.width);
    }
    tube.only(null);
    renderer.shadowMap.autoUpdate = true;
  }
}

/** Distance of the throw's farthest node from its middle, and the thread's own radius. */
function reach({ p_W, radius_m }, [first, last]) {
  const middle = middleOf(p_W, [first, last]);
  let most = 0;
  for (let i = first; i <= last; ++i) most = Math.max(most, Math.hypot(...middle.map((m, j) => p_W[3 * i + j] - m)));
  return most + radius_m;
}

function showScale(element, metresPerPixel, width) {
  const { length_m, text } = roundLength(0.4 * width * metresPerPixel), bar = element.lastChild;
  bar.style.width = `${length_m / metresPerPixel}px`;
  bar.firstChild.textContent = text;
}
