// The run as the server tells it: frames (rows of numbers, named by columns) and happenings.

export class Feed {
  constructor(about) {
    this.about = about;
    this.live = about.live;
    this.frames = [];
    this.happenings = [];
    this.result = null;
    this.lost = false;
    this.column = Object.fromEntries(about.columns.map((name, place) => [name, place]));
  }

  static async open() {
    const reply = await fetch('api/about');
    if (!reply.ok) throw new Error(`the program answered ${reply.status}`);
    return new Feed(await reply.json());
  }

  // Fetches what is new; true when there may be more at once.
  async update() {
    const query = `frame=${this.frames.length}&happening=${this.happenings.length}`;
    let news;
    try {
      news = await (await fetch(`api/since?${query}`)).json();
    } catch {
      this.lost = true;  // the program has ended; what is here stays
      this.live = false;
      return false;
    }
    for (const frame of news.frames) this.frames.push(frame);
    for (const happening of news.happenings) this.happenings.push(happening);
    this.live = news.live;
    this.result = news.result;
    return this.frames.length < news.total;
  }

  get begin() { return this.frames.length ? this.frames[0][0] : 0; }
  get end() { return this.frames.length ? this.frames[this.frames.length - 1][0] : 0; }

  // Place of the last frame that is not later than a time.
  indexAt(time) {
    let low = 0;
    let high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle][0] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  value(frame, name) { return frame[this.column[name]]; }
  point(frame, name) { const at = this.column[`${name}_x`]; return [frame[at], frame[at + 1], frame[at + 2]]; }

  // The last happening of a kind that is not later than a time.
  last(kind, time) {
    for (let i = this.happenings.length - 1; i >= 0; --i) {
      if (this.happenings[i].kind === kind && this.happenings[i].t <= time + 1e-6) return this.happenings[i];
    }
    return null;
  }
  plan(id) { return this.happenings.findLast((h) => h.kind === 'plan' && h.id === id) ?? null; }
}

export async function post(path, body) {
  const reply = await fetch(path, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json', 'X-Hopscotch': '1' },
    body: JSON.stringify(body),
  });
  return reply.json();
}
