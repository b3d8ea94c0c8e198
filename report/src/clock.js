// One time for the whole page: plots, polar plots and playback show it.

const listeners = new Set();

export const clock = {
  begin: 0,
  end: 1,
  time: 0,
  /** [-] simulated over real time. */
  speed: 0.01,
  playing: false,

  span(begin, end) {
    this.begin = begin;
    this.end = end;
    this.time = begin;
  },

  seek(time) {
    const inside = Math.min(Math.max(time, this.begin), this.end);
    if (inside === this.time) return;
    this.time = inside;
    tell();
  },

  play() {
    if (this.playing) return;
    if (this.time >= this.end) this.time = this.begin;
    this.playing = true;
    last = performance.now();
    tell();
    requestAnimationFrame(tick);
  },

  pause() {
    this.playing = false;
    tell();
  },

  toggle() {
    if (this.playing) this.pause(); else this.play();
  },

  /** Calls a function at every change, and now. */
  follow(listener) {
    listeners.add(listener);
    listener(this);
  },
};

let last = 0;

function tick(now) {
  if (!clock.playing) return;
  // A page that was hidden goes on where it was.
  const passed = Math.min((now - last) * 1e-3, 0.1);
  last = now;
  clock.time += passed * clock.speed;
  // Around and around.
  if (clock.time >= clock.end) clock.time = clock.begin;
  tell();
  requestAnimationFrame(tick);
}

function tell() {
  for (const listener of listeners) listener(clock);
}
