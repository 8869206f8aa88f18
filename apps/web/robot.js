// The robot: a trunk, two legs of capsules and two feet.
import * as THREE from 'three';

const kLegs = ['left', 'right'];
const kUp = new THREE.Vector3(0, 1, 0);

function limb(radius, color) {
  return new THREE.Mesh(new THREE.CapsuleGeometry(radius, 1, 4, 10), new THREE.MeshLambertMaterial({ color }));
}

// Stretches a capsule of length 1 from a to b.
function stretch(mesh, a, b) {
  const along = b.clone().sub(a);
  mesh.position.copy(a).addScaledVector(along, 0.5);
  mesh.scale.set(1, along.length(), 1);
  mesh.quaternion.setFromUnitVectors(kUp, along.normalize());
}

export class Robot {
  constructor(about) {
    this.group = new THREE.Group();
    const [x, y, z] = about.trunk_box;
    this.trunk = new THREE.Mesh(new THREE.BoxGeometry(x, y, z), new THREE.MeshLambertMaterial({ color: 0x26424f }));
    const face = new THREE.Mesh(new THREE.BoxGeometry(0.012, y * 0.7, z * 0.3), new THREE.MeshLambertMaterial({ color: 0xf2b441 }));
    face.position.set(x / 2, 0, z * 0.22);
    this.trunk.add(face);
    this.group.add(this.trunk);
    this.legs = kLegs.map((leg) => {
      const color = leg === 'left' ? 0x3a7ca5 : 0xc8553d;
      const parts = {
        thigh: limb(about.thigh_radius, color),
        shank: limb(about.shank_radius, color),
        foot: new THREE.Mesh(new THREE.BoxGeometry(about.foot_length, about.foot_width, 0.02), new THREE.MeshLambertMaterial({ color: 0x20343d })),
      };
      this.group.add(parts.thigh, parts.shank, parts.foot);
      return parts;
    });
  }

  // Between two frames, `share` of the way.
  pose(feed, before, after, share) {
    const mix = (name) => {
      const a = feed.point(before, name);
      const b = feed.point(after, name);
      return new THREE.Vector3(...a.map((value, i) => value + share * (b[i] - value)));
    };
    const turn = (frame) => new THREE.Quaternion(...['qx', 'qy', 'qz', 'qw'].map((name) => feed.value(frame, name)));
    this.trunk.position.copy(mix('trunk'));
    this.trunk.quaternion.copy(turn(before)).slerp(turn(after), share);
    kLegs.forEach((leg, i) => {
      const [hip, knee, ankle, toe, heel] = ['hip', 'knee', 'ankle', 'toe', 'heel'].map((part) => mix(`${leg}_${part}`));
      const parts = this.legs[i];
      stretch(parts.thigh, hip, knee);
      stretch(parts.shank, knee, ankle);
      const ahead = toe.clone().sub(heel).normalize();
      const up = new THREE.Vector3(0, 0, 1).addScaledVector(ahead, -ahead.z).normalize();
      const basis = new THREE.Matrix4().makeBasis(ahead, up.clone().cross(ahead), up);
      parts.foot.quaternion.setFromRotationMatrix(basis);
      parts.foot.position.copy(toe).add(heel).multiplyScalar(0.5).addScaledVector(up, 0.01);
    });
    return this.trunk.position;
  }
}
