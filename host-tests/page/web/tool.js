// The tool in the hand: the stylus's tip, or one with a shape, which a drag turns and the body holds outside.

import { Group, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3 } from "three";
import { colour, withColours } from "scheme";

const by = (id) => document.getElementById(id);
/** Half lengths of the core along x, y and z, and the radius of the ball rolled over it, in sizes of the body. */
const SHAPES = {
  ball: { half: [0, 0, 0], radius: 0.07 },
  capsule: { half: [0, 0, 0.15], radius: 0.05 },
  box: { half: [0.14, 0.09, 0.05], radius: 0.02 },
};
const STEEL = 0xcdd4df;
/** Of a turn, radians for a pixel. */
const TURNING = 0.01;
/** Contacts of one tick, at most. */
const CONTACTS = 6;
/** A contact that pushes less is not marked, N. */
const FELT = 1e-3;

export class Tool {
  constructor(page) {
    this.page = page;
    this.group = new Group();
    page.room.scene.add(this.group);
    this.marks = Array.from({ length: CONTACTS }, () => mark());
    this.group.add(...this.marks);
    this.name = "";
    by("tool").addEventListener("change", () => (page.refuse(null), this.take(by("tool").value)));
  }

  /** Whether a tool with a shape is in the hand. */
  get isShaped() {
    return this.name !== "";
  }

  /** Begins on a body; on one that is a patch alone or gives way there is the tip alone. */
  begin(device) {
    by("tool").disabled = device.isPatch || device.modes().length > 0;
    if (!this.take(by("tool").disabled ? "" : this.name)) this.take("");
  }

  /** Takes a tool of the list in the hand; the empty name is the tip. */
  take(name) {
    const { device } = this.page.body,
      { half, radius } = SHAPES[name] ?? { half: [0, 0, 0], radius: 0 };
    try {
      device.takeTool(
        half.map((length) => length * device.size),
        radius * device.size,
      );
      this.name = name;
    } catch (error) {
      this.page.refuse(error.message);
      return false;
    } finally {
      by("tool").value = this.name;
    }
    this.device = device;
    this.turned = new Quaternion();
    this.draw();
    this.words();
    // Where nothing is in the body: contacts are found first.
    this.page.loop.begin(device);
    return true;
  }

  /** Shows what there is of a tool, and hides what is of a point's tracker alone. */
  words() {
    by("turns").hidden = by("turns").disabled = !this.isShaped;
    by("errors").closest("figure").hidden = this.isShaped;
    by("law").disabled = this.isShaped;
    if (!this.isShaped && by("hand").value === "turn") {
      by("hand").value = "surface";
      this.page.pointer.moveIn("surface", this.page.loop.place);
    }
  }

  draw() {
    this.group.remove(this.drawn, this.ghost);
    this.drawn = this.ghost = null;
    if (!this.isShaped) return;
    const shape = rounded(SHAPES[this.name]);
    this.drawn = new Mesh(shape, new MeshStandardMaterial({ color: STEEL, metalness: 0.6, roughness: 0.35 }));
    this.drawn.castShadow = true;
    const pale = { color: STEEL, transparent: true, opacity: 0.3, depthWrite: false };
    this.ghost = new Mesh(shape, new MeshStandardMaterial(pale));
    this.group.add(this.drawn, this.ghost);
  }

  /** How far it reaches from its origin against a direction of length 1, in sizes of the body. */
  reach(direction) {
    if (!this.isShaped) return 0;
    const { half, radius } = SHAPES[this.name];
    const along = direction.clone().applyQuaternion(this.turned.clone().invert()).toArray();
    return radius + along.reduce((sum, share, axis) => sum + Math.abs(share) * half[axis], 0);
  }

  /** Turns it by pixels to the right and down, about axes of the picture, and by some about the view. */
  turn(right, down, about = 0) {
    if (!this.isShaped) return;
    const { quaternion } = this.page.room.camera;
    for (const [axis, pixels] of [[[0, 1, 0], right], [[1, 0, 0], down], [[0, 0, 1], about]]) {
      const way = new Vector3(...axis).applyQuaternion(quaternion);
      this.turned.premultiply(new Quaternion().setFromAxisAngle(way, TURNING * pixels)).normalize();
    }
    this.device.turnTool(this.turned.toArray());
  }

  /** Shows it and what it touches, for a probe in the room; not where a recording or a device is seen. */
  show(probe, isHeld) {
    const seen = isHeld && this.isShaped ? this.device.tool() : null;
    this.group.visible = seen !== null;
    if (!seen) return;
    const { room } = this.page;
    this.drawn.position.copy(room.place(seen.position));
    this.drawn.quaternion.fromArray(seen.orientation);
    this.ghost.position.copy(probe);
    this.ghost.quaternion.fromArray(seen.hand);
    const pressing = seen.contacts.filter(({ force }) => Math.hypot(...force) > FELT);
    this.marks.forEach((mark, index) => {
      mark.visible = index < pressing.length;
      if (mark.visible) mark.position.copy(room.place(pressing[index].place));
    });
  }
}

/** A ball's mesh drawn apart to the corners of a box: the faces between are those of the box with rounded edges. */
function rounded({ half, radius }) {
  const shape = new SphereGeometry(radius, 48, 32),
    { position } = shape.attributes;
  for (let index = 0; index < position.count; index += 1) {
    const at = new Vector3().fromBufferAttribute(position, index).toArray();
    // On the planes between corners a rounding decides nothing: those points lie in a flat or straight part.
    const sides = at.map((coordinate) => (Math.abs(coordinate) < 1e-6 * radius ? 0 : Math.sign(coordinate)));
    position.setXYZ(index, ...at.map((coordinate, axis) => coordinate + sides[axis] * half[axis]));
  }
  return shape;
}

function mark() {
  const material = new MeshStandardMaterial({ roughness: 0.3, depthTest: false, transparent: true });
  withColours(() => material.color.set(colour("mark-force")));
  const ball = new Mesh(new SphereGeometry(0.014, 24, 16), material);
  ball.renderOrder = 1;
  return ball;
}
