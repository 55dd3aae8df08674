// The page: a clock, what shows it, and what a person does to it.
import { placeInTime, readPage } from "./data.js";
import { Charts, Pads } from "./instruments.js";
import { Stage } from "./stage_three.js";

const kSpeeds = [0.01, 0.03, 0.1, 0.25, 0.5, 1, 2, 4];
const kShortest = 1.5;  // that a recording should last on the screen, else it is slowed down [s]
const kPartNames = { contact: "contacts", force: "forces", cone: "friction cones", joint: "joints", device: "devices", goal: "goals" };
const of = (id) => document.getElementById(id);

class Replay {
  constructor(page) {
    this.page = page;
    this.stage = new Stage(of("picture"), page);
    this.playing = false;
    this.listen();
    this.furnish();
    this.obeyAddress();
    requestAnimationFrame((now) => this.turn(now));
  }

  furnish() {
    of("title").textContent = this.page.title;
    for (const speed of kSpeeds) of("speed").add(new Option(`${speed} ×`, speed));
    this.page.recordings.forEach((recording, i) => of("recording").add(new Option(recording.title, i)));
    document.querySelector(".only-many").hidden = this.page.recordings.length < 2;
    for (const line of [...this.page.notes, `Made by ${this.page.made_by}.`]) {
      const paragraph = document.createElement("p");
      paragraph.textContent = line;
      of("about").append(paragraph);
    }
  }

  // #t=1.5&shown=2; with &bare nothing but the picture, for a frame in another page
  obeyAddress() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    document.body.classList.toggle("bare", wanted.has("bare"));
    const shown = Math.min(Math.max(Number(wanted.get("shown") ?? 1), 1), this.page.recordings.length);
    this.show(shown - 1);
    if (wanted.has("t")) this.jump(Number(wanted.get("t")));
  }

  show(index) {
    this.recording = this.page.recordings[index];
    of("recording").value = index;
    const { times, groups } = this.recording;
    this.begin = times[0];
    this.end = times.at(-1);
    this.stage.show(this.recording);
    this.charts = new Charts(of("charts"), this.recording, (time) => this.jump(time));
    this.pads = new Pads(of("pads"), this.recording);
    this.offerParts(new Set(groups.map((group) => group.part)));
    Object.assign(of("scrub"), { min: this.begin, max: this.end });
    of("speed").value = kSpeeds.findLast((speed) => speed <= 1 && (this.end - this.begin) / speed >= kShortest) ?? kSpeeds[0];
    this.time = this.begin;
    this.stale = true;
  }

  offerParts(there) {
    of("parts").replaceChildren(...Object.entries(kPartNames).filter(([part]) => there.has(part)).map(([part, name]) => {
      const label = document.createElement("label"), box = document.createElement("input");
      Object.assign(box, { type: "checkbox", checked: !this.stage.hidden.has(part) });
      box.addEventListener("change", () => {
        if (box.checked) this.stage.hidden.delete(part);
        else this.stage.hidden.add(part);
        this.stale = true;
      });
      label.append(box, name);
      return label;
    }));
  }

  listen() {
    of("play").addEventListener("click", () => this.play(!this.playing));
    of("scrub").addEventListener("input", () => this.jump(of("scrub").valueAsNumber));
    of("recording").addEventListener("change", () => this.show(Number(of("recording").value)));
    this.stage.controls.addEventListener("change", () => (this.stale = true));
    window.addEventListener("resize", () => (this.stale = true));
    window.addEventListener("hashchange", () => this.obeyAddress());
    window.addEventListener("keydown", (event) => {
      if (event.target.tagName === "SELECT" || event.target.tagName === "BUTTON") return;
      if (event.code === "Space") this.play(!this.playing);
      else if (event.code === "ArrowRight") this.step(1);
      else if (event.code === "ArrowLeft") this.step(-1);
      else if (event.code === "Home") this.jump(this.begin);
      else if (event.code === "End") this.jump(this.end);
      else return;
      event.preventDefault();
    });
  }

  play(playing) {
    this.playing = playing;
    if (playing && this.time >= this.end) this.time = this.begin;
    this.stale = true;
  }

  jump(time) {
    if (!Number.isFinite(time)) return;
    this.time = Math.min(Math.max(time, this.begin), this.end);
    this.stale = true;
  }

  step(pictures) {
    this.play(false);
    const { times } = this.recording, here = placeInTime(times, this.time).picture;
    this.jump(times[Math.min(Math.max(here + pictures, 0), times.length - 1)]);
  }

  turn(now) {
    const passed = Math.min((now - (this.last ?? now)) / 1000, 0.1);
    this.last = now;
    if (this.playing) {
      this.jump(this.time + passed * Number(of("speed").value));
      if (this.time >= this.end) this.play(false);
    }
    if (this.stale) this.draw();
    requestAnimationFrame((next) => this.turn(next));
  }

  draw() {
    this.stale = false;
    const { picture, share } = placeInTime(this.recording.times, this.time);
    this.stage.place(picture, share);
    this.stage.draw();
    this.charts.draw(this.time, picture);
    this.pads.draw(picture);
    of("play").textContent = this.playing ? "Pause" : "Play";
    of("scrub").value = this.time;
    of("clock").textContent = `${this.time.toFixed(3)} s of ${this.end.toFixed(2)}`;
    of("caption").textContent = this.recording.captions.findLast((caption) => caption.picture <= picture)?.text ?? "";
  }
}

// Says on the page why there is nothing to see.
function tell(error) {
  const fault = document.createElement("p");
  fault.className = "fault";
  fault.textContent = `This replay can't be shown here: ${error.message} A browser of 2023 or later with WebGL 2 is needed.`;
  of("stage").append(fault);
  console.error(error);
}

window.addEventListener("DOMContentLoaded", () => readPage().then((page) => new Replay(page)).catch(tell));
