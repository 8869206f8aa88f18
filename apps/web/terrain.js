// The ground: as it is (simulation), as it was seen, where jumps were to go and where they went.
import * as THREE from 'three';
import { lit } from './light.js';

const kColors = { observed: 0x4fa3a5, occluded: 0xd98c3f, unseen: 0x8d99a0, planned: 0x8a4fb5, flown: 0x17252b };
const kStates = [kColors.unseen, kColors.occluded, kColors.observed].map((color) => new THREE.Color(color));

// Made once: a material that comes and goes with each decision has its shader compiled each time.
const kPaint = {
  slab: new THREE.MeshBasicMaterial({ vertexColors: true }),
  pit: new THREE.MeshBasicMaterial({ color: lit(0xbfcacf, new THREE.Vector3(0, 0, 1)) }),
  cells: new THREE.MeshBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.75, side: THREE.DoubleSide }),
  marker: new THREE.MeshBasicMaterial(),
  soles: new THREE.MeshBasicMaterial({ color: 0xf2b441, transparent: true, opacity: 0.85 }),
  goal: new THREE.LineBasicMaterial({ color: 0x4f9d69 }),
  profile: new THREE.LineBasicMaterial({ color: 0x14666a }),
  edge: new THREE.LineBasicMaterial({ color: 0xb03a2e }),
  flown: new THREE.LineBasicMaterial({ color: kColors.flown }),
  planned: new THREE.LineDashedMaterial({ color: kColors.planned, dashSize: 0.02, gapSize: 0.014 }),
  proposed: new THREE.LineDashedMaterial({ color: 0xf2b441, dashSize: 0.02, gapSize: 0.014 }),
};

function line(points, material) {
  const result = new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), material);
  if (material.isLineDashedMaterial) result.computeLineDistances();
  return result;
}

function slabMesh(slab, floor) {
  const top = slab.top.map((p) => new THREE.Vector3(...p));
  const bottom = top.map((p) => new THREE.Vector3(p.x, p.y, floor));
  const position = [];
  const color = [];
  const face = new THREE.Triangle();
  const quad = (a, b, c, d) => {
    const shade = lit(0xd5dde0, face.set(a, b, c).getNormal(new THREE.Vector3()));
    for (const p of [a, b, c, a, c, d]) {
      position.push(p.x, p.y, p.z);
      color.push(shade.r, shade.g, shade.b);
    }
  };
  quad(...top);
  for (let i = 0; i < 4; ++i) quad(top[i], bottom[i], bottom[(i + 1) % 4], top[(i + 1) % 4]);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(color, 3));
  return new THREE.Mesh(geometry, kPaint.slab);
}

function free(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.dispose?.();  // what instances hold
  });
  object.removeFromParent();
}

export class Terrain {
  constructor(scene, about) {
    this.scene = scene;
    this.solid = [];
    this.markers = [];
    this.layers = {};
    this.shown = {};
    this.addWorld(about.scene);
  }

