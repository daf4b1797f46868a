// Where the reader wants the stylus: over the surface under the pointer at a height, or in a plane that faces the
// reader; or how a tool with a shape is turned.

import { Plane, Raycaster, Vector2, Vector3 } from "three";

/** In sizes of the body: how high the stylus hovers, how deep it is pressed, and what a key moves it. */
const HOVER = 0.1,
  PRESS = 0.11,
  LOWEST = -0.3,
  HIGHEST = 0.8,
  STEP = 0.02;
/** Farther from where a finger is put down, in sizes of the body, the stylus does not go through the air: it is put there. */
const FAR = 0.25;
/** Seconds in which the stylus has gone two thirds of the way. */
const EASE = 0.07;

const within = (height) => Math.min(Math.max(height, LOWEST), HIGHEST);

export class Pointer {
  constructor(room, { touched, put, reach, turned }) {
    Object.assign(this, { room, touched, put, reach, turned });
    this.ray = new Raycaster();
    this.at = new Vector2();
    this.mode = "surface";
    this.begin();
    const { canvas } = room;
    // Two fingers turn the view, as the right button does, and zoom by how far apart they are. Where each is, px.
    this.fingers = new Map();
    canvas.addEventListener("pointermove", (event) => {
      if (this.fingers.size > 1) this.pinch(event);
      else if (!(event.buttons & 2)) this.move(event);
    });
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.up(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("keyup", (event) => event.key === " " && (this.pressed = false));
  }

  /** Forgets where it was. */
  begin() {
    this.height = HOVER;
    this.pressed = false;
    this.goal = null;
    this.held = null;
    /** Whether it is being lifted out of the body, and whether a hand has moved since it was last. */
    this.lifts = this.moved = false;
  }

  move(event) {
    if (this.mode === "turn") return this.drag(event);
    const { left, top, width, height } = this.room.canvas.getBoundingClientRect();
    this.at.set((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
    this.held = null;
    this.aim();
    this.touched();
  }

  /** Turns the tool where it is. */
  drag({ clientX, clientY, buttons }) {
    const [x, y] = this.dragged ?? [clientX, clientY];
    this.dragged = buttons & 1 ? [clientX, clientY] : null;
    if (!this.dragged) return;
    this.turned(clientX - x, clientY - y);
    this.touched();
  }

  down(event) {
    const isFinger = event.pointerType === "touch";
    if (isFinger) this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.fingers.size > 1) this.pressed = false;
    if (event.button !== 0 || this.fingers.size > 1) return;
    this.room.canvas.focus();
    this.dragged = null;
    this.move(event);
    if (this.mode === "turn") return;
    if (isFinger && this.foot) this.put(this.over(this.height), FAR);
    this.pressed = true;
  }

  /** At a height over the foot, in the room. */
  over(height) {
    const { point, normal } = this.foot;
    return point.clone().addScaledVector(normal, height + this.reach(normal));
  }

  pinch({ pointerId, clientX, clientY }) {
    const apart = () => {
      const [a, b] = [...this.fingers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    if (!this.fingers.has(pointerId)) return;
    const before = apart();
    this.fingers.set(pointerId, [clientX, clientY]);
    const after = apart();
    if (before > 0 && after > 0) this.zoom(before / after);
  }

  /** So many times as far from the body. */
  zoom(factor) {
    const { camera, orbit } = this.room;
    camera.position.sub(orbit.target).multiplyScalar(factor).clampLength(0.6, 8).add(orbit.target);
  }

  up(event) {
    this.fingers.delete(event.pointerId);
    this.pressed = false;
  }

  wheel(event) {
    event.preventDefault();
    if (event.shiftKey || event.ctrlKey) {
      this.zoom(Math.exp((event.deltaY || event.deltaX) * 0.001));
      return;
    }
    if (this.mode === "turn") this.turned(0, 0, 8 * Math.sign(event.deltaY));
    else this.raise(-Math.sign(event.deltaY) * STEP);
  }

  raise(by) {
    const height = this.height + by;
    this.holdAt(this.mode === "plane" ? height : within(height));
    if (this.mode === "surface") this.aim();
  }

  /** Holds the stylus at a height over the surface, or moves its plane nearer to the reader by as much, in sizes of the body. */
  holdAt(height) {
    if (this.mode === "plane") this.goal?.addScaledVector(this.room.camera.getWorldDirection(new Vector3()), this.height - height);
    this.height = height;
    this.held = null;
    this.touched();
  }

  /** From the plane along the view to where that meets the body, and into it. */
  pressedIn() {
    const { camera, faces } = this.room,
      along = this.goal.clone().sub(camera.position),
      far = along.length();
    this.ray.set(camera.position, along.divideScalar(far));
    const [hit] = this.ray.intersectObjects(faces, false);
    return this.ray.ray.at(Math.max(far, hit?.distance ?? 0) + PRESS, new Vector3());
  }

  key(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (turn && this.mode === "turn") {
      this.turned(8 * turn[0], -8 * turn[1]);
    } else if (turn) {
      this.at.x += turn[0] * 0.02;
      this.at.y += turn[1] * 0.02;
      this.held = null;
      this.aim();
    } else if (event.key === "PageUp" || event.key === "PageDown") {
      this.raise(event.key === "PageUp" ? STEP : -STEP);
    } else if (event.key === " ") {
      this.pressed = true;
    } else {
      return;
    }
    event.preventDefault();
    this.touched();
  }

  // Looks along the pointer: what it meets, or a plane that faces the reader.
  aim() {
    const { room } = this;
    this.ray.setFromCamera(this.at, room.camera);
    if (this.mode === "surface") {
      const [hit] = this.ray.intersectObjects(room.faces, false);
      if (hit) {
        const normal = smooth(hit);
        this.foot = { point: hit.point.clone(), normal };
        this.goal = null;
        this.moved = true;
        return;
      }
    }
    const facing = room.camera.getWorldDirection(new Vector3());
    // Of a body just taken, in front of it.
    const through = this.goal ?? facing.clone().multiplyScalar(this.mode === "plane" ? -0.5 - this.height : 0);
    const plane = new Plane().setFromNormalAndCoplanarPoint(
      facing,
      this.foot && !this.goal ? this.foot.point : through,
    );
    const place = this.ray.ray.intersectPlane(plane, new Vector3());
    if (place) this.goal = place;
    this.foot = null;
  }

  /** From a place in the frame of the tables, metres, moves on over the surface, or in a plane that faces the reader, or turns the tool there. */
  moveIn(mode, place) {
    this.mode = mode;
    this.height = within(this.height);
    this.goal = this.room.place(place);
    this.foot = null;
  }

  /** A place in the frame of the tables, metres, that holds until the pointer moves. */
  hold(place) {
    this.held = place;
  }

  /**
   * Where the stylus is to be, coming from a place, after so many seconds; metres, in the frame of the tables. `behind`:
   * it is where nothing is felt, as after a drag straight through the body.
   */
  towards(from, seconds, behind) {
    if (this.held) return this.held;
    let goal = this.mode === "plane" && this.pressed && this.goal ? this.pressedIn() : this.goal;
    if (this.foot) {
      const height = this.pressed ? Math.min(this.height, 0) - PRESS : this.height;
      const above = this.over(Math.max(height, HOVER)),
        isFar = this.room.place(from).distanceTo(above) > HOVER / 2;
      // Once a motion: beyond an open border it would go up and down.
      this.lifts = isFar && (this.lifts || (behind && this.moved));
      if (this.lifts) this.moved = false;
      goal = this.lifts ? above : this.over(height);
    }
    if (!goal) return from;
    const share = 1 - Math.exp(-seconds / EASE);
    return this.room.unplace(this.room.place(from).lerp(goal, share));
  }
}

// The normal between those of a triangle's corners.
function smooth({ face, object, barycoord, point }) {
  const normals = object.geometry.attributes.normal;
  const sum = new Vector3();
  const weights = barycoord ? barycoord.toArray() : [1, 1, 1];
  [face.a, face.b, face.c].forEach((corner, index) => {
    sum.addScaledVector(new Vector3().fromBufferAttribute(normals, corner), weights[index]);
  });
  return sum.lengthSq() > 0 ? sum.normalize() : point.clone().normalize();
}
