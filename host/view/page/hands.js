// Draws the two grippers and the force on each hand.
import * as THREE from './three.module.js';

export const HAND_COLOURS = [0x56b4e9, 0xe69f00];
const DOWN = new THREE.Vector3(0, 0, -1);

/** One hand: two jaws that open and close, a ring while the dead-man is pressed, an arrow for the force. */
export class Hand {
  constructor(scene, index) {
    const material = new THREE.MeshStandardMaterial({ color: HAND_COLOURS[index], roughness: 0.4, metalness: 0.2 });
    this.tool = new THREE.Group();
    const side = index === 0 ? -1 : 1;
    const shaft = new THREE.Mesh(index === 0 ? new THREE.CylinderGeometry(0.35, 0.35, 5, 20) : new THREE.BoxGeometry(0.62, 5, 0.62), material);
    shaft.position.set(side * 3.2, 0, 2.6);
    shaft.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(side * 0.75, 0, 0.62).normalize());
    this.jaws = [1, -1].map((which) => {
      const jaw = new THREE.Group();
      const blade = new THREE.Mesh(new THREE.BoxGeometry(2.4, 0.42, 0.8), material);
      blade.position.set(side * 0.75, which * 0.32, 0.45);
      jaw.add(blade);
      jaw.position.set(0, which * 0.6, 0);
      jaw.userData.which = which;
      this.tool.add(jaw);
      return jaw;
    });
    this.ring = new THREE.Mesh(new THREE.TorusGeometry(2.6, 0.16, 10, 40), new THREE.MeshBasicMaterial({ color: 0x2fbf8f }));
    this.tool.add(shaft, this.ring);
    this.tool.traverse((part) => { part.castShadow = true; });
    this.arrow = makeArrow(HAND_COLOURS[index]);
    scene.add(this.tool, this.arrow);
    this.tool.visible = this.arrow.visible = false;
  }

  /** @param size_m size of a jaw. @param force_m length of the arrow per newton. */
  update(hand, size_m, force_m) {
    this.tool.visible = true;
    this.tool.position.set(...hand.p_W);
    this.tool.scale.setScalar(size_m);
    for (const jaw of this.jaws) jaw.position.y = jaw.userData.which * (hand.grip ? 0.55 : 1.25);
    this.ring.visible = hand.deadMan;
    const f = new THREE.Vector3(...hand.f_device), magnitude = f.length();
    this.arrow.visible = magnitude > 1e-3;
    if (!this.arrow.visible) return;
    this.arrow.position.set(...hand.p_W);
    this.arrow.quaternion.setFromUnitVectors(DOWN, f.divideScalar(magnitude));
    const [stem, head] = this.arrow.children, thick = size_m * 0.45, length = magnitude * force_m;
    stem.scale.set(thick, thick, length);
    head.position.z = -length;
    head.scale.setScalar(thick * 2.6);
  }
}

/**
 * An arrow of length 1 along -z. Stem and head are separate, so that the head keeps its shape when the stem is scaled.
 */
function makeArrow(colour) {
  const material = new THREE.MeshStandardMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.35, roughness: 0.6 });
  const stem = new THREE.Mesh(new THREE.CylinderGeometry(0.5, 0.5, 1, 16).rotateX(Math.PI / 2).translate(0, 0, -0.5), material);
  const head = new THREE.Mesh(new THREE.ConeGeometry(0.5, 1.1, 20).rotateX(-Math.PI / 2).translate(0, 0, -0.55), material);
  const arrow = new THREE.Group();
  arrow.add(stem, head);
  arrow.traverse((part) => { part.castShadow = true; });
  return arrow;
}
