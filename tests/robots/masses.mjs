// Masses, places and inertias of a robot's bodies as MuJoCo (npm's @mujoco/mujoco) has them, as JSON: node masses.mjs MODULE robot.xml
import fs from 'node:fs';
import path from 'node:path';

const [module, file] = process.argv.slice(2);
const mujoco = await (await import(module)).default();
const folder = path.dirname(file);
function copy(from, to) {
  mujoco.FS.mkdir(to);
  for (const entry of fs.readdirSync(from, {withFileTypes: true})) {
    const inner = path.join(from, entry.name);
    if (entry.isDirectory()) copy(inner, `${to}/${entry.name}`);
    else mujoco.FS.writeFile(`${to}/${entry.name}`, new Uint8Array(fs.readFileSync(inner)));
  }
}
copy(folder, '/robot');
const model = mujoco.MjModel.from_xml_path(`/robot/${path.basename(file)}`);
const data = new mujoco.MjData(model);

function nameAt(address) {
  let end = address;
  while (model.names[end] !== 0) ++end;
  return String.fromCharCode(...model.names.slice(address, end));
}
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
