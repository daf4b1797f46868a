// The room: camera, light, and the body in it. Places are those of the body's tables, metres; the room is measured in
// sizes of the body, so that a ring and a ship are looked at alike.

import {
  ACESFilmicToneMapping,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  HemisphereLight,
  Matrix4,
  LineMaterial,
  LineSegments2,
  LineSegmentsGeometry,
  Mesh,
  MeshPhysicalMaterial,
  OrbitControls,
  PCFShadowMap,
  PerspectiveCamera,
  PMREMGenerator,
  PlaneGeometry,
  RoomEnvironment,
  Scene,
  ShadowMaterial,
  Vector3,
  WebGLRenderer,
} from "three";
import { free } from "free";

const PORCELAIN = 0xe6dfd2,
  LIT = 0x8fe3da,
  SEAM = 0x6d7484,
  BORDER = 0x20283a;

// What three.js calls MOUSE.PAN, MOUSE.ROTATE and TOUCH.DOLLY_ROTATE.
const MOUSE_PAN = 2,
  MOUSE_ROTATE = 0,
  TOUCH_ROTATE = 3;

/** Height and width of what is seen of the room, in its distance. */
const HIGH = 0.5,
  WIDE = 0.66;
/** A surface is seen well from a direction whose cosine with its normal is this. */
const SEEN = 0.3;

export class Room {
  constructor(canvas) {
    this.canvas = canvas;
    // Asked for here: three.js throws where a browser has none.
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    /** Null in a browser without WebGL: then everything works but the picture. */
    this.renderer = context && new WebGLRenderer({ canvas, context });
    if (context) {
      this.renderer.toneMapping = ACESFilmicToneMapping;
      this.renderer.toneMappingExposure = 0.92;
      this.renderer.shadowMap.enabled = true;
      this.renderer.shadowMap.type = PCFShadowMap;
    }
    this.scene = new Scene();
    this.scene.environmentIntensity = 0.42;
    this.camera = new PerspectiveCamera(32, 1, 0.01, 60);
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableZoom = false;
    this.orbit.enableDamping = true;
    this.orbit.mouseButtons = { LEFT: null, MIDDLE: MOUSE_PAN, RIGHT: MOUSE_ROTATE };
    this.orbit.touches = { ONE: null, TWO: TOUCH_ROTATE };
    this.light();
    this.lines = [];
    /** What is shown: a group a body, in the frame of its tables. */
    this.bodies = [];
    this.resize();
  }

  light() {
    this.sun = new DirectionalLight(0xfff1dc, 2.3);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 6;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.012;
    Object.assign(this.sun.shadow.camera, { left: -1.2, right: 1.2, top: 1.2, bottom: -1.2, near: 0.1, far: 8 });
    const back = new DirectionalLight(0x7fa8ff, 0.9);
    back.position.set(-2, 1.5, 0.6);
    this.scene.add(this.sun, this.sun.target, back, new HemisphereLight(0xbcd0ff, 0x3a2f28, 0.5));
    this.floor = new Mesh(new PlaneGeometry(30, 30), new ShadowMaterial({ opacity: 0.32 }));
    this.floor.receiveShadow = true;
    this.scene.add(this.floor);
  }

  /** From the frame of what is felt, a body's tables or a scene, to the room. */
  place([x, y, z], into = new Vector3()) {
    return into.set(x - this.middle[0], y - this.middle[1], z - this.middle[2]).multiplyScalar(1 / this.size);
  }

  /** And back. */
  unplace({ x, y, z }) {
    return [x, y, z].map((coordinate, axis) => coordinate * this.size + this.middle[axis]);
  }

  /** A place in the frame of a body's tables, in its group. */
  within([x, y, z], into = new Vector3()) {
    return into.set(x, y, z).multiplyScalar(1 / this.size);
  }

  /** Shows bodies where they begin: a mesh a face, so that the active one can be lit, seams thin and sharp edges dark. */
  show(bodies) {
    this.scene.remove(...this.bodies);
    this.lines = [];
    // A face that moves is evaluated in each frame.
    const steps = ({ device }) => (device.faces > 60 ? 12 : device.faces > 12 || device.modes().length ? 24 : 48);
    const grids = bodies.map((body) =>
      Array.from({ length: body.device.faces }, (_, face) => body.device.face(face, steps(body))),
    );
    this.frame(bodies, grids);
    this.bodies = bodies.map((body, index) => this.body(body, grids[index], steps(body)));
    this.put(bodies.map(({ place }) => place ?? IDENTITY));
    this.scene.add(...this.bodies);
    /** All faces, for who looks along a ray. */
    this.faces = this.bodies.flatMap(({ faces }) => faces);
  }

