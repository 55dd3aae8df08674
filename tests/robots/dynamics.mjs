// M and C (gravity in it) of a robot of hinges and slides in poses that nobody chose, as MuJoCo has them, as JSON: node dynamics.mjs MODULE robot.xml
// {"file", "joints": [names], "poses": [{"q", "v", "M": [rows], "C"}]}.
import {load} from './model.mjs';

const [module, file] = process.argv.slice(2);
const {mujoco, model, data, nameAt} = await load(module, file);
const n = model.nv;
if (model.nq !== n) throw new Error(`${file}: has balls or free joints`);

const kJointEquality = 2;  // mjEQ_JOINT

let seed = 1;  // Park and Miller's generator
function uniform() {
  seed = (seed * 48271) % 2147483647;
  return seed / 2147483647;
}
function pose(k) {
  const q = [], v = [];
  for (let j = 0; j < n; ++j) {
    const [low, high] = model.jnt_range.slice(2 * j, 2 * j + 2);
    q.push(k === 0 ? model.qpos0[j] : low < high ? low + (high - low) * uniform() : 2 * uniform() - 1);
    v.push(k === 0 ? 0 : 6 * uniform() - 3);
  }
  for (let e = 0; e < model.neq; ++e) {  // what follows another joint
    if (model.eq_type[e] !== kJointEquality || model.eq_obj2id[e] < 0) continue;
    const c = model.eq_data.slice(11 * e, 11 * e + 5), follower = model.eq_obj1id[e], leader = model.eq_obj2id[e];
    const z = q[leader] - model.qpos0[leader];
    q[follower] = model.qpos0[follower] + c.reduce((sum, factor, k) => sum + factor * z ** k, 0);
    v[follower] = v[leader] * c.reduce((sum, factor, k) => sum + (k > 0 ? k * factor * z ** (k - 1) : 0), 0);
  }
  for (let j = 0; j < n; ++j) data.qpos[j] = q[j], data.qvel[j] = v[j];
  mujoco.mj_forward(model, data);
  const M = new mujoco.DoubleBuffer(n * n);
  mujoco.mj_fullM(model, data, M);
  const full = [...M.GetView()], rows = [];
  for (let j = 0; j < n; ++j) rows.push(full.slice(n * j, n * (j + 1)));
  return {q, v, M: rows, C: [...data.qfrc_bias]};
}
const joints = [];
for (let j = 0; j < n; ++j) joints.push(nameAt(model.name_jntadr[j]));
console.log(JSON.stringify({file, joints, poses: [...Array(20).keys()].map(pose)}));
