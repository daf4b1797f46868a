// What is not the body: stylus, closest point, gap, normal, force, the god-object, and the region of the active
// feature.

import {
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  Line2,
  LineGeometry,
  LineMaterial,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Raycaster,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "three";
import { TOUCHING } from "firmware";
import { colour, withColours } from "scheme";

const STEEL = 0xcdd4df;
/** Names of colours, which the reader's scheme changes. */
const WITNESS = "mark-point",
  FORCE = "mark-force",
  NEWTON = "lost",
  NORMAL = "mark-normal",
  REGION = "witness";
const UP = new Vector3(0, 1, 0);
/** How far the region's sheets reach, and how long an arrow of a newton is, in sizes of the body. */
const REACH = 0.42,
  OF_A_NEWTON = 0.085;
const RAYS = 25;
/** How long the pen is, and how much more than aside it may lean away from the surface. */
const LONG = 0.46,
  SHARES = [0.42, 0.8, 1.5, 3, 10];

export class Marks {
  constructor(room) {
    this.room = room;
    this.group = new Group();
    room.scene.add(this.group);
    this.stylus = stylus();
    this.ghost = ball(
      0.016,
      new MeshBasicMaterial({ color: STEEL, transparent: true, opacity: 0.4, depthTest: false }),
    );
    this.witness = ball(0.0135, inked(WITNESS, new MeshBasicMaterial()));
    this.ring = new Mesh(new TorusGeometry(0.034, 0.0022, 10, 48), inked(WITNESS, new MeshBasicMaterial()));
    // The god-object: where the stylus would be if the wall did not give.
    this.god = ball(
      0.022,
      inked(FORCE, new MeshStandardMaterial({ transparent: true, opacity: 0.45, roughness: 0.3 })),
    );
    this.gap = this.line(WITNESS, 2.2, true);
    this.anchor = this.line(FORCE, 3);
    this.rim = this.line(WITNESS, 4.5);
    this.normal = arrow(NORMAL, 0.0028);
    this.force = arrow(FORCE, 0.0075);
    this.sheet = new Mesh(
      new BufferGeometry(),
      inked(
        REGION,
        new MeshBasicMaterial({ vertexColors: true, transparent: true, side: DoubleSide, depthWrite: false }),
      ),
    );
    // Chords of a way cut through the surface: they are seen all the same.
    this.ours = this.line(WITNESS, 3.5);
    this.newton = this.line(NEWTON, 3.5);
    for (const way of [this.ours, this.newton]) way.material.depthTest = false;
    this.group.add(
      this.stylus,
      this.ghost,
      this.witness,
      this.ring,
      this.god,
      this.gap,
      this.anchor,
      this.normal,
      this.force,
      this.ours,
      this.newton,
    );
    // These lie on a body, and go where it goes.
    this.local = new Group();
    this.local.add(this.rim, this.sheet);
    this.group.add(this.local);
    this.lean = new Vector3(0, 0, 1);
    this.ray = new Raycaster();
    this.shown = {};
  }

  line(color, linewidth, dashed = false) {
    const style = { linewidth, dashed, dashSize: 0.02, gapSize: 0.014, transparent: true };
    const material = inked(color, new LineMaterial(style));
    material.resolution.copy(this.room.resolution);
    const line = new Line2(new LineGeometry(), material);
    line.visible = false;
    return line;
  }

  /** Forgets the body that was shown. */
  begin() {
    this.shown = {};
    this.ways();
  }

  /** What lies on a body lies on this one, of those that the room shows. */
  on(body) {
    const { position, quaternion } = this.room.bodies[body];
    this.local.position.copy(position);
    this.local.quaternion.copy(quaternion);
    if (body !== this.shown.body) this.shown = { body };
  }

  /** Shows a view of the loop; a tool with a shape is drawn elsewhere. */
  show(view, withRegion, isShaped = false) {
    const { room } = this;
    const probe = room.place(view.probe),
      point = room.place(view.point);
    const normal = new Vector3(...view.normal),
      touching = view.contact === TOUCHING;
    this.stylus.position.copy(probe);
    this.lean.lerp(this.leaning(probe, normal), 0.12).normalize();
    this.stylus.quaternion.setFromUnitVectors(UP, this.lean);
    this.ghost.position.copy(probe);
    this.stylus.visible = this.ghost.visible = !isShaped;
    this.witness.position.copy(point);
    this.ring.position.copy(point).addScaledVector(normal, 0.002);
    this.ring.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal.lengthSq() > 0 ? normal : UP);
    this.god.visible = touching && !isShaped;
    this.god.position.copy(point).addScaledVector(normal, 0.012);
    this.draw(this.gap, isShaped ? [] : [probe, point]);
    const held = view.held > 0 && touching;
    this.draw(this.anchor, held ? [point, room.place(view.anchor)] : []);
    this.anchor.material.opacity = view.slips ? 0.5 : 1;
    aim(this.normal, point, normal, normal.lengthSq() > 0 ? 0.16 : 0);
    const force = new Vector3(...view.force),
      newtons = force.length();
    // It starts in the tool.
    this.force.shaft.material.depthTest = !isShaped;
    aim(this.force, touching ? point : probe, force, Math.min(newtons * OF_A_NEWTON, 0.9));
    this.sheet.visible = withRegion;
  }

  /** Which way the pen leans: to the reader's right and away from the surface, and the more away the less room there is. */
  leaning(probe, normal) {
    const aside = new Vector3(0.85, 0.42, 0.42).applyQuaternion(this.room.camera.quaternion);
    const away = (share) => aside.clone().addScaledVector(normal, share).normalize();
    // Looking for room takes time: not in each frame.
    this.frames = (this.frames ?? 0) + 1;
    const isFree = (share) => this.isOutside(probe, away(share));
    if (this.frames % 8 === 1) this.share = SHARES.find(isFree) ?? SHARES.at(-1);
    return away(this.share);
  }

  /** Whether a pen at the probe that leans along a direction leaves the body by the face in contact, and stays outside. */
  isOutside(probe, direction) {
    this.ray.set(probe, direction);
    this.ray.far = LONG;
    const hits = this.ray.intersectObjects(this.room.faces, false);
    if (!hits.length) return true;
    const [first] = hits,
      // Where two faces meet, both are hit.
      isLast = hits.at(-1).distance - first.distance < 1e-3;
    return isLast && first.distance < LONG / 3 && first.object === (this.room.lit ?? first.object);
  }

  /** Lights an edge, or none. */
  edge(index, device) {
    if (index === this.shown.edge) return;
    this.shown.edge = index;
    const curve = index === null ? [] : device.edge(index, 32);
    this.draw(
      this.rim,
      Array.from({ length: curve.length / 9 }, (_, at) => this.room.within(curve.subarray(9 * at, 9 * at + 3))),
    );
  }

  /** Draws the region of a feature anew when it is another. */
  region(code, device) {
    if (code === this.shown.code) return;
    this.shown.code = code;
    const rays = device.sheets(code),
      count = rays.length / 6;
    const position = new Float32Array(6 * count),
      shade = new Float32Array(8 * count),
      index = [];
    const base = new Vector3(),
      out = new Vector3();
    for (let ray = 0; ray < count; ray += 1) {
      this.room.within(rays.subarray(6 * ray, 6 * ray + 3), base).toArray(position, 6 * ray);
      out
        .fromArray(rays, 6 * ray + 3)
        .multiplyScalar(REACH)
        .add(base)
        .toArray(position, 6 * ray + 3);
      shade.set([1, 1, 1, 0.34, 1, 1, 1, 0], 8 * ray);
      if (ray % RAYS !== RAYS - 1) index.push(2 * ray, 2 * ray + 1, 2 * ray + 2, 2 * ray + 2, 2 * ray + 1, 2 * ray + 3);
    }
    this.sheet.geometry.dispose();
    this.sheet.geometry = new BufferGeometry();
    this.sheet.geometry.setAttribute("position", new BufferAttribute(position, 3));
    this.sheet.geometry.setAttribute("color", new BufferAttribute(shade, 4));
    this.sheet.geometry.setIndex(index);
  }

  /** The ways of both methods over the patch, as points in metres. */
  ways(ours = [], newton = []) {
    this.draw(
      this.ours,
      ours.map((place) => this.room.place(place)),
    );
    this.draw(
      this.newton,
      newton.map((place) => this.room.place(place)),
    );
  }

  draw(line, points) {
    line.visible = points.length > 1;
    if (!line.visible) return;
    line.geometry.dispose();
    line.geometry = new LineGeometry().setPositions(points.flatMap((point) => point.toArray()));
    line.material.resolution.copy(this.room.resolution);
    if (line.material.dashed) line.computeLineDistances();
  }
}

