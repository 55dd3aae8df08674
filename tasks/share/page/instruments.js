// Fingerpads and charts, drawn on plain canvases.

const kInks = ["#1d6fd1", "#d8741a", "#2b9348", "#9b3fb5", "#a88600", "#2a9d9d"];
const kChartHeight = 84, kPadSide = 136;

function sized(canvas, height) {
  const ratio = Math.min(window.devicePixelRatio, 2), width = canvas.clientWidth;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  canvas.style.height = `${height}px`;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

const rounded = (value) => (Number.isFinite(value) ? Number(value.toPrecision(3)).toString() : "–");

// Lines of one unit and family: "force on left" and "force on right", "cube.p_x" .. "cube.p_z".
function familyOf({ name, unit }) {
  const force = name.startsWith("force on ");
  const dot = name.lastIndexOf(".");
  return `${force ? "force on" : dot > 0 ? name.slice(0, dot) : name}|${unit}`;
}

export class Charts {
  constructor(box, recording, jump) {
    this.times = recording.times;
    const families = Map.groupBy ? Map.groupBy(recording.charts, familyOf) : grouped(recording.charts, familyOf);
    box.replaceChildren();
    this.charts = [...families.values()].map((lines) => this.add(box, lines, jump));
  }

  add(box, lines, jump) {
    const element = document.createElement("div"), head = document.createElement("div"), canvas = document.createElement("canvas");
    element.className = "chart";
    head.className = "chart-head";
    element.append(head, canvas);
    box.append(element);
    const seek = (event) => {
      const bounds = canvas.getBoundingClientRect();
      const share = Math.min(Math.max((event.clientX - bounds.left) / bounds.width, 0), 1);
      jump(this.times[0] + share * (this.times.at(-1) - this.times[0]));
    };
    canvas.addEventListener("pointerdown", (event) => (canvas.setPointerCapture(event.pointerId), seek(event)));
    canvas.addEventListener("pointermove", (event) => event.buttons && seek(event));
    const labels = lines.map((line, i) => {
      const label = document.createElement("span"), value = document.createElement("b");
      label.style.color = kInks[i % kInks.length];
      label.append(`${line.name} `, value, ` ${line.unit}\u2002`);
      head.append(label);
      return value;
    });
    let low = Infinity, high = -Infinity;
    for (const { values } of lines) for (const value of values) if (value === value) { low = Math.min(low, value); high = Math.max(high, value); }
    if (!(low <= high)) low = high = 0;
    const margin = high > low ? 0.06 * (high - low) : Math.max(Math.abs(high), 1) * 0.5;
    return { canvas, lines, labels, low: low - margin, high: high + margin };
  }

  draw(time, picture) {
    const begin = this.times[0], span = Math.max(this.times.at(-1) - begin, 1e-12);
    for (const { canvas, lines, labels, low, high } of this.charts) {
      const { pen, width, height } = sized(canvas, kChartHeight);
      const x = (t) => (t - begin) / span * width, y = (v) => (high - v) / (high - low) * height;
      pen.strokeStyle = "#8884";
      pen.strokeRect(0.5, 0.5, width - 1, height - 1);
      if (low < 0 && high > 0) pen.strokeRect(0, y(0), width, 0);
      lines.forEach(({ values }, i) => {
        pen.strokeStyle = kInks[i % kInks.length];
        pen.lineWidth = 1.4;
        pen.beginPath();
        let down = false;
        values.forEach((value, k) => {
          if (Number.isNaN(value)) down = false;
          else if (down) pen.lineTo(x(this.times[k]), y(value));
          else { pen.moveTo(x(this.times[k]), y(value)); down = true; }
        });
        pen.stroke();
        labels[i].textContent = rounded(values[picture]);
      });
      pen.fillStyle = "#d11";
      pen.fillRect(x(time) - 0.75, 0, 1.5, height);
      pen.fillStyle = "#888";
      pen.font = "10px system-ui, sans-serif";
      pen.fillText(rounded(high), 3, 11);
      pen.fillText(rounded(low), 3, height - 3);
    }
  }
}

function grouped(list, keyOf) {
  const groups = new Map();
  for (const item of list) groups.set(keyOf(item), [...(groups.get(keyOf(item)) ?? []), item]);
  return groups;
}

export class Pads {
  constructor(box, recording) {
    box.replaceChildren();
    this.pads = recording.pads.filter((pad) => pad.display || pad.place[0].some((value) => value === value)).map((pad) => {
      const figure = document.createElement("figure"), canvas = document.createElement("canvas"), text = document.createElement("figcaption");
      text.textContent = pad.finger;
      figure.append(text, canvas);
      box.append(figure);
      return { pad, canvas };
    });
  }

  // The pad seen from outside, as one looks at one's own finger: its end up.
  draw(picture) {
    for (const { pad, canvas } of this.pads) {
      const { pen, width, height } = sized(canvas, kPadSide), r = 0.48 * Math.min(width, height), scale = 0.96 * r / pad.reach;
      const middle = [width / 2, height / 2];
      pen.fillStyle = "#deaa94";
      pen.beginPath();
      pen.arc(...middle, r, Math.PI, 0);
      pen.lineTo(middle[0] + r, height);
      pen.lineTo(middle[0] - r, height);
      pen.fill();
      disc(pen, middle, 0.75 * r, "#cd8270");
      const at = ([distal, radial]) => [middle[0] + scale * radial[picture], middle[1] - scale * distal[picture]];
      if (pad.tactor[0][picture] === pad.tactor[0][picture]) disc(pen, at(pad.tactor), 8, "#14181e");
      if (pad.place[0][picture] === pad.place[0][picture]) disc(pen, at(pad.place), 5, pad.sliding[picture] > 0.5 ? "#e5200b" : "#0d8f3c", "#fff");
    }
  }
}

function disc(pen, [x, y], radius, ink, border) {
  pen.fillStyle = ink;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fill();
  if (!border) return;
  pen.strokeStyle = border;
  pen.lineWidth = 1.5;
  pen.stroke();
}
