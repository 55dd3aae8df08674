// The page that computes: a session of play_module, drawn by the stage of `pincer share`, led by pointer, wheel and keys.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import { native } from "./native.js";
import pincerModule from "./play_module.js";
import { ball, dish, floor } from "./solids.js";
import { Stage } from "./stage_three.js";

const kTick = 1e-3;    // [s]
const kMostTicks = 50; // of one picture: a page that was hidden doesn't run after the time
const kScenes = {
  pickup: {
    number: 0, ground: "dish", target: [0, 0, 0.04],
    hint: "Move: the hand. Hold the button (or space): the fingers close. Shift: towards you and away.",
  },
  pinch: {
    number: 1, ground: "floor", target: [0, 0, 0.09],
    hint: "Hold the button on the ball and pull: it stays until friction can't hold it. Less grip, less friction.",
  },
};

const look = (mesh, layer, colour, more = {}) =>
  ({ mesh, layer, part: mesh, colour, alpha: 1, gloss: 0.4, glow: 0, octants: 0, fade: 0, items: 1, matrices: [], ...more });
const kMeshes = ["dish", "floor", "ball", "tip"];
const kItem = 12;  // numbers of a thing's frame
// In the order of the session's things: the ground, the ball, two fingertips.
const recordingOf = ({ ground, target }) => {
  const groups = [
    look(kMeshes.indexOf(ground), ground === "floor" ? "ground" : "solid", [0.62, 0.66, 0.72], { gloss: 0.1, fade: ground === "floor" ? 0.8 : 0 }),
    look(2, "solid", [0.85, 0.45, 0.2], { octants: 0.12 }),
    look(3, "solid", [0.89, 0.68, 0.56]),
    look(3, "solid", [0.89, 0.68, 0.56]),
  ];
  for (const group of groups) group.matrices = [Array.from({ length: kItem }, () => new Float64Array(1))];
  return { groups, camera: { target, eye: [0.02, -0.38, target[2] + 0.22], opening: 0.5, radius: 0.2 } };
};

const at = (id) => document.getElementById(id);

class Play {
  constructor(module) {
    this.module = module;
    this.stage = new Stage(at("picture"), { meshes: [dish(0.15, 0.11), floor(1), ball(0.02), ball(0.008)] });
    this.wish = { p: new Vector3(0, 0, 0.05), squeezes: false };
    this.ray = new Raycaster();
    this.listen();
    this.open();
    this.stage.controls.enabled = false;
    this.compare();
    requestAnimationFrame((now) => this.picture(now));
  }

  open() {
    const scene = kScenes[at("scene").value];
    this.module._playOpen(scene.number);
    this.recording = recordingOf(scene);
    this.stage.show(this.recording);
    this.wish.p.set(...scene.target);
    this.wish.squeezes = false;
    at("hint").textContent = scene.hint;
    this.owed = this.ticks = 0;
    this.last = null;
  }

  listen() {
    const canvas = at("picture");
    canvas.addEventListener("pointermove", (event) => this.point(event));
    canvas.addEventListener("pointerdown", (event) => {
      if (at("turn").checked) return;
      canvas.setPointerCapture(event.pointerId);
      this.point(event);
      this.wish.squeezes = true;
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (this.wish.squeezes = false));
    at("scene").addEventListener("change", () => this.open());
    at("again").addEventListener("click", () => this.open());
    at("turn").addEventListener("change", (event) => (this.stage.controls.enabled = event.target.checked));
    window.addEventListener("keydown", (event) => {
      if (event.code === "Space" && event.target === document.body) (this.wish.squeezes = true), event.preventDefault();
      if (event.code === "KeyR") this.open();
    });
    window.addEventListener("keyup", (event) => event.code === "Space" && (this.wish.squeezes = false));
  }

  // The pointer's place on the upright plane through the hand, or with shift on the level one.
  point(event) {
    if (at("turn").checked) return;
    const box = event.target.getBoundingClientRect();
    const screen = new Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
    this.ray.setFromCamera(screen, this.stage.camera);
    const normal = event.shiftKey ? new Vector3(0, 0, 1) : new Vector3(0, -1, 0);
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, this.wish.p);
    const hit = this.ray.ray.intersectPlane(plane, new Vector3());
    if (hit) this.wish.p.copy(hit);
  }

  picture(now) {
    this.owed += this.last === null ? 0 : (now - this.last) / 1000 / kTick;
    this.last = now;
    const ticks = Math.min(Math.floor(this.owed), kMostTicks);
    this.owed = Math.min(this.owed - ticks, 1);
    this.ticks += ticks;
    const { p, squeezes } = this.wish;
    const begin = performance.now();
    this.module._playTicks(ticks, p.x, p.y, p.z, squeezes ? 1 : 0, Number(at("grip").value));
    this.cost = ticks > 0 ? (performance.now() - begin) / ticks * 1000 : this.cost;
    this.place();
    this.tell();
    requestAnimationFrame((later) => this.picture(later));
  }

  numbers(pointer, count) {
    return this.module.HEAPF64.subarray(pointer / 8, pointer / 8 + count);
  }

  place() {
    const { groups } = this.recording;
    const frames = this.numbers(this.module._playFrames(), kItem * groups.length);
    groups.forEach(({ matrices: [columns] }, item) => columns.forEach((column, k) => (column[0] = frames[kItem * item + k])));
    this.stage.place(0, 0);
    this.stage.draw();
  }

  tell() {
    at("newton").textContent = `${Number(at("grip").value).toFixed(1)} N`;
    const n = this.numbers(this.module._playNumbers(), 8);
    const finger = (i) => `${n[3 * i].toFixed(2)} N pressing, ${n[3 * i + 1].toFixed(2)} N along the skin${n[3 * i + 2] ? ", slides" : ""}`;
    const pull = n[6] > 0 ? `; pull ${n[6].toFixed(2)} N` : "";
    at("numbers").textContent = `left finger ${finger(0)}; right finger ${finger(1)}${pull}; ` +
      `${(this.cost ?? 0).toFixed(0)} us per tick, ${n[7]} ticks flagged`;
  }

  compare() {
    const hex = (scene, half) => this.module._playHash(kScenes[scene].number, half).toString(16).padStart(8, "0");
    const lines = Object.keys(kScenes).map((scene) => {
      const here = hex(scene, 1) + hex(scene, 0);
      return `${scene}: ${here} here, ${native[scene]} natively: ${here === native[scene] ? "the same to the bit" : "NOT THE SAME"}`;
    });
    at("bits").textContent = lines.join("; ");
  }
}

pincerModule()
  .then((module) => (window.play = new Play(module)))
  .catch((error) => {
    const fault = document.createElement("p");
    fault.className = "fault";
    fault.textContent = `This page can't run here: ${error}`;
    at("stage").replaceChildren(fault);
  });
