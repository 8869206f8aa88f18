// The ground: as it is (simulation), as it was seen, where jumps were to go and where they went.
import * as THREE from 'three';

const kColors = { observed: 0x4fa3a5, occluded: 0xd98c3f, unseen: 0x8d99a0, planned: 0x8a4fb5, flown: 0x17252b };
const kStates = [kColors.unseen, kColors.occluded, kColors.observed];

function line(points, color, options = {}) {
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  const material = options.dashed
    ? new THREE.LineDashedMaterial({ color, dashSize: 0.02, gapSize: 0.014 })
    : new THREE.LineBasicMaterial({ color });
  const result = new THREE.Line(geometry, material);
  if (options.dashed) result.computeLineDistances();
  return result;
}

function slabMesh(slab, floor) {
  const top = slab.top.map((p) => new THREE.Vector3(...p));
  const bottom = top.map((p) => new THREE.Vector3(p.x, p.y, floor));
  const position = [];
  const quad = (a, b, c, d) => { for (const p of [a, b, c, a, c, d]) position.push(p.x, p.y, p.z); };
  quad(...top);
  for (let i = 0; i < 4; ++i) quad(top[i], bottom[i], bottom[(i + 1) % 4], top[(i + 1) % 4]);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.computeVertexNormals();
  return new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0xd5dde0, roughness: 0.95, side: THREE.DoubleSide }));
}

function free(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
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
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(140, 40), new THREE.MeshStandardMaterial({ color: 0xbfcacf, roughness: 1 }));
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
      const goal = line([new THREE.Vector3(world.goal_x, -0.6, 0.005), new THREE.Vector3(world.goal_x, 0.6, 0.005)], 0x4f9d69);
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

  mapCells(map) {
    const [nx, ny] = map.size;
    const r = map.resolution;
    const position = [];
    const color = [];
    const shade = new THREE.Color();
    const lift = 0.004;
    for (let iy = 0; iy < ny; ++iy) {
      for (let ix = 0; ix < nx; ++ix) {
        const at = iy * nx + ix;
        const state = Number(map.state[at]);
        if (state !== 2 && (ix % 2 || iy % 2)) continue;  // sparse where nothing was measured
        const z = state === 2 ? map.height_mm[at] * 1e-3 + lift : lift;
        const x = map.origin[0] + ix * r;
        const y = map.origin[1] + iy * r;
        const s = state === 2 ? 0.42 * r : 0.25 * r;
        const cx = x + 0.5 * r;
        const cy = y + 0.5 * r;
        for (const [dx, dy] of [[-s, -s], [s, -s], [s, s], [-s, -s], [s, s], [-s, s]]) position.push(cx + dx, cy + dy, z);
        shade.set(kStates[state]);
        for (let i = 0; i < 6; ++i) color.push(shade.r, shade.g, shade.b);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(color, 3));
    return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.75, side: THREE.DoubleSide }));
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
      points.push(Terrain.inWorld(terrain, terrain.start + i * terrain.step, 0, z + 0.008));
    });
    group.add(line(points, 0x14666a));
    for (const edge of terrain.edges) {
      const i = Math.min(terrain.mean.length - 1, Math.max(0, Math.round((edge.x - terrain.start) / terrain.step)));
      const z = Math.max(terrain.mean[i] ?? 0, terrain.mean[Math.max(0, i - 2)] ?? 0) + 0.012;
      const ends = [-0.16, 0.16].map((y) => Terrain.inWorld(terrain, edge.x, y, z));
      group.add(line(ends, 0xb03a2e));
    }
    return group;
  }

  // Every place that was looked at: good ones as discs, the chosen one with its soles, rejected as crosses.
  places(choice) {
    const group = new THREE.Group();
    this.markers = [];
    if (choice.heading === null) return group;
    const mark = (mesh, text) => {
      mesh.userData.text = text;
      this.markers.push(mesh);
      group.add(mesh);
    };
    for (const place of choice.ranked) {
      const disc = new THREE.Mesh(new THREE.CylinderGeometry(0.012, 0.012, 0.006, 14), new THREE.MeshBasicMaterial({ color: new THREE.Color().setHSL(0.33 * Math.max(0, (place.probability - 0.9) * 10), 0.55, 0.42) }));
      disc.rotation.x = Math.PI / 2;
      disc.position.copy(Terrain.inWorld(choice, place.distance, 0, place.height + 0.014));
      mark(disc, `${(100 * place.distance).toFixed(0)} cm, ${(100 * place.height).toFixed(1)} cm up: safe ${(100 * place.probability).toFixed(1)} %, margin ${(100 * place.margin).toFixed(1)} cm`);
    }
    for (const place of choice.rejected) {
      const cross = new THREE.Mesh(new THREE.OctahedronGeometry(0.011), new THREE.MeshBasicMaterial({ color: 0xb03a2e }));
      cross.position.copy(Terrain.inWorld(choice, place.distance, 0, 0.02));
      mark(cross, `${(100 * place.distance).toFixed(0)} cm: ${place.why.replaceAll('_', ' ')}`);
    }
    if (choice.target) group.add(...this.soles(choice.target, 0xf2b441));
    return group;
  }

  soles(target, color) {
    return target.soles.map((sole) => {
      const shape = new THREE.Mesh(new THREE.BoxGeometry(0.145, 0.05, 0.006), new THREE.MeshBasicMaterial({ color, transparent: true, opacity: 0.85 }));
      shape.position.set(sole.p[0], sole.p[1], sole.p[2] + 0.01);
      shape.rotation.z = sole.yaw;
      return shape;
    });
  }

  planned(plan) { return line(plan.path.map((p) => new THREE.Vector3(...p)), kColors.planned, { dashed: true }); }

  // The path of the centre of mass up to a frame.
  flown(feed, index) {
    const count = index + 1;
    if (!this.path || this.path.capacity < count) {
      if (this.path) free(this.path.object);
      const capacity = Math.max(2048, 2 * count);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * capacity), 3));
      const object = new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: kColors.flown }));
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
    this.replace('proposal', line(reply.plan.path.map((p) => new THREE.Vector3(...p)), 0xf2b441, { dashed: true }));
  }
}
