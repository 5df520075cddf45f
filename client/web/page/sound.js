// The game sends only names of sounds. Each name is played as a short tune that is computed from it.

const scale = [0, 2, 3, 5, 7, 8, 10, 12, 14, 15];
const waves = ["square", "triangle", "sawtooth", "sine"];

/** Returns a 32-bit hash of a text (FNV-1a). */
function hash(text) {
  let value = 0x811c9dc5;
  for (const ch of text) value = Math.imul(value ^ ch.codePointAt(0), 0x01000193) >>> 0;
  return value;
}

export class Sounds {
  constructor() {
    this.on = localStorage.getItem("naiad.sound") !== "off";
    this.playing = new Map();  // music and repeated sounds, by name
  }

  /** Starts the audio. Call from the handler of a key or click: browsers allow sound only after such an action. */
  wake() {
    if (!this.on) return;
    this.context ??= new AudioContext({latencyHint: "interactive"});
    if (this.context.state === "suspended") this.context.resume().catch(() => {});
  }

  toggle() {
    this.on = !this.on;
    localStorage.setItem("naiad.sound", this.on ? "on" : "off");
    if (this.on) this.wake();
    else this.stopAll();
    return this.on;
  }

  /** `action`: 0 play, 1 pause, 2 stop. `flags`: 1 music, 2 repeat, 4 caused by this player or by none. */
  take(label, action, flags) {
    const name = (flags & 1 ? "music " : "sound ") + label;
    if (action !== 0) return this.stop(name);
    if (!this.on || this.context?.state !== "running") return;
    if (flags & 3) return this.last(name, flags);
    this.tune(name, flags & 4 ? 0.12 : 0.05, this.context.currentTime, 3, 0.07);
  }

  last(name, flags) {
    this.stop(name);
    const step = flags & 1 ? 0.22 : 0.12;
    const notes = flags & 1 ? 16 : 4;
    const entry = {gain: this.context.createGain()};
    entry.gain.connect(this.context.destination);
    const round = () => this.tune(name, flags & 1 ? 0.035 : 0.06, this.context.currentTime, notes, step, entry.gain);
    round();
    if (flags & 2) entry.timer = setInterval(round, notes * step * 1000);
    this.playing.set(name, entry);
    while (this.playing.size > 8) this.stop(this.playing.keys().next().value);
  }

  tune(name, volume, at, notes, step, into = this.context.destination) {
    let bits = hash(name);
    const base = 110 * 2 ** (bits % 3);
    const wave = waves[bits >>> 4 & 3];
    for (let i = 0; i < notes; ++i) {
      bits = Math.imul(bits ^ bits >>> 15, 0x2c1b3c6d) >>> 0;
      const tone = this.context.createOscillator();
      const gain = this.context.createGain();
      tone.type = wave;
      tone.frequency.value = base * 2 ** (scale[bits % scale.length] / 12);
      gain.gain.setValueAtTime(volume, at + i * step);
      gain.gain.exponentialRampToValueAtTime(0.001, at + (i + 1) * step);
      tone.connect(gain).connect(into);
      tone.start(at + i * step);
      tone.stop(at + (i + 1) * step);
    }
  }

  stop(name) {
    const entry = this.playing.get(name);
    if (entry === undefined) return;
    clearInterval(entry.timer);
    entry.gain.disconnect();
    this.playing.delete(name);
  }

  stopAll() {
    for (const name of [...this.playing.keys()]) this.stop(name);
  }
}
