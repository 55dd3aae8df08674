// What MuJoCo (npm's @mujoco/mujoco) makes of a scene of grasps.py, as JSON: node held.mjs MODULE SCENE.json TICK IMPRATIO SECONDS
// {"rows": [[time, x, y, z]] of the thing [s, m], "deepest": its deepest overlap with the hand at the end [m], "seconds": time taken}.
import fs from 'node:fs';
import {load} from './model.mjs';

const [module, scene_file, tick, impratio, seconds] = process.argv.slice(2);
const scene = JSON.parse(fs.readFileSync(scene_file));
const [thing, plate] = scene.bodies, robot = scene.robots[0];

function quaternion(turn = [0, 0, 0]) {
  const angle = Math.hypot(...turn), s = angle === 0 ? 0 : Math.sin(angle / 2) / angle;
  return [Math.cos(angle / 2), ...turn.map((x) => x * s)].join(' ');
}
const volume = ({type, size, radius, length}) => (type === 'box' ? size.reduce((a, b) => a * b) : Math.PI * radius ** 2 * length);
function geom(part, mass) {
  const {type, size, radius, length} = part.shape;
  const sizes = type === 'box' ? size.map((x) => x / 2) : [radius, length / 2];
  return `<geom type="${type}" size="${sizes.join(' ')}" pos="${(part.position ?? [0, 0, 0]).join(' ')}" quat="${quaternion(part.rotation)}"
    friction="${part.material?.mu_s ?? 1} 0 0" condim="3" mass="${mass}"/>`;
}
// MuJoCo has hulls of meshes only: the L is two boxes there.
const kL = [{shape: {type: 'box', size: [0.04, 0.02, 0.04]}, position: [0, -0.01, 0]}, {shape: {type: 'box', size: [0.02, 0.02, 0.04]}, position: [-0.01, 0.01, 0]}];

function withThing(xml) {
  const parts = thing.shapes ?? (thing.shape.type === 'mesh' ? kL.map((p) => ({...p, material: thing.material})) : [{shape: thing.shape, material: thing.material}]);
  const whole = parts.reduce((sum, part) => sum + volume(part.shape), 0);
  const geoms = parts.map((part) => geom(part, (thing.mass * volume(part.shape)) / whole)).join('\n');
  const begin = `<worldbody><frame pos="${robot.position.join(' ')}" quat="${quaternion(robot.rotation)}">`;
  const end = `</frame><body name="thing" pos="${thing.position.join(' ')}" quat="${quaternion(thing.rotation)}"><freejoint/>${geoms}</body>
    <body name="plate" mocap="true" pos="${plate.trajectory.keyframes[0].position.join(' ')}">${geom({shape: plate.shape}, 1)}</body></worldbody>`;
  const last = xml.lastIndexOf('</worldbody>');
  return (xml.slice(0, last).replace('<worldbody>', begin) + end + xml.slice(last + '</worldbody>'.length))
    .replace(/<keyframe>[\s\S]*?<\/keyframe>/g, '')
    .replace(/<\/mujoco>\s*$/, `<option timestep="${tick}" cone="elliptic" impratio="${impratio}" integrator="implicitfast" iterations="100" tolerance="1e-12"/></mujoco>`);
}

const {mujoco, model, data, nameAt} = await load(module, robot.file, withThing);
function numbered(count, addresses, name) {
  for (let i = 0; i < count; ++i) if (nameAt(addresses[i]) === name) return i;
  throw new Error(`no ${name}`);
}
function at(time, keyframes, key) {
  const after = keyframes.findIndex((k) => k.time > time);
  if (after <= 0) return (after === 0 ? keyframes[0] : keyframes[keyframes.length - 1])[key];
  const a = keyframes[after - 1], b = keyframes[after], w = (time - a.time) / (b.time - a.time);
  return Array.isArray(a[key]) ? a[key].map((x, i) => x + w * (b[key][i] - x)) : a[key] + w * (b[key] - a[key]);
}

for (const [name, q] of Object.entries(robot.start)) data.qpos[model.jnt_qposadr[numbered(model.njnt, model.name_jntadr, name)]] = q;
const drives = Object.entries(robot.drives).map(([name, told]) => [numbered(model.nu, model.name_actuatoradr, name), told.keyframes]);
const body = numbered(model.nbody, model.name_bodyadr, 'thing'), q = model.jnt_qposadr[model.body_jntadr[body]];
const rows = [], every = Math.round(0.25 / tick), began = process.cpuUsage().user;
for (let n = 0; n <= Math.round(seconds / tick); ++n) {
  const time = n * tick;
  if (n % every === 0) rows.push([time, ...data.qpos.slice(q, q + 3)]);
  for (const [drive, keyframes] of drives) data.ctrl[drive] = at(time, keyframes, 'value');
  const place = at(time, plate.trajectory.keyframes, 'position');
  for (let i = 0; i < 3; ++i) data.mocap_pos[i] = place[i];
  mujoco.mj_step(model, data);
}
const taken = (process.cpuUsage().user - began) / 1e6;
let deepest = 0;
for (let c = 0; c < data.ncon; ++c) {
  const contact = data.contact.get(c);
  const touches = [contact.geom1, contact.geom2].some((g) => model.geom_bodyid[g] === body);
  if (touches) deepest = Math.min(deepest, contact.dist);
}
console.log(JSON.stringify({rows, deepest: -deepest, seconds: taken}));
