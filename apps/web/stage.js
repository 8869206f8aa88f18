// Camera and the picture.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { addLights } from './light.js';

// Shares of the screen's resolution: a machine without a graphics card keeps pace at a lower one.
const kSharpness = [1, 0.7, 0.5];
const kSlowPicture = 1 / 32;  // [s]

function drawnBySoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const name = gl?.getExtension('WEBGL_debug_renderer_info');
  return Boolean(name) && /swiftshader|llvmpipe|software/i.test(gl.getParameter(name.UNMASKED_RENDERER_WEBGL));
}

// Without a share of transparency: three.js asks for one, and a picture that could be seen through is mixed into the
// page pixel by pixel.
function opaqueContext(canvas) {
  const context = canvas.getContext('webgl2', { alpha: false, antialias: !drawnBySoftware(), preserveDrawingBuffer: true });
  if (!context) throw new Error('this browser draws no WebGL 2');
  return context;
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.stale = true;
    this.level = 0;  // of sharpness that moving pictures are drawn with
    this.pace = 0;  // seconds a moving picture, averaged
    this.renderer = new THREE.WebGLRenderer({ canvas, context: opaqueContext(canvas) });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // as is, see light.js
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xeef3f5);
    this.scene.fog = new THREE.Fog(0xeef3f5, 6, 16);
    this.camera = new THREE.PerspectiveCamera(36, 1, 0.05, 60);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(0.7, -2.9, 1.15);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0.25, 0, 0.3);
    this.controls.maxPolarAngle = 1.62;
    addLights(this.scene);
    this.ray = new THREE.Raycaster();
    this.ray.params.Line.threshold = 0.01;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    this.renderer.setSize(width, height, false);
    this.stale = true;
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
  }

  // Moves camera and target along with the robot.
  follow(x, y) {
    const dx = x + 0.2 - this.controls.target.x;
    const dy = y - this.controls.target.y;
    this.controls.target.x += dx;
    this.controls.target.y += dy;
    this.camera.position.x += dx;
    this.camera.position.y += dy;
  }

  // Draws what has changed: sharp when it stands still, else as sharp as keeps thirty pictures a second.
  // @param seconds since this was last asked for
  // @param moving whether the scene has changed
  // @return whether there was anything to draw
  draw(seconds, moving) {
    const turned = this.controls.update();
    const still = !moving && !turned;
    if (still && !this.stale) return false;
    if (!still) this.keepPace(seconds);
    const ratio = kSharpness[still ? 0 : this.level] * Math.min(window.devicePixelRatio, 2);
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    this.renderer.render(this.scene, this.camera);
    this.stale = !still;  // once more, sharp, when it has come to rest
    return true;
  }

  keepPace(seconds) {
    if (seconds > 1) return;  // the page was hidden
    this.pace = 0.8 * this.pace + 0.2 * seconds;
    if (this.pace < kSlowPicture || this.level + 1 === kSharpness.length) return;
    this.level += 1;
    this.pace = 0;
  }

  // What lies under a place on the canvas, nearest first.
  hits(event, objects) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.ray.setFromCamera(at, this.camera);
    return this.ray.intersectObjects(objects, false);
  }
}
