// Draws the two grippers and the force on each hand.
import * as THREE from './three.module.js';

export const HAND_COLOURS = [0x56b4e9, 0xe69f00];
const DOWN = new THREE.Vector3(0, 0, -1);

/**
 * One hand: a gripper from the tip towards the person (-y), where the thread collides with it; a ring while the dead-man
 * is pressed; an arrow for the force. Units of the gripper: its own length is 1.
 */
export class Hand {
  constructor(scene, index) {
    const material = new THREE.MeshStandardMaterial({ color: HAND_COLOURS[index], roughness: 0.4, metalness: 0.2 });
    this.tool = new THREE.Group();
    const shaft = new THREE.Mesh(index === 0 ? new THREE.CylinderGeometry(0.14, 0.14, 1.4, 20) : new THREE.BoxGeometry(0.25, 1.4, 0.25), material);
    shaft.position.y = -1.6;
    this.jaws = [1, -1].map((which) => {
      const jaw = new THREE.Mesh(new THREE.BoxGeometry(0.28, 1, 0.16), material);
      jaw.geometry.translate(0, 0.5, 0); // turns about its hinge
      jaw.position.set(0, -1, which * 0.08);
      jaw.userData.which = which;
      this.tool.add(jaw);
      return jaw;
    });
    this.ring = new THREE.Mesh(new THREE.TorusGeometry(1.1, 0.06, 10, 40), new THREE.MeshBasicMaterial({ color: 0x2fbf8f }));
    this.tool.add(shaft, this.ring);
    this.tool.traverse((part) => { part.castShadow = true; });
    // Where the drawn gripper is larger than the one that the thread collides with, that one is drawn, too.
    this.collider = new THREE.Mesh(new THREE.CapsuleGeometry(0.25, 1, 6, 16).translate(0, -0.5, 0), new THREE.MeshStandardMaterial({ color: HAND_COLOURS[index], roughness: 0.3 }));
    this.arrow = makeArrow(HAND_COLOURS[index]);
    scene.add(this.tool, this.collider, this.arrow);
    this.tool.visible = this.collider.visible = this.arrow.visible = false;
  }

  /**
   * @param jaw {radius_m: of the thread, collides_m: length of the gripper that the thread collides with or null, least_m:
   * smallest drawn length}. @param force_m length of the arrow per newton.
   */
  update(hand, { radius_m, collides_m, least_m }, force_m) {
    const length = Math.max(collides_m ?? 0, least_m);
    this.tool.visible = true;
    this.tool.position.set(...hand.p_W);
    this.tool.scale.setScalar(length);
    for (const jaw of this.jaws) jaw.rotation.x = jaw.userData.which * (hand.grip ? 0 : 0.3);
    this.collider.visible = collides_m !== null && collides_m < length;
    this.collider.position.set(...hand.p_W);
    this.collider.scale.set(4 * radius_m, collides_m ?? 1, 4 * radius_m); // the capsule has radius 0.25
    this.ring.visible = hand.deadMan;
    const f = new THREE.Vector3(...hand.f_device), magnitude = f.length();
    this.arrow.visible = magnitude > 1e-3;
    if (!this.arrow.visible) return;
    this.arrow.position.set(...hand.p_W);
    this.arrow.quaternion.setFromUnitVectors(DOWN, f.divideScalar(magnitude));
    const [stem, head] = this.arrow.children, thick = length * 0.19, long = magnitude * force_m;
    stem.scale.set(thick, thick, long);
    head.position.z = -long;
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
