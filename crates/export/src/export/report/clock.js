// @ts-check
// The time that the mechanism and all plots show.

export class Clock {
  /** @param {number} duration @param {number} [first] */
  constructor(duration, first = 0) {
    this.duration = duration;
    this.first = first;
    this.time = first;
    this.playing = false;
    this.speed = 1;
    /** @type {(() => void)[]} */
    this.listeners = [];
    this.last = 0;
  }

  /** @param {() => void} listener */
  listen(listener) {
    this.listeners.push(listener);
  }

  changed() {
    this.listeners.forEach((listener) => listener());
  }

  /** @param {number} time */
  seek(time) {
    this.time = Math.max(this.first, Math.min(this.duration, time));
    this.changed();
  }

  /** By a share of the run. @param {number} share */
  step(share) {
    this.pause();
    this.seek(this.time + share * this.duration);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  play() {
    if (this.playing || this.duration <= this.first) return;
    if (this.time >= this.duration) this.time = this.first;
    this.playing = true;
    this.last = 0;
    this.changed();
    const tick = (/** @type {number} */ now) => {
      if (!this.playing) return;
      const passed = this.last ? (now - this.last) / 1000 : 0;
      this.last = now;
      const next = this.time + Math.min(passed, 0.25) * this.speed;
      this.seek(next > this.duration ? next - this.duration : next);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
