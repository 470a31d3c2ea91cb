// The clatter of a bar as a film: q and e in, its impacts as the command lists them, the bar between them drawn.

const MOST = 60; // impacts that are listed
const LEAD = 0.7; // of the fall before the first touch and of the flight after the last impact, in h0/v0
const STAGE = { width: 640, height: 250, ground: 200, left: 64, right: 576, tall: 160 };
const STEMS = { height: 120, base: 104, top: 16 };

const FIRST = { q: 0.5, e: 0.3, threshold: 1 };
const bar = {
  ...FIRST,
  flights: [],
  at: 0,
  playing: false,
  still: matchMedia('(prefers-reduced-motion: reduce)'),
};

// The flights between the strikes: heights of both ends are straight in time. A flight takes as long in the film as lets the eye follow.
function flights(answer) {
  let [time, a, b] = [-LEAD, LEAD, answer.height_gap + LEAD];
  let [va, vb] = answer.velocity;
  let begin = 0;
  const list = [];
  const fly = (until, strike) => {
    const lasts = until - time;
    const seconds = strike && strike.number > 1 ? Math.min(1.4, Math.max(0.35, 0.9 * lasts)) : 1;
    list.push({
      begin,
      seconds,
      from: { time, a, b },
      to: { time: until, a: a + va * lasts, b: b + vb * lasts },
      strike: list.at(-1)?.ends,
    });
    list.at(-1).ends = strike;
    begin += seconds;
    [time, a, b] = [until, a + va * lasts, b + vb * lasts];
  };
  for (const impact of answer.impacts) {
    fly(impact.time, impact);
    if (impact.end === 'a') a = 0;
    else b = 0; // exactly on the ground
    [va, vb] = [va + impact.delta_v[0], vb + impact.delta_v[1]];
  }
  fly(time + LEAD, undefined);
  return list;
}

const length = () => bar.flights.at(-1).begin + bar.flights.at(-1).seconds;

function moment(at) {
  const flight = bar.flights.findLast((flight) => flight.begin <= at) ?? bar.flights[0];
  const share = Math.min(1, (at - flight.begin) / flight.seconds);
  const between = (key) => flight.from[key] + share * (flight.to[key] - flight.from[key]);
  return { flight, since: at - flight.begin, time: between('time'), a: between('a'), b: between('b') };
}

function show() {
  if (!bar.flights.length) return;
  const { flight, since, time, a, b } = moment(bar.at);
  const { ground, left, right, tall } = STAGE;
  const unit = Math.min(100, tall / Math.max(a, b, 1));
  const [ya, yb] = [ground - unit * Math.max(0, a) - 7, ground - unit * Math.max(0, b) - 7];
  const along = (s) => [left + 0.5 * (1 + s) * (right - left), ya + 0.5 * (1 + s) * (yb - ya)];
  const line = (node, from, to) => {
    const [[x1, y1], [x2, y2]] = [along(from), along(to)];
    for (const [key, value] of Object.entries({ x1, y1, x2, y2 })) node.setAttribute(key, value.toFixed(2));
  };
  line($('bar'), -1, 1);
  const safe = Math.min(1, bar.safe ?? -1);
  $('safe').toggleAttribute('hidden', safe <= 0);
  line($('safe'), -Math.max(0, safe), Math.max(0, safe));
  const [cx, cy] = along(0);
  $('center').setAttribute('transform', `translate(${cx} ${cy})`);
  $('gap').setAttribute('d', `M${left - 34} ${ground}v${-unit}m-4 0h8m-8 ${unit}h8`);
  $('gap-label').setAttribute('y', ground - unit - 6);
  const strike = flight.strike;
  const burst = $('burst');
  burst.toggleAttribute('hidden', !strike || since > 0.3);
  if (strike) {
    const shock = strike.delta_v[strike.end === 'a' ? 0 : 1];
    const x = strike.end === 'a' ? left : right;
    const fade = Math.max(0, 1 - since / 0.3);
    burst.setAttribute(
      'transform',
      `translate(${x} ${ground}) scale(${(0.5 + 0.5 * (1 - fade)) * Math.min(2, Math.max(0.4, shock))})`,
    );
    burst.setAttribute('opacity', bar.playing || since === 0 ? Math.max(fade, since === 0 ? 1 : 0) : fade);
  }
  $('caption').textContent = strike
    ? `Impact ${strike.number}: end ${strike.end}, shock ${digits(strike.delta_v[strike.end === 'a' ? 0 : 1])} v₀`
    : 'Falling: end a touches first';
  $('clock').textContent = `${digits(time, 3)} h₀/v₀`;
  $('scrub').value = bar.at;
  $('scrub').setAttribute('aria-valuetext', `${$('caption').textContent}, at ${digits(time, 3)} h0/v0`);
  for (const stem of $('stems').querySelectorAll('[data-number]')) {
    stem.classList.toggle('now', Number(stem.dataset.number) === strike?.number);
  }
}