/** A material of a colour by its name, now and whenever the scheme changes. */
function inked(name, material) {
  // Tone mapping would make marks pale.
  material.toneMapped = name === REGION;
  withColours(() => material.color.set(colour(name)));
  return material;
}

function ball(radius, material) {
  return new Mesh(new SphereGeometry(radius, 32, 20), material);
}

function stylus() {
  const steel = new MeshStandardMaterial({ color: STEEL, metalness: 0.85, roughness: 0.28 });
  const grip = new MeshStandardMaterial({ color: 0x2a3246, metalness: 0.1, roughness: 0.6 });
  const group = new Group();
  const tip = ball(0.016, steel);
  const taper = new Mesh(new CylinderGeometry(0.022, 0.008, 0.15, 32), steel);
  taper.position.y = 0.083;
  const shaft = new Mesh(new CylinderGeometry(0.022, 0.022, 0.3, 32), grip);
  shaft.position.y = 0.308;
  const collar = new Mesh(new CylinderGeometry(0.0225, 0.0225, 0.01, 32), steel);
  collar.position.y = 0.19;
  group.add(tip, taper, shaft, collar);
  group.children.forEach((part) => (part.castShadow = true));
  return group;
}

function arrow(color, radius) {
  const material = inked(color, new MeshBasicMaterial());
  const group = new Group();
  group.shaft = new Mesh(new CylinderGeometry(radius, radius, 1, 16), material);
  group.head = new Mesh(new ConeGeometry(3 * radius, 8 * radius, 20), material);
  group.long = 8 * radius;
  group.shaft.renderOrder = group.head.renderOrder = 1;
  group.add(group.shaft, group.head);
  return group;
}

// From a place along a direction, so long.
function aim(arrow, from, direction, length) {
  arrow.visible = length > 1e-3;
  if (!arrow.visible) return;
  arrow.position.copy(from);
  arrow.quaternion.setFromUnitVectors(UP, direction.clone().normalize());
  const head = Math.min(arrow.long, length);
  arrow.shaft.scale.y = Math.max(length - head, 1e-4);
  arrow.shaft.position.y = (length - head) / 2;
  arrow.head.scale.setScalar(head / arrow.long);
  arrow.head.position.y = length - head / 2;
}
