// Camera, light and the picture.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: window.devicePixelRatio < 2, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xeef3f5);
    this.scene.fog = new THREE.Fog(0xeef3f5, 6, 16);
    this.camera = new THREE.PerspectiveCamera(36, 1, 0.05, 60);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(0.7, -2.9, 1.15);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0.25, 0, 0.3);
    this.controls.maxPolarAngle = 1.62;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa8ad, 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-2, -3, 5);
    this.scene.add(sun);
    this.ray = new THREE.Raycaster();
    this.ray.params.Line.threshold = 0.01;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
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

  draw() {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }

  // What lies under a place on the canvas, nearest first.
  hits(event, objects) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.ray.setFromCamera(at, this.camera);
    return this.ray.intersectObjects(objects, false);
  }
}
