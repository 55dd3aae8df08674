// A robot's model by MuJoCo (npm's @mujoco/mujoco), with the files of its folder: load(module, file) gives {mujoco, model, data, nameAt}.
// `change`, where it is given, takes the file's text and gives that of the model.
import fs from 'node:fs';
import path from 'node:path';

export async function load(module, file, change = (text) => text) {
  const mujoco = await (await import(module)).default();
  function copy(from, to) {
    mujoco.FS.mkdir(to);
    for (const entry of fs.readdirSync(from, {withFileTypes: true})) {
      const inner = path.join(from, entry.name);
      if (entry.isDirectory()) copy(inner, `${to}/${entry.name}`);
      else mujoco.FS.writeFile(`${to}/${entry.name}`, new Uint8Array(fs.readFileSync(inner)));
    }
  }
  copy(path.dirname(file), '/robot');
  mujoco.FS.writeFile(`/robot/${path.basename(file)}`, new TextEncoder().encode(change(fs.readFileSync(file, 'utf8'))));
  const model = mujoco.MjModel.from_xml_path(`/robot/${path.basename(file)}`);
  const nameAt = (address) => {
    let end = address;
    while (model.names[end] !== 0) ++end;
    return String.fromCharCode(...model.names.slice(address, end));
  };
  return {mujoco, model, data: new mujoco.MjData(model), nameAt};
}