function stems() {
  const impacts = bar.flights.map((flight) => flight.strike).filter(Boolean);
  const shocks = impacts.map((impact) => impact.delta_v[impact.end === 'a' ? 0 : 1]);
  const most = Math.max(bar.threshold, ...shocks) * 1.08;
  const { left, right } = STAGE;
  const x = (n) => left + (n + 0.5) * Math.min(44, (right - left) / shocks.length);
  const y = (shock) => STEMS.base - (shock / most) * (STEMS.base - STEMS.top);
  const of = (impact, n) =>
    drawn(
      'g',
      { 'data-number': impact.number, class: `stem ${impact.end}`, onclick: () => seek(bar.flights[n + 1].begin) },
      drawn('title', {}, `Impact ${impact.number}, end ${impact.end}: ${digits(shocks[n])} v0`),
      drawn('rect', { x: x(n) - 6, y: STEMS.top, width: 12, height: STEMS.base - STEMS.top, fill: 'transparent' }),
      drawn('line', { x1: x(n), x2: x(n), y1: STEMS.base, y2: y(shocks[n]) }),
      drawn('circle', { cx: x(n), cy: y(shocks[n]), r: 4 }),
    );
  $('stems').replaceChildren(
    drawn('line', { class: 'axis', x1: left - 8, x2: right, y1: STEMS.base, y2: STEMS.base }),
    drawn('line', { class: 'limit', x1: left - 8, x2: right, y1: y(bar.threshold), y2: y(bar.threshold) }),
    ...impacts.map(of),
    drawn('text', { x: right, y: y(bar.threshold) - 5, 'text-anchor': 'end' }, `survived: ${digits(bar.threshold, 3)} v₀`),
  );
}

function seek(at) {
  bar.at = Math.min(length(), Math.max(0, at));
  show();
}

// To the next strike or back to the one before.
function step(by) {
  pause();
  const begins = bar.flights.slice(1).map((flight) => flight.begin);
  const next = by > 0 ? begins.find((begin) => begin > bar.at + 1e-9) : begins.findLast((begin) => begin < bar.at - 1e-9);
  seek(next ?? (by > 0 ? length() : 0));
}

function pause() {
  bar.playing = false;
  $('play').textContent = 'Play';
}

function play() {
  if (bar.at >= length()) bar.at = 0;
  if (bar.playing) return;
  bar.playing = true;
  $('play').textContent = 'Pause';
  let last;
  const frame = (now) => {
    if (!bar.playing) return;
    seek(bar.at + (now - (last ?? now)) / 1000);
    last = now;
    if (bar.at >= length()) return pause();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

// The latest values alone are asked for, and shown.
const asking = { wanted: undefined, running: false };
async function bars() {
  asking.wanted = [bar.q, bar.e, bar.threshold];
  if (asking.running) return;
  asking.running = true;
  while (asking.wanted) {
    const [q, e, threshold] = asking.wanted;
    asking.wanted = undefined;
    try {
      const [impacts, zone] = await Promise.all([
        quick.ask({ ask: 'impacts', q, e, limit: MOST }),
        quick.ask({ ask: 'zone', q, e, threshold }),
      ]);
      if (!asking.wanted) barsTold(impacts, zone);
      problem($('bar-problem'));
    } catch (error) {
      problem($('bar-problem'), error);
    }
  }
  asking.running = false;
}

function barsTold(impacts, zone) {
  Object.assign(answers, { impacts: impacts.answer, zone: zone.answer });
  const answer = JSON.parse(impacts.answer);
  const [{ s, extent, threshold }] = JSON.parse(zone.answer).zones;
  const same = bar.flights.length > 0;
  bar.flights = flights(answer);
  bar.safe = s;
  $('scrub').max = length();
  const listed = answer.impacts.length;
  const count = answer.count === 'infinite' ? 'without end' : String(answer.count);
  const rows = {
    Impacts: listed === answer.count ? count : `${count}; the film shows ${listed}`,
    'Shock at the ends': `${digits(answer.peak.end)} v₀, no. ${answer.peak.impact}`,
    'Shock at the center': `${digits(answer.peak.center)} v₀`,
    'Last impact at': `${digits(answer.duration)} h₀/v₀`,
    [`Safe up to ${digits(threshold, 3)} v₀`]:
      { none: 'nowhere', whole: 'the whole bar' }[extent] ?? `the middle ${digits(100 * s, 3)} %`,
  };
  $('bar-told').replaceChildren(
    ...Object.entries(rows).flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]),
  );
  $('bar-commands').replaceChildren(command(impacts.command, impacts.answer), command(zone.command, zone.answer));
  stems();
  if (same && bar.playing) seek(Math.min(bar.at, length()));
  else if (!bar.still.matches) {
    bar.at = 0;
    play();
  } else seek(bar.flights[Math.min(2, bar.flights.length - 1)].begin);
  point();
}

