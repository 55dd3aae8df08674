// The page's index and data as numbers again; their form: tasks/share/web_page.h, columns.h, mesh_table.h.

const kAbsent = 65535;

async function unpacked(text) {
  if (!window.DecompressionStream) throw new Error("This browser has no DecompressionStream.");
  try {
    const bytes = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error("The page's data is cut off or damaged: get the file again.");
  }
}

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer);
    this.at = 0;
  }

  float() {
    this.at += 4;
    return this.view.getFloat32(this.at - 4, true);
  }

  // A column of `length` values, absent ones as NaN.
  column(length) {
    const values = new Float32Array(length);
    const low = this.float(), step = this.float();
    if (!(step > 0)) return values.fill(low);
    for (let i = 0, code = 0; i < length; ++i) {
      code = (code + this.bytes[this.at + i] + 256 * this.bytes[this.at + length + i]) % 65536;
      values[i] = code === kAbsent ? NaN : low + step * code;
    }
    this.at += 2 * length;
    return values;
  }

  columns(count, length) {
    return Array.from({ length: count }, () => this.column(length));
  }

  indices(length) {
    const values = new Uint32Array(length);
    for (let i = 0, index = 0; i < length; ++i) {
      for (let plane = 0; plane < 4; ++plane) index += this.bytes[this.at + plane * length + i] * 256 ** plane;
      index %= 2 ** 32;
      values[i] = index;
    }
    this.at += 4 * length;
    return values;
  }
}

function interleaved(columns) {
  const values = new Float32Array(3 * columns[0].length);
  columns.forEach((column, axis) => column.forEach((value, i) => (values[3 * i + axis] = value)));
  return values;
}

function readMesh(reader, { vertices, indices }) {
  const columns = reader.columns(6, vertices);
  return { places: interleaved(columns.slice(0, 3)), normals: interleaved(columns.slice(3)), indices: reader.indices(indices) };
}

function readRecording(reader, recording) {
  const pictures = recording.times.length;
  for (const group of recording.groups) {
    group.matrices = Array.from({ length: group.items }, () => reader.columns(12, pictures));
  }
  for (const chart of recording.charts) chart.values = reader.column(pictures);
  for (const pad of recording.pads) {
    pad.place = reader.columns(2, pictures);
    pad.tactor = reader.columns(2, pictures);
    pad.sliding = reader.column(pictures);
  }
}

export async function readPage() {
  const page = JSON.parse(document.getElementById("pincer-index").textContent);
  const reader = new Reader(await unpacked(document.getElementById("pincer-data").textContent));
  for (const mesh of page.meshes) Object.assign(mesh, readMesh(reader, mesh));
  for (const recording of page.recordings) readRecording(reader, recording);
  if (reader.at !== reader.bytes.length) throw new Error("The page's data doesn't fit its index: the file is damaged.");
  return page;
}

// The picture at or before a time, and how far it is from there to the next, 0 .. 1.
export function placeInTime(times, time) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  if (high <= 0) return { picture: 0, share: 0 };
  if (times[high] <= time) return { picture: high, share: 0 };
  return { picture: low, share: Math.max(0, (time - times[low]) / (times[high] - times[low])) };
}
