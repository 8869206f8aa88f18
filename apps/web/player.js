// Time: the slider, playing, and keeping up with a run that is on.
import { drawStrip } from './charts.js';

const get = (id) => document.getElementById(id);

export class Player {
  constructor(feed) {
    this.feed = feed;
    this.time = 0;
    this.playing = false;
    this.live = feed.live;
    this.strip = { frames: -1, width: -1 };
    get('live').hidden = !feed.live;
    get('slider').addEventListener('input', (event) => {
      this.live = false;
      this.playing = false;
      this.time = Number(event.target.value);
    });
    get('play').addEventListener('click', () => this.toggle());
    get('live').addEventListener('click', () => { this.live = true; });
    document.addEventListener('keydown', (event) => {
      if (event.code !== 'Space' || event.target.closest('button, input, select')) return;
      event.preventDefault();
      this.toggle();
    });
  }

  toggle() {
    this.live = false;
    this.playing = !this.playing;
    if (this.playing && this.time >= this.feed.end - 1e-3) this.time = this.feed.begin;
  }

  // @param seconds since the last picture
  advance(seconds) {
    const { feed } = this;
    if (this.live) {
      // A little behind the newest frame, so that there always is a next one to move to.
      const aim = feed.end - (feed.live ? 0.1 : 0);
      const behind = aim - this.time;
      this.time = behind > 0.5 || behind < 0 ? aim : this.time + Math.min(behind, seconds * (1 + behind));
      if (!feed.live) this.live = false;
    } else if (this.playing) {
      this.time += Math.min(0.1, seconds) * Number(get('speed').value);
      if (this.time >= feed.end) {
        this.time = feed.end;
        this.playing = false;
      }
    }
    this.time = Math.max(feed.begin, Math.min(feed.end, this.time));
    this.show();
  }

  show() {
    const slider = get('slider');
    slider.min = this.feed.begin;
    slider.max = this.feed.end;
    slider.value = this.time;
    get('clock').textContent = `${this.time.toFixed(2)} s`;
    get('play').textContent = this.playing ? '❚❚' : '▶';
    get('live').hidden = !this.feed.live || this.live;
    const width = get('strip').clientWidth;
    if (this.strip.frames !== this.feed.frames.length || this.strip.width !== width) {
      this.strip = { frames: this.feed.frames.length, width };
      drawStrip(get('strip'), this.feed);
    }
  }
}
