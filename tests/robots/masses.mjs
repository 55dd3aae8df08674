// Masses, places and inertias of a robot's bodies as MuJoCo (npm's @mujoco/mujoco) has them, as JSON: node masses.mjs MODULE robot.xml
import {load} from './model.mjs';

const [module, file] = process.argv.slice(2);
const {mujoco, model, data, nameAt} = await load(module, file);

function bodies() {
  mujoco.mj_forward(model, data);
  const all = [];
  for (let b = 1; b < model.nbody; ++b) {
    const R = data.ximat.slice(9 * b, 9 * b + 9), I = model.body_inertia.slice(3 * b, 3 * b + 3);
    const entry = (i, j) => [0, 1, 2].reduce((sum, k) => sum + R[3 * i + k] * I[k] * R[3 * j + k], 0);
    all.push({
      name: nameAt(model.name_bodyadr[b]), mass: model.body_mass[b], center: [...data.xipos.slice(3 * b, 3 * b + 3)],
      moments: [entry(0, 0), entry(1, 1), entry(2, 2)], products: [entry(0, 1), entry(0, 2), entry(1, 2)],
      position: [...data.xpos.slice(3 * b, 3 * b + 3)], quaternion: [...data.xquat.slice(4 * b, 4 * b + 4)],
    });
  }
  return all;
}
mujoco.mj_resetData(model, data);
const drawn = bodies(), keyframes = [];
for (let k = 0; k < model.nkey; ++k) {
  mujoco.mj_resetDataKeyframe(model, data, k);
  keyframes.push({name: nameAt(model.name_keyadr[k]), bodies: bodies()});
}
console.log(JSON.stringify({bodies: drawn, keyframes}));