  addWorld(world) {
    const pit = world?.pit_z ?? 0;
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(140, 40), kPaint.pit);
    floor.position.set(50, 0, pit);
    this.scene.add(floor);
    this.solid.push(floor);
    if (!world) return;
    for (const slab of world.slabs) {
      const mesh = slabMesh(slab, pit);
      this.scene.add(mesh);
      this.solid.push(mesh);
    }
    if (world.goal_x !== null) {
      const goal = line([new THREE.Vector3(world.goal_x, -0.6, 0.005), new THREE.Vector3(world.goal_x, 0.6, 0.005)], kPaint.goal);
      this.scene.add(goal);
    }
  }

  replace(name, object) {
    if (this.layers[name]) free(this.layers[name]);
    this.layers[name] = object;
    if (object) this.scene.add(object);
  }

  // Shows what was known and decided at a time.
  show(feed, time) {
    const map = feed.last('map', time);
    const terrain = feed.last('terrain', time);
    const choice = feed.last('choice', time);
    if (map !== this.shown.map) this.replace('map', map ? this.mapCells(map) : null);
    if (terrain !== this.shown.terrain) this.replace('terrain', terrain ? this.jumpLine(terrain) : null);
    if (choice !== this.shown.choice) this.replace('choice', choice ? this.places(choice) : null);
    const plan = feed.last('plan', time);
    if (plan !== this.shown.plan) this.replace('plan', plan ? this.planned(plan) : null);
    this.shown = { map, terrain, choice, plan };
  }

  // A strip for each run of measured cells of one height along x; a dot for every second cell in x and y where
  // nothing was measured.
  mapCells(map) {
    const [nx, ny] = map.size;
    const r = map.resolution;
    const lift = 0.012;  // above ground that the estimated state takes to be higher
    const position = [];
    const color = [];
    const index = [];
    const lay = (ix, iy, count, z, state) => {
      const [before, half] = state === 2 ? [0, 0.5 * r] : [0.25 * r, 0.25 * r];
      const x = map.origin[0] + ix * r;
      const y = map.origin[1] + (iy + 0.5) * r;
      const [begin, end] = [x + before, x + count * r - before];
      const first = position.length / 3;
      position.push(begin, y - half, z, end, y - half, z, end, y + half, z, begin, y + half, z);
      const shade = kStates[state];
      for (let i = 0; i < 4; ++i) color.push(shade.r, shade.g, shade.b);
      index.push(first, first + 1, first + 2, first, first + 2, first + 3);
    };
    for (let iy = 0; iy < ny; ++iy) {
      for (let ix = 0, count = 1; ix < nx; ix += count) {
        const at = iy * nx + ix;
        const state = Number(map.state[at]);
        const same = (ahead) => ix + ahead < nx && map.state[at + ahead] === map.state[at] && Math.abs(map.height_mm[at + ahead] - map.height_mm[at]) <= 1;
        count = 1;
        while (state === 2 && same(count)) ++count;
        if (state === 2) lay(ix, iy, count, map.height_mm[at] * 1e-3 + lift, state);
        else if (ix % 2 === 0 && iy % 2 === 0) lay(ix, iy, 1, lift, state);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(color, 3));
    geometry.setIndex(index);
    return new THREE.Mesh(geometry, kPaint.cells);
  }

  // In W from x along and y to the left of a jump line, z above its origin.
  static inWorld(stance, x, y, z) {
    const c = Math.cos(stance.heading);
    const s = Math.sin(stance.heading);
    return new THREE.Vector3(stance.p[0] + c * x - s * y, stance.p[1] + s * x + c * y, stance.p[2] + z);
  }

  // Profile as the planner got it, and the edges with their uncertainty.
  jumpLine(terrain) {
    const group = new THREE.Group();
    const points = [];
    terrain.mean.forEach((z, i) => {
      if (z === null || terrain.state[i] !== '2') return;
      points.push(Terrain.inWorld(terrain, terrain.start + i * terrain.step, 0, z + 0.016));
    });
    group.add(line(points, kPaint.profile));
    for (const edge of terrain.edges) {
      const i = Math.min(terrain.mean.length - 1, Math.max(0, Math.round((edge.x - terrain.start) / terrain.step)));
      const z = Math.max(terrain.mean[i] ?? 0, terrain.mean[Math.max(0, i - 2)] ?? 0) + 0.02;
      const ends = [-0.16, 0.16].map((y) => Terrain.inWorld(terrain, edge.x, y, z));
      group.add(line(ends, kPaint.edge));
    }
    return group;
  }

  // Every place that was looked at: good ones as discs, the chosen one with its soles, rejected as crosses.
  places(choice) {
    const group = new THREE.Group();
    this.markers = [];
    if (choice.heading === null) return group;
    const discs = choice.ranked.map((place) => ({
      at: Terrain.inWorld(choice, place.distance, 0, place.height + 0.022),
      color: new THREE.Color().setHSL(0.33 * Math.max(0, (place.probability - 0.9) * 10), 0.55, 0.42),
      text: `${(100 * place.distance).toFixed(0)} cm, ${(100 * place.height).toFixed(1)} cm up: safe ${(100 * place.probability).toFixed(1)} %, margin ${(100 * place.margin).toFixed(1)} cm`,
    }));
    const crosses = choice.rejected.map((place) => ({
      at: Terrain.inWorld(choice, place.distance, 0, 0.028),
      color: new THREE.Color(0xb03a2e),
      text: `${(100 * place.distance).toFixed(0)} cm: ${place.why.replaceAll('_', ' ')}`,
    }));
    const disc = new THREE.CylinderGeometry(0.012, 0.012, 0.006, 14).rotateX(Math.PI / 2);
    this.markers = [Terrain.many(disc, discs), Terrain.many(new THREE.OctahedronGeometry(0.011), crosses)];
    group.add(...this.markers);
    if (choice.target) group.add(...this.soles(choice.target));
    return group;
  }

  // The same shape at many places, drawn at once; the text of each is found by its instance.
  static many(geometry, places) {
    const mesh = new THREE.InstancedMesh(geometry, kPaint.marker, places.length);
    const move = new THREE.Matrix4();
    places.forEach((place, i) => {
      mesh.setMatrixAt(i, move.makeTranslation(place.at));
      mesh.setColorAt(i, place.color);
    });
    mesh.userData.texts = places.map((place) => place.text);
    return mesh;
  }

  soles(target) {
    return target.soles.map((sole) => {
      const shape = new THREE.Mesh(new THREE.BoxGeometry(0.145, 0.05, 0.006), kPaint.soles);
      shape.position.set(sole.p[0], sole.p[1], sole.p[2] + 0.018);
      shape.rotation.z = sole.yaw;
      return shape;
    });
  }

  planned(plan) { return line(plan.path.map((p) => new THREE.Vector3(...p)), kPaint.planned); }

  // The path of the centre of mass up to a frame.
  flown(feed, index) {
    const count = index + 1;
    if (!this.path || this.path.capacity < count) {
      if (this.path) free(this.path.object);
      const capacity = Math.max(2048, 2 * count);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * capacity), 3));
      const object = new THREE.Line(geometry, kPaint.flown);
      object.frustumCulled = false;
      this.scene.add(object);
      this.path = { object, capacity, filled: 0 };
    }
    const attribute = this.path.object.geometry.attributes.position;
    for (let i = this.path.filled; i < feed.frames.length && i < this.path.capacity; ++i) {
      attribute.setXYZ(i, ...feed.point(feed.frames[i], 'com'));
      this.path.filled = i + 1;
      attribute.needsUpdate = true;
    }
    this.path.object.geometry.setDrawRange(0, Math.min(count, this.path.filled));
  }

  propose(reply) {
    this.replace('proposal', null);
    if (!reply?.plan) return;
    this.replace('proposal', line(reply.plan.path.map((p) => new THREE.Vector3(...p)), kPaint.proposed));
  }
}
