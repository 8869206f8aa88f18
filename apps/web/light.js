// Light of the scene. Colours are those of the screen from end to end: three.js converts every pixel otherwise, and
// on a machine without a graphics card that takes longer than to paint it.
import * as THREE from 'three';

THREE.ColorManagement.enabled = false;

const kSky = new THREE.Color(0xffffff);
const kGround = new THREE.Color(0xb4bfc3);  // what the ground throws back
const kSkyStrength = 2.2;
const kSunStrength = 1.2;
const kToSun = new THREE.Vector3(-2, -3, 5).normalize();
const kUp = new THREE.Vector3(0, 0, 1);

export function addLights(scene) {
  const sky = new THREE.HemisphereLight(kSky, kGround, kSkyStrength);
  sky.position.copy(kUp);
  const sun = new THREE.DirectionalLight(0xffffff, kSunStrength);
  sun.position.copy(kToSun);
  scene.add(sky, sun);
}

// What the lights make of a face's colour. The ground fills the picture and never turns: it is lit once, not pixel by
// pixel.
export function lit(color, normal) {
  const skyShare = 0.5 + 0.5 * normal.dot(kUp);
  const light = kGround.clone().lerp(kSky, skyShare).multiplyScalar(kSkyStrength);
  light.addScalar(kSunStrength * Math.max(0, normal.dot(kToSun)));
  return new THREE.Color(color).multiply(light).multiplyScalar(1 / Math.PI);
}
