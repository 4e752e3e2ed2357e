// Geometry of the view: tubes round the nodes of the wire, made here, and the core. Lengths in mm.

const SIDES = 10;
const SCALE = 1e3;
/** What is drawn of a tube: every so many of its sides and nodes. */
const DETAIL = { fine: { sides: 1, nodes: 1 }, draft: { sides: 2, nodes: 2 }, rough: { sides: 2, nodes: 6 } };
/** Cubes along the longest edge of the core, for pictures while the view moves. */
const CUBES = 60;
/** Colours of the screen as light, by the curve of sRGB. */
const LIGHT = Float32Array.from({ length: 256 }, (_, k) => {
  const c = k / 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
});

/** The triangles of a tube along so many nodes. */
function tubeIndex(nodes, every) {
  const steps = Math.floor((nodes - 1) / every.nodes);
  const index = new Uint32Array(Math.max(0, (6 * SIDES * steps) / every.sides));
  const [row, ahead] = [SIDES * every.nodes, new Array(SIDES)];
  for (let side = 0; side < SIDES; side += 1) ahead[side] = (side + every.sides) % SIDES;
  let at = 0;
  for (let step = 0; step < steps; step += 1) {
    for (let side = 0; side < SIDES; side += every.sides) {
      const [a, b] = [step * row + side, step * row + ahead[side]];
      index[at] = a;
      index[at + 1] = index[at + 3] = b;
      index[at + 2] = index[at + 5] = a + row;
      index[at + 4] = b + row;
      at += 6;
    }
  }
  return new Vendor.BufferAttribute(index, 1);
}

/** A tube along a wire: geometry whose colours can be set per node, drawn in full or with fewer corners. */
class Tube {
  constructor(points, radius) {
    this.nodes = points.length / 3;
    const n = this.nodes;
    const place = new Float32Array(3 * SIDES * n);
    const normal = new Float32Array(3 * SIDES * n);
    const circle = Array.from({ length: SIDES }, (_, k) => [Math.cos((TURN * k) / SIDES), Math.sin((TURN * k) / SIDES)]);
    const v = (k) => new Vendor.Vector3(points[3 * k], points[3 * k + 1], points[3 * k + 2]).multiplyScalar(SCALE);
    const [along, u, w] = [new Vendor.Vector3(), new Vendor.Vector3(0.3, 1, 0.2), new Vendor.Vector3()];
    let [before, here] = [v(0), v(0)];
    for (let k = 0; k < n; k += 1) {
      const after = k + 1 < n ? v(k + 1) : here;
      along.subVectors(after, before).normalize();
      // Carried along with the least turn, so that the surface does not twist.
      u.addScaledVector(along, -u.dot(along)).normalize();
      w.crossVectors(along, u);
      for (let side = 0; side < SIDES; side += 1) {
        const [c, s] = circle[side];
        const at = 3 * (k * SIDES + side);
        const [x, y, z] = [c * u.x + s * w.x, c * u.y + s * w.y, c * u.z + s * w.z];
        normal.set([x, y, z], at);
        place.set([here.x + radius * x, here.y + radius * y, here.z + radius * z], at);
      }
      [before, here] = [here, after];
    }
    this.geometry = new Vendor.BufferGeometry();
    this.geometry.setAttribute("position", new Vendor.BufferAttribute(place, 3));
    this.geometry.setAttribute("normal", new Vendor.BufferAttribute(normal, 3));
    this.geometry.setAttribute("color", new Vendor.BufferAttribute(new Float32Array(3 * SIDES * n), 3));
    this.index = {};
    this.shown = n;
    this.detail("draft");
  }

  /** Draws all of it, or less. */
  detail(name) {
    this.drawn = name;
    this.index[name] ??= tubeIndex(this.nodes, DETAIL[name]);
    this.geometry.setIndex(this.index[name]);
    this.show(this.shown);
  }

  /** Draws the first nodes only. */
  show(nodes) {
    this.shown = Math.min(nodes, this.nodes);
    const every = DETAIL[this.drawn];
    this.geometry.setDrawRange(0, ((6 * SIDES) / every.sides) * Math.floor(Math.max(0, this.shown - 1) / every.nodes));
  }

  /** Colours the nodes. */
  paint(values, colours) {
    const colour = this.geometry.getAttribute("color");
    for (let k = 0; k < this.nodes; k += 1) {
      const light = colours.of(values[k]).map((c) => LIGHT[Math.round(c)]);
      for (let side = 0; side < SIDES; side += 1) colour.array.set(light, 3 * (k * SIDES + side));
    }
    colour.needsUpdate = true;
  }
}

/** The core as flat triangles, all or few. They share corners, since the graphics card takes their normals from the picture. */
class CoreSurface {
  constructor(core) {
    this.geometry = new Vendor.BufferGeometry();
    this.geometry.setAttribute("position", new Vendor.BufferAttribute(core.points.map((metres) => SCALE * metres), 3));
    this.index = { fine: new Vendor.BufferAttribute(core.corners, 1) };
    this.index.draft = this.index.rough = new Vendor.BufferAttribute(fewCorners(core), 1);
    const material = new Vendor.MeshLambertMaterial({ flatShading: true, side: Vendor.DoubleSide });
    this.mesh = new Vendor.Mesh(this.geometry, material);
    this.detail("draft");
  }

  detail(name) {
    this.geometry.setIndex(this.index[name]);
  }
}

/** The triangles that are left where the first corner in a cube of space stands for all corners in it. */
function fewCorners({ points, corners }) {
  const low = [Infinity, Infinity, Infinity];
  let extent = 0;
  for (let at = 0; at < points.length; at += 1) low[at % 3] = Math.min(low[at % 3], points[at]);
  for (let at = 0; at < points.length; at += 1) extent = Math.max(extent, points[at] - low[at % 3]);
  const first = new Map();
  const standIn = Uint32Array.from({ length: points.length / 3 }, (_, corner) => {
    const cube = low.reduce((sum, least, axis) => sum * CUBES + Math.floor(((points[3 * corner + axis] - least) / extent) * (CUBES - 1)), 0);
    if (!first.has(cube)) first.set(cube, corner);
    return first.get(cube);
  });
  const few = [];
  for (let at = 0; at < corners.length; at += 3) {
    const [a, b, c] = [standIn[corners[at]], standIn[corners[at + 1]], standIn[corners[at + 2]]];
    if (a !== b && b !== c && c !== a) few.push(a, b, c);
  }
  return Uint32Array.from(few);
}

/** The wire at a frame: what lay already, then what the frame has. */
function wireAt(run, frame) {
  if (frame == null) return run.wire;
  const { keep, wire } = run.frames[frame];
  const join = (name, per) => {
    const [first, rest] = [run.wire[name].subarray(0, per * keep), wire[name]];
    const joined = new first.constructor(first.length + rest.length);
    joined.set(first);
    joined.set(rest, first.length);
    return joined;
  };
  return Object.fromEntries(Object.keys(run.wire).map((name) => [name, join(name, name === "points" ? 3 : 1)]));
}