// Where q and e are in their plane, over the largest shock at the ends.
function point() {
  $('point').setAttribute('transform', `translate(${(bar.e * 100).toFixed(2)} ${(100 - bar.q * 100).toFixed(2)})`);
  $('plane').setAttribute('aria-valuetext', `q ${digits(bar.q, 3)}, e ${digits(bar.e, 3)}`);
  $('plane').setAttribute('aria-valuenow', bar.q);
}

async function plane() {
  const { shown: rows } = await quick.ask({ ask: 'plane' });
  const count = rows.length;
  const canvas = element('canvas', { width: count, height: count });
  const pixels = new ImageData(count, count);
  const [light, dark] = [
    [242, 246, 250],
    [31, 78, 124],
  ];
  rows.forEach((row, i) =>
    row.forEach((value, k) => {
      const share = value === null ? 1 : Math.min(1, Math.max(0, Math.log(value) / Math.log(8))); // from v0 to 8 v0, or without bound
      const color = light.map((c, n) => c + share * (dark[n] - c));
      pixels.data.set([...color, 255], 4 * ((count - 1 - i) * count + k));
    }),
  );
  canvas.getContext('2d').putImageData(pixels, 0, 0);
  $('plane-map').setAttribute('href', canvas.toDataURL());
}

// q and e as numbers or sliders; what is no number is told, and the last bar stays.
function set(values) {
  for (const [key, value] of Object.entries(values)) {
    const given = typeof value === 'string' && value.trim() === '' ? NaN : Number(value);
    const field = $(`${key}-number`);
    field.setAttribute('aria-invalid', !Number.isFinite(given));
    if (!Number.isFinite(given)) return problem($('bar-problem'), new Error(`${key} is no number`));
    bar[key] = given;
    if (field !== document.activeElement) field.value = given;
    const slider = $(`${key}-slider`);
    if (slider) slider.value = given;
  }
  keep();
  return bars();
}

function filmBegins() {
  for (const key of ['q', 'e', 'threshold']) {
    $(`${key}-number`).oninput = ({ target }) => set({ [key]: target.value });
    const slider = $(`${key}-slider`);
    if (slider) slider.oninput = ({ target }) => set({ [key]: target.value });
  }
  $('play').onclick = () => (bar.playing ? pause() : play());
  $('back').onclick = () => step(-1);
  $('on').onclick = () => step(1);
  $('scrub').oninput = ({ target }) => {
    pause();
    seek(Number(target.value));
  };
  $('stage').onkeydown = $('stems').onkeydown = (event) => {
    const keys = {
      ' ': () => $('play').click(),
      ArrowRight: () => step(1),
      ArrowLeft: () => step(-1),
      Home: () => {
        pause();
        seek(0);
      },
      End: () => {
        pause();
        seek(length());
      },
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  };
  const rounded = (x) => Math.round(Math.min(1, Math.max(0, x)) * 100) / 100;
  const plot = $('plane');
  const drag = (event) => {
    const box = $('plane-map').getBoundingClientRect();
    set({ q: rounded(1 - (event.clientY - box.top) / box.height), e: rounded((event.clientX - box.left) / box.width) });
  };
  plot.onpointerdown = (event) => {
    plot.setPointerCapture(event.pointerId);
    drag(event);
  };
  plot.onpointermove = (event) => {
    if (plot.hasPointerCapture(event.pointerId)) drag(event);
  };
  plot.onkeydown = (event) => {
    const by = event.shiftKey ? 0.1 : 0.01;
    const move = { ArrowUp: [by, 0], ArrowDown: [-by, 0], ArrowRight: [0, by], ArrowLeft: [0, -by] }[event.key];
    if (!move) return;
    event.preventDefault();
    set({ q: rounded(bar.q + move[0]), e: rounded(bar.e + move[1]) });
  };
  const { name, text, ...values } = keptBefore();
  set({ ...FIRST, ...values }).then(() => bar.flights.length || set(FIRST)); // what was kept may be refused
  plane();
}
