// The scene in three dimensions, by three.js: each group of things is one instanced mesh; marks show faintly through what hides them.
import {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, GreaterDepth, HemisphereLight, InstancedMesh, Matrix4,
  MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const kFaint = 0.25;  // of a mark behind something
const kSky = 0xe9ecf1;

function geometryOf(mesh) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(mesh.places, 3));
  geometry.setAttribute("normal", new BufferAttribute(mesh.normals, 3));
  geometry.setIndex(new BufferAttribute(mesh.indices, 1));
  return geometry;
}

// Additions to three.js's own material: a ball's octants in two shades, so that it is seen to turn; a ground that fades out.
function withOctantsAndFade(material, { octants, fade }) {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.octants = { value: octants };
    shader.uniforms.fade = { value: fade };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec3 p_M; varying vec3 p_W;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\np_M = position; p_W = (instanceMatrix * vec4(position, 1.0)).xyz;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec3 p_M; varying vec3 p_W; uniform float octants; uniform float fade;")
      .replace("#include <color_fragment>", `#include <color_fragment>
        diffuseColor.rgb *= 1.0 + octants * sign(p_M.x * p_M.y * p_M.z);
        if (fade > 0.0) diffuseColor.a *= 1.0 - smoothstep(0.45 * fade, fade, length(p_W.xy));`);
  };
  material.customProgramCacheKey = () => "pincer";
  return material;
}

function materialOf(look, behind) {
  const colour = new Color().setRGB(...look.colour);
  const alpha = look.alpha * (behind ? kFaint : 1);
  const material = new MeshStandardMaterial({
    color: colour.clone().multiplyScalar(1 - look.glow),
    emissive: colour.clone().multiplyScalar(look.glow),
    roughness: 1 - 0.7 * look.gloss,
    metalness: 0,
    side: DoubleSide,
    transparent: alpha < 1 || look.fade > 0,
    opacity: alpha,
    depthWrite: alpha === 1,
  });
  if (behind) material.depthFunc = GreaterDepth;
  return withOctantsAndFade(material, look);
}

function meshesOf(look, geometry) {
  const meshes = [new InstancedMesh(geometry, materialOf(look, false), Math.max(look.items, 1))];
  if (look.layer === "mark") meshes.push(new InstancedMesh(geometry, materialOf(look, true), Math.max(look.items, 1)));
  for (const mesh of meshes) {
    mesh.frustumCulled = false;
    mesh.castShadow = look.layer === "solid";
    mesh.receiveShadow = look.layer !== "mark";
    mesh.renderOrder = look.layer === "mark" ? 2 : look.layer === "ground" ? 0 : 1;
  }
  return meshes;
}

// A place, a turn and a size. What spins by a radian from one picture to the next keeps its size in between: entries of
// matrices that are averaged would shrink it.
class Placing {
  matrix = new Matrix4();
  p = new Vector3();
  q = new Quaternion();
  size = new Vector3();

  read(columns, picture) {
    const at = (k) => columns[k][picture];
    this.matrix.set(at(0), at(3), at(6), at(9), at(1), at(4), at(7), at(10), at(2), at(5), at(8), at(11), 0, 0, 0, 1);
    return this;
  }

  // The matrix of this one and `next`, `share` of the way between them. What has no size in some direction has no turn.
  towards(next, share) {
    if (this.matrix.determinant() === 0 || next.matrix.determinant() === 0) return this.matrix;
    for (const placing of [this, next]) placing.matrix.decompose(placing.p, placing.q, placing.size);
    this.p.lerp(next.p, share);
    this.q.slerp(next.q, share);
    this.size.lerp(next.size, share);
    return this.matrix.compose(this.p, this.q, this.size);
  }
}

export class Stage {
  constructor(canvas, page) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.canvas = canvas;
    this.geometries = page.meshes.map(geometryOf);
    this.camera = new PerspectiveCamera(30, 1, 0.001, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.sun = new DirectionalLight(0xfffaf0, 2.6);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.hidden = new Set();
    this.here = new Placing();
    this.next = new Placing();
  }

  // Puts up a recording's things, its light and its camera.
  show(recording) {
    for (const { meshes } of this.groups ?? []) meshes.forEach((mesh) => (mesh.material.dispose(), mesh.dispose()));
    this.scene = new Scene();
    this.scene.background = new Color(kSky);
    this.groups = recording.groups.map((look) => ({ look, meshes: meshesOf(look, this.geometries[look.mesh]) }));
    for (const { meshes } of this.groups) this.scene.add(...meshes);
    this.light(recording.camera);
    this.look(recording.camera);
  }

  light({ target, radius }) {
    const centre = new Vector3(...target), reach = 2.5 * radius;
    this.sun.position.copy(centre).addScaledVector(new Vector3(-0.35, -0.45, 0.82).normalize(), 4 * reach);
    this.sun.target.position.copy(centre);
    const camera = this.sun.shadow.camera;
    Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: reach, far: 7 * reach });
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.01 * radius;
    this.scene.add(this.sun, this.sun.target, new HemisphereLight(0xdfe6f2, 0x9a948c, 1.5));
    this.scene.children.at(-1).position.set(0, 0, 1);
  }

  look({ target, eye, opening, radius }) {
    this.camera.fov = opening * 180 / Math.PI;
    this.camera.near = 0.02 * radius;
    this.camera.far = 400 * radius;
    this.camera.position.set(...eye);
    this.controls.target.set(...target);
    this.controls.update();
  }

  // Every item where it is, between a picture and the next; `share` 0 .. 1 from one to the other.
  place(picture, share) {
    for (const { look, meshes } of this.groups) {
      let count = 0;
      for (const columns of look.matrices) {
        if (Number.isNaN(columns[0][picture])) continue;
        const goesOn = share > 0 && !Number.isNaN(columns[0][picture + 1] ?? NaN);
        const here = this.here.read(columns, picture);
        const matrix = goesOn ? here.towards(this.next.read(columns, picture + 1), share) : here.matrix;
        for (const mesh of meshes) mesh.setMatrixAt(count, matrix);
        ++count;
      }
      for (const mesh of meshes) {
        mesh.count = count;
        mesh.visible = count > 0 && !this.hidden.has(look.part);
        mesh.instanceMatrix.needsUpdate = true;
      }
    }
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = this.renderer.getPixelRatio();
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / Math.max(height, 1);
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.scene, this.camera);
  }
}
