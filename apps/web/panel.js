// The column of numbers: what happens now, limits, the last decision, the operator's answers.
import { kPhaseColors } from './charts.js';

const get = (id) => document.getElementById(id);

// Elements with text; text is never read as markup.
export function make(tag, content, className) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (Array.isArray(content)) element.append(...content);
  else if (content !== undefined) element.textContent = content;
  return element;
}

const fixed = (value, digits, unit = '') => (value === null || value === undefined ? '–' : `${value.toFixed(digits)}${unit}`);
const words = (code) => code.replaceAll('_', ' ');

export function bar(name, share, text) {
  const fill = make('i', undefined, share > 1 ? 'over' : share > 0.9 ? 'tight' : '');
  fill.style.width = `${100 * Math.max(0, Math.min(1, share ?? 0))}%`;
  return make('div', [make('b', name), make('div', [fill]), make('span', text)], 'bar');
}

export function showNow(feed, frame) {
  const value = (name) => feed.value(frame, name);
  const chip = make('span', value('phase'), 'chip');
  chip.style.background = kPhaseColors[value('phase')];
  const plan = feed.plan(value('plan'));
  const rows = [
    ['phase', chip],
    ['jump', String(value('jump'))],
    ['plan', plan ? `${fixed(value('plan_time'), 2)} of ${fixed(plan.duration, 2, ' s')}` : '–'],
    ['held', value('held') ? 'yes' : 'no'],
    ['ground force', fixed((value('force_left') ?? 0) + (value('force_right') ?? 0), 0, ' N')],
    ['asked for', fixed(value('force_asked'), 0, ' N')],
    ['position error', fixed(1000 * value('position_error'), 1, ' mm')],
    ['missed deadlines', String(value('misses'))],
    ['tick', fixed(value('tick_ms'), 3, ' ms')],
    ['balance (MPC)', fixed(value('mpc_ms'), 2, ' ms')],
  ];
  if (value('fault')) rows.splice(1, 0, ['fault', words(value('fault'))]);
  get('now').replaceChildren(...rows.flatMap(([name, text]) => [make('dt', name), make('dd', text instanceof Node ? [text] : text)]));
  const bars = ['torque', 'speed', 'power'].map((name) => bar(name, value(name), fixed(100 * value(name), 0, ' %')));
  if (plan) {
    for (const name of ['torque', 'speed', 'power']) {
      bars.push(bar(`plan: ${name}`, plan.peaks[name], fixed(100 * plan.peaks[name], 0, ' %')));
    }
  }
  get('margins').replaceChildren(...bars);
}

function row(cells, className) { return make('tr', cells.map((cell) => make('td', cell)), className); }

export function showDecision(choice) {
  if (!choice) {
    get('decision').replaceChildren(make('p', 'none yet', 'hint'));
    return;
  }
  const parts = [];
  if (choice.target) {
    const target = choice.target;
    parts.push(make('p', `At ${choice.t.toFixed(2)} s: ${(100 * target.distance).toFixed(0)} cm ahead, ${(100 * target.height).toFixed(1)} cm up, chosen by ${target.source === 'operator' ? 'the operator' : 'the robot'}.`));
  } else {
    parts.push(make('p', `At ${choice.t.toFixed(2)} s: ${words(choice.refusal)}`));
  }
  const rows = choice.ranked.slice(0, 6).map((place, i) =>
    row([`${(100 * place.distance).toFixed(0)} cm`, `${(100 * place.probability).toFixed(1)} %`, `${(100 * place.margin).toFixed(1)} cm`], i === 0 && choice.target ? 'chosen' : ''));
  const head = make('tr', ['place', 'safe', 'margin'].map((name) => make('th', name)));
  if (rows.length) parts.push(make('table', [head, ...rows]));
  const why = new Map();
  for (const place of choice.rejected) why.set(place.why, [...(why.get(place.why) ?? []), place.distance]);
  const no = [...why].map(([code, places]) =>
    row([words(code), `${(100 * Math.min(...places)).toFixed(0)}–${(100 * Math.max(...places)).toFixed(0)} cm`, `${places.length}`], 'no'));
  if (no.length) parts.push(make('p', 'Not these:', 'hint'), make('table', no));
  get('decision').replaceChildren(...parts);
}

export function showAnswers(feed) {
  const answers = feed.happenings.filter((h) => h.kind === 'ack').slice(-5).reverse();
  get('answers').replaceChildren(...answers.map((ack) => {
    const when = ack.start_in > 0 ? `, in ${ack.start_in.toFixed(2)} s` : '';
    const verdict = ack.accepted ? `accepted: ${ack.sentence}${when}` : `refused: ${words(ack.reason)}. ${ack.sentence}`;
    return make('li', `${ack.t.toFixed(2)} s, ${verdict}`, ack.accepted ? '' : 'no');
  }));
}

export function showOutcome(feed) {
  const { result } = feed;
  document.querySelector('h1').textContent = feed.about.scenario;
  document.title = `${feed.about.scenario} – Hopscotch`;
  let text = feed.live ? 'running' : 'connection lost';
  if (result) {
    const landed = result.jumps.filter((jump) => jump.outcome === 'landed').length;
    text = `${result.outcome} after ${result.duration_s.toFixed(1)} s, ${landed} of ${result.jumps.length} jumps landed${result.reason ? `: ${result.reason}` : ''}`;
  }
  get('outcome').textContent = `${text} · run ${feed.about.run_id}`;
}