  body({ device }, grids, steps) {
    const group = Object.assign(new Group(), { steps });
    group.faces = grids.map((grid) => this.face(grid, steps));
    const [seams, borders] = this.edges(device);
    group.seams = this.line(seams, { color: SEAM, linewidth: 1.0, opacity: 0.55 });
    group.borders = this.line(borders, { color: BORDER, linewidth: 1.9, opacity: 0.9 });
    group.add(...group.faces, group.seams, group.borders);
    return group;
  }

  /** Smooth edges and sharp ones, as lines. */
  edges(device) {
    const curves = [[], []];
    for (let edge = 0; edge < device.edges; edge += 1) {
      const curve = device.edge(edge, 32),
        line = curves[device.isSmooth(edge) ? 0 : 1];
      for (let at = 9; at < curve.length; at += 9) {
        for (const end of [at - 9, at]) line.push(...this.within(curve.subarray(end, end + 3)).toArray());
      }
    }
    return curves.map((points) => (points.length ? new LineSegmentsGeometry().setPositions(points) : null));
  }

  /** Draws the only body where its modes have moved it. */
  reshape(device) {
    const [group] = this.bodies;
    group.faces.forEach(({ geometry }, face) => {
      const { position, normal } = geometry.attributes;
      this.fill(device.face(face, group.steps), position.array, normal.array);
      position.needsUpdate = normal.needsUpdate = true;
      geometry.computeBoundingSphere();
    });
    const [seams, borders] = this.edges(device);
    for (const [line, geometry] of [
      [group.seams, seams],
      [group.borders, borders],
    ]) {
      if (!geometry) continue;
      line.geometry.dispose();
      line.geometry = geometry;
    }
  }

  /** Points and normals of a face. */
  fill(grid, position, normal) {
    const at = new Vector3();
    for (let vertex = 0; 3 * vertex < position.length; vertex += 1) {
      this.within(grid.subarray(6 * vertex, 6 * vertex + 3), at).toArray(position, 3 * vertex);
      normal.set(grid.subarray(6 * vertex + 3, 6 * vertex + 6), 3 * vertex);
    }
  }

  /** Puts each body to its place: its axes and its origin, twelve numbers. */
  put(places) {
    places.forEach((place, index) => pose(this.bodies[index], place, this));
  }

