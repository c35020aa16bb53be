// The 3-D picture: thread, hands, desk and coordinate frame; camera and light.
import * as THREE from './three.module.js';
import { OrbitControls } from './OrbitControls.js';
import { Tube } from './tube.js';
import { Hand } from './hands.js';
import { colourThread } from './colouring.js';
import { NO_FACTS } from './scene_facts.js';
import { ThrowViews } from './throw_views.js';
import { followed, middleOf } from './throws.js';

const QUALITIES = [{}, { ratio: 1, shadow: 1024 }, { ratio: 0.6, shadow: 512 }];
const VIEWS = { front: [0, -1, 0.12], side: [1, 0, 0.12], top: [0, -0.02, 1], iso: [0.62, -0.9, 0.42] };

export class Scene {
  /**
   * @param choice {colour, follow, stereo, view} of the user. @param onLost called when the browser withdraws WebGL.
   * @param signal aborted when the picture is no longer wanted, also if this constructor throws.
   */
  constructor(host, choice, onLost, signal) {
    this.choice = choice;
    this.canvas = Object.assign(document.createElement('canvas'), { id: 'canvas', className: 'picture', hidden: true });
    const context = this.canvas.getContext('webgl2', { antialias: true, powerPreference: 'high-performance' });
    if (!context) throw new Error('no WebGL in this browser, drawn flat');
    this.canvas.addEventListener('webglcontextlost', () => onLost('the browser took WebGL away, drawn flat'), { signal });
    signal.addEventListener('abort', () => this.#release(context));
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, context });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.setScissorTest(true);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0x222a35);
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 1000);
    this.camera.up.set(0, 0, 1);
    this.stereo = new THREE.StereoCamera();
    this.stereoMode = 'off';
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener('start', () => { this.touched = true; });
    this.controls.addEventListener('change', () => { this.isDirty = true; });
    this.#addLight();
    this.#addSurroundings();
    if (choice.quality) this.#lower(choice.quality); // of a view before this one, which was too slow
    this.tube = new Tube(this.scene);
    this.hands = [0, 1].map((i) => new Hand(this.scene, i));
    this.facts = NO_FACTS;
    this.maxForce_N = 3.3;
    this.throws = new ThrowViews(document.getElementById('throws'));
    this.setStereo(choice.stereo);
    this.resizes = new ResizeObserver(() => { this.isDirty = true; });
    this.resizes.observe(this.canvas);
    host.prepend(this.canvas);
    this.host = host;
  }

  show(on) { this.canvas.hidden = !on; }

  /** Gives the context back at once. A browser has only a few, and takes the oldest away when there are too many. */
  #release(context) {
    this.canvas.remove();
    document.getElementById('throws').replaceChildren();
    if (!context.isContextLost()) context.getExtension('WEBGL_lose_context')?.loseContext();
    this.resizes?.disconnect();
    this.controls?.dispose();
    this.renderer?.dispose();
  }

  #addLight() {
    this.scene.add(new THREE.HemisphereLight(0xdfe9ff, 0x3a3228, 1.25));
    this.sun = new THREE.DirectionalLight(0xfff4e0, 2.4);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.02;
    this.fill = new THREE.DirectionalLight(0xbfd4ff, 0.5);
    this.scene.add(this.sun, this.sun.target, this.fill);
  }

  #addSurroundings() {
    this.desk = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.MeshStandardMaterial({ color: 0x46505e, roughness: 0.95 }));
    this.desk.receiveShadow = true;
    this.grid = new THREE.GridHelper(1, 20, 0x6f7d90, 0x5a6675);
    this.grid.rotation.x = Math.PI / 2;
    this.axes = new THREE.Group();
    [['x', 0xd55e00, [1, 0, 0]], ['y', 0x009e73, [0, 1, 0]], ['z', 0x0072b2, [0, 0, 1]]].forEach(([name, colour, direction]) => {
      const d = new THREE.Vector3(...direction);
      this.axes.add(new THREE.ArrowHelper(d, new THREE.Vector3(), 1, colour, 0.22, 0.11));
      const label = nameSprite(name);
      label.position.copy(d.multiplyScalar(1.2));
      this.axes.add(label);
    });
    this.posts = new THREE.Group();
    this.scene.add(this.desk, this.grid, this.axes, this.posts);
  }

  setForce(maxForce_N) { this.maxForce_N = maxForce_N || this.maxForce_N; }

  setFacts(facts) {
    this.facts = facts ?? NO_FACTS;
    if (this.shape) this.#layOut(this.shape);
    this.isDirty = true;
  }

  /**
   * Takes a new shape. @param now the newest tick, with the hands; @param knot topic of the host, or undefined.
   * @returns the legend.
   */
  update(shape, now, knot) {
    this.isDirty = true;
    let legend = null;
    if (shape) {
      const painted = colourThread(this.choice.colour, shape, this.facts, knot);
      legend = painted.legend;
      this.tube.update(shape.p_W, shape.radius_m, painted.colours, shape.turn_rad);
      if (!this.shape || this.shape.p_W.length !== shape.p_W.length || this.shape.radius_m !== shape.radius_m) this.#layOut(shape);
      this.shape = shape;
      this.knot = knot;
      this.throws.show(this.stereoMode === 'off' ? knot : null, shape);
      this.#keepInPicture(shape);
    }
    if (now?.hands && this.extent) {
      const jaw = { radius_m: this.shape?.radius_m ?? 0, collides_m: this.facts.gripper_m, least_m: 0.03 * this.extent };
      now.hands.forEach((hand, i) => this.hands[i].update(hand, jaw, (0.3 * this.extent) / this.maxForce_N));
    }
    if (this.choice.follow && this.shape) this.#followKnot();
    return legend;
  }

  /** Scales desk, frame, light and camera to this thread. */
  #layOut(shape) {
    const box = boxOf(shape.p_W);
    let length = 0;
    for (let i = 3; i < shape.p_W.length; i += 3) length += Math.hypot(shape.p_W[i] - shape.p_W[i - 3], shape.p_W[i + 1] - shape.p_W[i - 2], shape.p_W[i + 2] - shape.p_W[i - 1]);
    this.extent = length;
    const centre = box.getCenter(new THREE.Vector3());
    const floor = this.facts.desk_height_m ?? Math.min(0, box.min.z - 0.02 * length) * (box.min.z < 0 ? 1 : 0);
    this.desk.position.set(centre.x, centre.y, floor);
    this.desk.scale.setScalar(4 * length);
    this.grid.position.set(centre.x, centre.y, floor + 1e-4 * length);
    this.grid.scale.setScalar(2 * length);
    this.axes.position.set(centre.x - 0.45 * length, centre.y + 0.3 * length, floor + 2e-3 * length);
    this.axes.scale.setScalar(0.09 * length);
    this.#putPosts(length);
    this.#putLight(centre, length);
    this.controls.minDistance = 6 * shape.radius_m;
    this.controls.maxDistance = 8 * length;
    this.seen = new THREE.Box3();
    this.framed = new THREE.Box3();
  }

  #putPosts(length) {
    this.desk.visible = this.grid.visible = this.facts.desk_height_m !== null;
    this.posts.clear();
    for (const p of this.facts.fixed) {
      const knob = new THREE.Mesh(new THREE.OctahedronGeometry(0.012 * length), new THREE.MeshStandardMaterial({ color: 0xb8c2cf, roughness: 0.5 }));
      knob.position.set(...p);
      knob.castShadow = true;
      this.posts.add(knob);
    }
  }

  #putLight(centre, length) {
    this.sun.position.set(centre.x - 0.5 * length, centre.y - 0.6 * length, centre.z + 1.5 * length);
    this.sun.target.position.copy(centre);
    this.fill.position.set(centre.x + length, centre.y - length, centre.z + 0.2 * length);
    const camera = this.sun.shadow.camera, half = 0.8 * length;
    Object.assign(camera, { left: -half, right: half, top: half, bottom: -half, near: 0.01 * length, far: 6 * length });
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.0012 * length;
  }

  /** Moves the camera back when the thread leaves the picture, until the user moves the camera. */
  #keepInPicture(shape) {
    if (this.touched || this.choice.follow) return;
    this.seen.union(boxOf(shape.p_W));
    if (this.framed.containsBox(this.seen)) return;
    this.view('iso', this.seen);
    this.touched = false;
    this.framed.copy(this.seen).expandByScalar(0.02 * this.extent);
  }

  /** World metres per pixel at the centre of the picture. */
  get metresPerPixel() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  /**
   * How the picture maps to the world, for dragging hands: rectangle in pixels of the element, directions as unit
   * vectors in world coordinates.
   */
  get panes() {
    const { clientWidth: w, clientHeight: h } = this.canvas, { camera } = this;
    camera.updateMatrixWorld();
    const m = camera.matrixWorld.elements, axis = (i, sign) => [0, 1, 2].map((j) => sign * m[4 * i + j]);
    const place = (p) => { const seen = new THREE.Vector3(...p).project(camera); return [((seen.x + 1) * w) / 2, ((1 - seen.y) * h) / 2]; };
    const depth = (p) => -new THREE.Vector3(...p).applyMatrix4(camera.matrixWorldInverse).z;
    const metresPerPixel = (p) => (2 * depth(p) * Math.tan((camera.fov * Math.PI) / 360)) / Math.max(1, h);
    return [{ x: 0, y: 0, w, h, right: axis(0, 1), up: axis(1, 1), away: axis(2, -1), place, metresPerPixel }];
  }

  /** Sets a standard view, or 'fit': same direction, with everything in the picture. */
  view(name, box = this.shape && boxOf(this.shape.p_W)) {
    if (!box) return;
    this.touched = true;
    const centre = box.getCenter(new THREE.Vector3());
    const radius = Math.max(0.5 * box.getSize(new THREE.Vector3()).length(), 0.1 * this.extent);
    const direction = VIEWS[name] ? new THREE.Vector3(...VIEWS[name]) : this.camera.position.clone().sub(this.controls.target);
    this.camera.near = 0.002 * this.extent;
    this.camera.far = 30 * this.extent;
    const { clientWidth, clientHeight } = this.host; // a hidden canvas has no size
    const narrow = Math.min(1, Math.max(1, clientWidth) / Math.max(1, clientHeight));
    const distance = (1.06 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction.normalize(), distance);
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** Moves the nearest throw (without a knot, the held nodes) towards the centre; distance and direction stay. */
  #followKnot() {
    const pieces = followed(this.knot, this.shape, this.controls.target.toArray());
    if (!pieces.length) return;
    const middle = new THREE.Vector3();
    for (const piece of pieces) middle.add(new THREE.Vector3(...middleOf(this.shape.p_W, piece)));
    const step = middle.divideScalar(pieces.length).sub(this.controls.target).multiplyScalar(0.2);
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.controls.update();
  }

  /** Draws if anything changed. @param time of this animation frame, ms. */
  draw(time) {
    this.#keepPace(time);
    if (!this.isDirty) return;
    this.isDirty = false;
    const { clientWidth: width, clientHeight: height } = this.canvas, renderer = this.renderer;
    if (!width || !height) return;
    const ratio = renderer.getPixelRatio();
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio)) renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.stereoMode === 'anaglyph') return this.#drawAnaglyph(width, height);
    const eyes = this.stereoMode === 'side' ? this.#eyes() : [[this.camera, 0, width]];
    for (const [eye, left, wide] of eyes) {
      renderer.setViewport(left, 0, wide, height);
      renderer.setScissor(left, 0, wide, height);
      renderer.render(this.scene, eye);
    }
    this.throws.draw(renderer, this.scene, this.tube, this.camera, this.controls.target, this.canvas);
  }

  /** Draws at once, for a copy of the picture in the same task. */
  drawNow() {
    this.isDirty = true;
    this.draw(this.lastTime ?? performance.now());
  }

  /** @param mode 'off', 'side' or 'anaglyph'. */
  async setStereo(mode) {
    if (mode === 'anaglyph') this.AnaglyphEffect ??= (await import('./AnaglyphEffect.js')).AnaglyphEffect; // loaded only when needed
    this.stereoMode = mode;
    this.anaglyph?.dispose();
    this.anaglyph = null;
    this.isDirty = true;
  }

  #drawAnaglyph(width, height) {
    const size = `${width}x${height}`;
    if (!this.anaglyph || this.anaglyphSize !== size) {
      this.anaglyph?.dispose();
      this.anaglyph = new this.AnaglyphEffect(this.renderer, width, height);
      this.anaglyphSize = size;
    }
    this.anaglyph.planeDistance = this.camera.position.distanceTo(this.controls.target);
    this.anaglyph.eyeSep = 0.03 * this.anaglyph.planeDistance;
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(0, 0, width, height);
    this.anaglyph.render(this.scene, this.camera);
    this.renderer.setScissorTest(true);
  }

  /** Reduces resolution and shadows when the machine draws fewer than 15 pictures a second. */
  #keepPace(time) {
    const step = Math.min(time - (this.lastTime ?? time), 1000);
    this.lastTime = time;
    this.pace = 0.9 * (this.pace ?? 16) + 0.1 * step;
    if (this.pace < 66 || this.choice.quality === QUALITIES.length - 1 || document.hidden) return;
    this.#lower((this.choice.quality ?? 0) + 1);
  }

  #lower(quality) {
    this.choice.quality = quality;
    this.pace = 16;
    const { ratio, shadow } = QUALITIES[quality];
    this.renderer.setPixelRatio(ratio);
    this.sun.shadow.mapSize.set(shadow, shadow);
    this.sun.shadow.map?.dispose();
    this.sun.shadow.map = null;
    this.isDirty = true;
  }

  #eyes() {
    const half = this.canvas.clientWidth / 2;
    this.camera.updateMatrixWorld();
    this.stereo.aspect = 0.5;
    this.stereo.eyeSep = 0.03 * this.camera.position.distanceTo(this.controls.target);
    this.camera.focus = this.camera.position.distanceTo(this.controls.target);
    this.stereo.update(this.camera);
    return [[this.stereo.cameraL, 0, half], [this.stereo.cameraR, half, half]];
  }
}

function boxOf(p) {
  const box = new THREE.Box3(), point = new THREE.Vector3();
  for (let i = 0; i < p.length; i += 3) box.expandByPoint(point.set(p[i], p[i + 1], p[i + 2]));
  return box;
}

function nameSprite(name) {
  const canvas = Object.assign(document.createElement('canvas'), { width: 64, height: 64 });
  const context = canvas.getContext('2d');
  context.font = 'bold 46px sans-serif';
  context.fillStyle = '#e8ecf2';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(name, 32, 30);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, depthWrite: false })); // no depth test: letters are drawn over everything else
  sprite.scale.setScalar(0.45);
  return sprite;
}
