import { Feed, post } from './feed.js';
import { Player } from './player.js';
import { Robot } from './robot.js';
import { Stage } from './stage.js';
import { Terrain } from './terrain.js';
import { bar, make, showAnswers, showDecision, showNow, showOutcome } from './panel.js';

const get = (id) => document.getElementById(id);

class Page {
  constructor(feed) {
    this.feed = feed;
    this.stage = new Stage(get('canvas'));
    this.robot = new Robot(feed.about.robot);
    this.stage.scene.add(this.robot.group);
    this.terrain = new Terrain(this.stage.scene, feed.about);
    this.player = new Player(feed);
    this.pictures = 0;
    get('operator').hidden = !feed.live;
    this.listen();
  }

  listen() {
    const canvas = get('canvas');
    let pressed = null;
    canvas.addEventListener('pointerdown', (event) => { pressed = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => {
      const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
      if (still && this.feed.live) this.propose(event);
    });
    canvas.addEventListener('pointermove', (event) => this.hover(event));
    for (const button of document.querySelectorAll('[data-mode]')) {
      button.addEventListener('click', () => post('api/command', { mode: button.dataset.mode }));
    }
  }

  hover(event) {
    const [hit] = this.stage.hits(event, this.terrain.markers);
    const box = get('hover');
    box.hidden = !hit;
    if (!hit) return;
    const stage = get('stage').getBoundingClientRect();
    box.style.left = `${event.clientX - stage.left}px`;
    box.style.top = `${event.clientY - stage.top}px`;
    box.textContent = hit.object.userData.texts[hit.instanceId];
  }

  async propose(event) {
    const [hit] = this.stage.hits(event, this.terrain.solid);
    if (!hit) return;
    const card = get('proposal');
    card.hidden = false;
    card.replaceChildren(make('p', 'Judging the place…'));
    const reply = await post('api/propose', { x: hit.point.x, y: hit.point.y }).catch((error) => ({ reason: String(error) }));
    this.terrain.propose(reply);
    this.stage.stale = true;
    this.showProposal(card, reply);
  }

  showProposal(card, reply) {
    const parts = [];
    if (reply.distance !== undefined) {
      const side = reply.lateral ? `, ${(100 * Math.abs(reply.lateral)).toFixed(0)} cm to the ${reply.lateral > 0 ? 'left' : 'right'}` : '';
      parts.push(make('h3', `${(100 * reply.distance).toFixed(0)} cm ahead${side}`));
    }
    if (reply.accepted) {
      parts.push(make('p', `A jump of ${reply.plan.duration.toFixed(2)} s with ${reply.plan.flight.toFixed(2)} s in the air, planned in ${reply.solve_ms.toFixed(0)} ms. Landing is safe with ${(100 * reply.probability).toFixed(1)} %.`));
    } else {
      parts.push(make('p', `No: ${(reply.reason ?? reply.error ?? 'no answer').replaceAll('_', ' ')}`));
    }
    const send = make('button', 'Jump there next', 'primary');
    send.id = 'send';
    send.disabled = !reply.accepted;
    const close = () => { card.hidden = true; this.terrain.propose(null); this.stage.stale = true; };
    send.addEventListener('click', async () => {
      await post('api/command', { target: { distance: reply.distance, lateral: reply.lateral, yaw: reply.yaw } });
      close();
    });
    const dismiss = make('button', 'Close');
    dismiss.addEventListener('click', close);
    parts.push(make('p', [send, ' ', dismiss]));
    if (reply.accepted) {
      parts.push(make('h2', 'Certificate: distance to each limit'));
      const margins = [...reply.plan.certificate].sort((a, b) => a.margin - b.margin);
      for (const { name, margin } of margins) {
        if (margin !== null) parts.push(bar(name, 1 - margin, `${(100 * margin).toFixed(0)} %`));
      }
    }
    card.replaceChildren(...parts);
  }

  draw(seconds) {
    const { feed, player } = this;
    player.advance(seconds);
    const moving = this.hasChanged();
    if (feed.frames.length > 0) {
      const index = feed.indexAt(player.time);
      const before = feed.frames[index];
      const after = feed.frames[Math.min(index + 1, feed.frames.length - 1)];
      const gap = after[0] - before[0];
      const share = gap > 0 ? Math.min(1, Math.max(0, (player.time - before[0]) / gap)) : 0;
      const at = this.robot.pose(feed, before, after, share);
      if (get('follow').checked) this.stage.follow(at.x, at.y);
      this.terrain.show(feed, player.time);
      this.terrain.flown(feed, index);
      this.tell(before, index);
    }
    if (this.stage.draw(seconds, moving)) this.pictures += 1;
    document.body.dataset.pictures = this.pictures;
  }

  hasChanged() {
    const now = [this.player.time, this.feed.frames.length, this.feed.happenings.length];
    const changed = now.some((value, i) => value !== this.seen?.[i]);
    this.seen = now;
    return changed;
  }

  // Numbers change ten times a second: faster nobody reads.
  tell(frame, index) {
    const now = performance.now();
    if (index === this.told?.index || now < (this.told?.next ?? 0)) return;
    this.told = { index, next: now + 100 };
    showNow(this.feed, frame);
    showAnswers(this.feed);
    const choice = this.feed.last('choice', this.player.time);
    if (choice !== this.choice) showDecision(choice);
    this.choice = choice;
  }
}

async function follow(feed) {
  let wasLive = true;
  while (wasLive || feed.frames.length === 0) {
    wasLive = feed.live;
    while (await feed.update());
    showOutcome(feed);
    document.body.dataset.frames = feed.frames.length;
    if (feed.lost) return;
    if (wasLive) await new Promise((resolve) => { setTimeout(resolve, 60); });
    if (!wasLive) return;
  }
}

async function start() {
  const feed = await Feed.open();
  if (!feed.live) while (await feed.update());
  const page = new Page(feed);
  follow(feed);
  let last = performance.now();
  const loop = (now) => {
    page.draw((now - last) / 1000);
    last = now;
    requestAnimationFrame(loop);
  };
  requestAnimationFrame(loop);
  document.body.dataset.ready = 'yes';
}

start().catch((error) => {
  document.getElementById('outcome').textContent = `This page cannot be shown: ${error.message}`;
  console.error(error);
});