  frame(bodies, grids) {
    const low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity];
    const out = new Vector3(),
      at = new Vector3();
    let count = 0;
    bodies.forEach(({ place = IDENTITY }, body) => {
      const matrix = matrixOf(place);
      for (const grid of grids[body]) {
        for (let start = 0; start < grid.length; start += 6) {
          at.fromArray(grid, start).applyMatrix4(matrix);
          at.toArray().forEach((coordinate, axis) => {
            low[axis] = Math.min(low[axis], coordinate);
            high[axis] = Math.max(high[axis], coordinate);
          });
          out.add(at.fromArray(grid, start + 3).transformDirection(matrix));
          count += 1;
        }
      }
    });
    this.size = bodies.length > 1 ? Math.max(...high.map((most, axis) => most - low[axis])) : bodies[0].device.size;
    const { size } = this;
    this.middle = low.map((least, axis) => (least + high[axis]) / 2);
    // An open patch is looked at from its front.
    this.front = out.length() > 0.2 * count ? out.normalize() : new Vector3(0, 0, 1);
    const height = (high[2] - low[2]) / 2 / size;
    this.floor.position.z = -height - 0.012;
    this.sun.position.set(1.5, -1.0, 2.6);
    // As near as the whole of it and the stylus fit, by the sphere around it.
    const radius = Math.hypot(...low.map((least, axis) => high[axis] - least)) / 2 / size;
    this.far = 1.3 + 2.25 * radius;
    this.look(this.front);
  }

  /** Looks from a corner that sees what faces a direction; the one in front on the right where it does. */
  look(front) {
    let from = new Vector3();
    for (const x of [1, -1])
      for (const y of [1, -1])
        for (const z of [1, -1]) {
          const corner = new Vector3(0.95 * x, -1.45 * y, z).normalize();
          if (Math.min(corner.dot(front), SEEN) > Math.min(from.dot(front), SEEN) + 1e-6 || !from.lengthSq()) from = corner;
        }
    this.from = front;
    this.floor.visible = from.z > 0;
    this.camera.position.copy(from.multiplyScalar(this.far));
    this.orbit.target.set(0, 0, -0.02);
    this.orbit.update();
  }

  face(grid, steps) {
    const columns = steps + 1,
      count = columns * columns;
    const position = new Float32Array(3 * count),
      normal = new Float32Array(3 * count);
    this.fill(grid, position, normal);
    const index = [];
    for (let row = 0; row < steps; row += 1) {
      for (let column = 0; column < steps; column += 1) {
        const corner = row * columns + column;
        index.push(corner, corner + columns, corner + 1, corner + 1, corner + columns, corner + columns + 1);
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("normal", new BufferAttribute(normal, 3));
    geometry.setIndex(turned(index, position, normal));
    const material = new MeshPhysicalMaterial({
      color: PORCELAIN,
      roughness: 0.42,
      clearcoat: 0.35,
      clearcoatRoughness: 0.45,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const mesh = new Mesh(geometry, material);
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    return mesh;
  }

  line(geometry, { color, linewidth, opacity }) {
    const material = new LineMaterial({ color, linewidth, transparent: true, opacity });
    material.resolution.copy(this.resolution);
    this.lines.push(material);
    return Object.assign(new LineSegments2(geometry ?? undefined, material), { visible: geometry !== null });
  }

  /** Lights a face of a body, or none. */
  lightUp(body, face) {
    const plain = new Color(PORCELAIN),
      lit = new Color(LIT),
      active = face === null ? null : this.bodies[body].faces[face];
    this.lit = active;
    for (const mesh of this.faces) mesh.material.color.lerp(mesh === active ? lit : plain, 0.25);
  }

  resize() {
    const { width, height, top, bottom } = free(true);
    this.renderer?.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer?.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    // In the middle of what words leave free, and as large as fits there.
    const scale = Math.min((bottom - top) / HIGH, width / WIDE);
    this.camera.fov = (2 * Math.atan(height / 2 / scale)) / DEGREE;
    this.camera.setViewOffset(width, height, 0, (height - top - bottom) / 2, width, height);
    this.resolution = { x: width, y: height, isVector2: true };
    this.lines?.forEach((material) => material.resolution.set(width, height));
  }

  /** Draws a frame, or only puts everything to where it would be drawn. */
  draw(draws) {
    this.orbit.update();
    if (draws && this.renderer) {
      // Drawn itself, so not before anything is.
      this.scene.environment ??= new PMREMGenerator(this.renderer).fromScene(new RoomEnvironment(), 0.04).texture;
      return this.renderer.render(this.scene, this.camera);
    }
    this.scene.updateMatrixWorld();
    this.camera.updateMatrixWorld();
  }
}

const DEGREE = Math.PI / 180;
const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

function matrixOf(place) {
  const [x, y, z, origin] = [0, 3, 6, 9].map((at) => new Vector3().fromArray(place, at));
  return new Matrix4().makeBasis(x, y, z).setPosition(origin);
}

/** Puts a group of the room's to a place, its axes and its origin. */
export function pose(group, place, room) {
  group.quaternion.setFromRotationMatrix(matrixOf(place));
  room.place(place.slice(9), group.position);
}

// Triangles whose front is where the normals point.
function turned(index, position, normal) {
  const at = (vertex) => new Vector3().fromArray(position, 3 * vertex);
  let sum = 0;
  for (let triangle = 0; triangle < index.length; triangle += 3) {
    const [a, b, c] = [0, 1, 2].map((corner) => at(index[triangle + corner]));
    sum += b
      .sub(a)
      .cross(c.sub(a))
      .dot(new Vector3().fromArray(normal, 3 * index[triangle]));
  }
  if (sum >= 0) return index;
  for (let triangle = 0; triangle < index.length; triangle += 3) {
    [index[triangle + 1], index[triangle + 2]] = [index[triangle + 2], index[triangle + 1]];
  }
  return index;
}
