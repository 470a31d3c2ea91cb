// The plan of a product: its masses and parts as rectangles that are dragged, or moved by arrow keys.

const GRID = 1e-3; // m, what a drag and an arrow key move by
const plan = { key: '', pixel: 1 };

// What can be moved, masses first: parts lie on them.
function items(of) {
  const all = (list, kind) => list.map((place, n) => ({ ...place, kind, n, item: { [kind]: n } }));
  return [...all(of.masses, 'mass'), ...all(of.components, 'component')];
}

// Of a bar nothing is across: what can be moved lies in rows, so high that a finger finds them.
const ROW = 34; // pixels
const across = (of) => of.width_m ?? (of.masses.length + of.components.length) * ROW * plan.pixel;
function reach(of, thing) {
  if (thing.across_m) return thing.across_m;
  const row = thing.kind === 'mass' ? thing.n : of.masses.length + thing.n;
  const pitch = ROW * plan.pixel;
  const top = 0.5 * across(of) - row * pitch;
  return of.width_m ? [-0.5 * of.width_m, 0.5 * of.width_m] : [top - 0.8 * pitch, top - 0.2 * pitch];
}

function drawPlan(of, verdicts, zones) {
  const svg = $('plan');
  const room = 0.05 * of.length_m;
  const wide = of.length_m + 2 * room;
  plan.pixel = wide / Math.max(200, svg.clientWidth);
  const height = across(of);
  const foot = 18 * plan.pixel;
  const all = items(of);
  const key = JSON.stringify([of.length_m, of.width_m, plan.pixel, all.map((thing) => [thing.kind, thing.name])]);
  if (key !== plan.key) {
    plan.key = key;
    const focused = document.activeElement?.dataset?.key;
    svg.setAttribute('viewBox', [-0.5 * wide, -0.5 * height - room, wide, height + 2 * room + foot].map((x) => 1e3 * x).join(' '));
    svg.style.setProperty('--pixel', 1e3 * plan.pixel);
    const things = all.map(movable);
    // Small ones above large ones.
    const size = ({ along_m: [a, b], across_m }) => (b - a) * (across_m ? across_m[1] - across_m[0] : 1);
    const order = all
      .map((thing, i) => i)
      .sort((i, k) => (all[i].kind === all[k].kind ? size(all[k]) - size(all[i]) : all[i].kind === 'mass' ? -1 : 1));
    const centers = drawn('g', { id: 'centers' });
    svg.replaceChildren(
      drawn('rect', {
        class: 'body',
        x: -500 * of.length_m,
        y: -500 * height,
        width: 1e3 * of.length_m,
        height: 1e3 * height,
        rx: 4e3 * plan.pixel,
      }),
      drawn('g', { id: 'zones' }),
      ...(of.width_m ? [] : [centers]),
      ...order.map((i) => things[i]),
      ...(of.width_m ? [centers] : []),
      drawn('g', { id: 'foot' }),
      drawn('g', { id: 'names' }, ...all.map((thing) => drawn('text', { class: thing.kind }, thing.name))),
    );
    foots(of, height, room);
    if (focused) svg.querySelector(`[data-key="${focused}"]`)?.focus({ preventScroll: true });
  }
  const boxes = all.map((thing) => place(of, thing, reach(of, thing), thing.kind === 'component' ? verdicts?.[thing.n] : undefined));
  named(of, all, boxes);
  zoned(of, all, zones);
  const [cx, cy] = [1e3 * of.center_m[0], -1e3 * of.center_m[1]];
  const r = 7e3 * plan.pixel;
  $('centers').replaceChildren(
    of.width_m
      ? drawn('path', { class: 'center cross', d: `M${cx - r} ${cy}h${2 * r}M${cx} ${cy - r}v${2 * r}` })
      : drawn('path', { class: 'center', d: `M${cx} ${-500 * height}v${1e3 * height}` }),
  );
}

// Ends and the scale.
function foots(of, height, room) {
  const below = 500 * height + 1e3 * plan.pixel * 16;
  const half = 500 * of.length_m;
  const step = [5, 10, 20, 25, 50, 100, 200, 500, 1000].find((step) => (2 * half) / step <= 8) ?? 2000;
  const ticks = [];
  for (let mm = -Math.floor(half / step) * step; mm <= half; mm += step) {
    ticks.push(
      drawn('path', { class: 'tick', d: `M${mm} ${500 * height}v${4e3 * plan.pixel}` }),
      drawn('text', { x: mm, y: below + 3e3 * plan.pixel, 'text-anchor': 'middle' }, digits(mm, 4).replace(/\.0+$/, '')),
    );
  }
  const end = (name, side) =>
    drawn('text', { class: 'end', x: side * (half + 500 * room), y: 4e3 * plan.pixel, 'text-anchor': 'middle' }, name);
  $('foot').replaceChildren(end('a', -1), end('b', 1), ...ticks);
}

function movable(thing) {
  const key = `${thing.kind}-${thing.n}`;
  return drawn(
    'g',
    {
      class: `thing ${thing.kind}`,
      'data-key': key,
      tabindex: 0,
      role: 'slider',
      onkeydown: (event) => nudge(event, thing),
      onpointerdown: (event) => grab(event, thing),
    },
    drawn('rect', { rx: 2e3 * plan.pixel }),
  );
}

function place(of, thing, [low, high], verdict) {
  const node = $('plan').querySelector(`[data-key="${thing.kind}-${thing.n}"]`);
  const least = 1e3 * 9 * plan.pixel; // so wide that a finger finds it
  const [x, wide] = spread(1e3 * thing.along_m[0], 1e3 * thing.along_m[1], least);
  const [y, tall] = spread(-1e3 * high, -1e3 * low, least);
  Object.entries({ x, y, width: wide, height: tall }).forEach(([key, value]) => node.firstChild.setAttribute(key, value));
  node.dataset.verdict = verdict ?? '';
  const [mx, my] = middle(thing);
  Object.entries({
    'aria-label': `${thing.kind === 'mass' ? 'Mass' : 'Part'} ${thing.name}`,
    'aria-valuemin': -500 * of.length_m,
    'aria-valuemax': 500 * of.length_m,
    'aria-valuenow': mx,
    'aria-valuetext': `${mx} mm along${of.width_m ? `, ${my} mm across` : ''}`,
  }).forEach(([key, value]) => node.setAttribute(key, value));
  return { x, y, wide, tall };
}

// Each name where none stands yet: within, where it fits, else beside, towards the middle. On a plate, where parts may lie on masses,
// the name of a mass keeps to a corner, or there is none.
function named(of, things, boxes) {
  const unit = 1e3 * plan.pixel;
  const [left, top, width, height] = $('plan').getAttribute('viewBox').split(' ').map(Number);
  const [cx, cy] = [1e3 * of.center_m[0], -1e3 * of.center_m[1]];
  const taken = of.width_m ? [[cx - 8 * unit, cy - 8 * unit, cx + 8 * unit, cy + 8 * unit]] : [];
  const isFree = ([x1, y1, x2, y2]) =>
    x1 >= left &&
    y1 >= top &&
    x2 <= left + width &&
    y2 <= top + height &&
    taken.every(([a1, b1, a2, b2]) => x2 <= a1 || a2 <= x1 || y2 <= b1 || b2 <= y1);
  // Names of parts before those of masses.
  for (const i of [...things.keys()].reverse()) {
    const text = $('names').children[i];
    text.removeAttribute('hidden');
    const long = text.getComputedTextLength();
    const at = ({ anchor, x, y }) => {
      const x1 = x - { start: 0, middle: 0.5, end: 1 }[anchor] * long;
      return [x1, y - 11 * unit, x1 + long, y + 3 * unit];
    };
    const all = spots(of, things[i], boxes[i], long, unit);
    const found = all.find((spot) => isFree(at(spot))) ?? all.find((spot) => !spot.corner);
    text.toggleAttribute('hidden', !found);
    if (!found) continue;
    taken.push(at(found));
    text.classList.toggle('within', found.within === true);
    Object.entries({ 'text-anchor': found.anchor, x: found.x, y: found.y }).forEach(([key, value]) => text.setAttribute(key, value));
  }
}

// Where a name so long may stand, best first.
function spots(of, thing, { x, y, wide, tall }, long, unit) {
  const [middle, foot] = [x + 0.5 * wide, y + 0.5 * tall + 4 * unit];
  const [high, low] = [y + 14 * unit, y + tall - 5 * unit];
  const fits = wide > long + 8 * unit && tall > 15 * unit;
  if (of.width_m && thing.kind === 'mass') {
    const corners = [high, low].flatMap((y) => [
      { anchor: 'start', x: x + 5 * unit, y, corner: true },
      { anchor: 'end', x: x + wide - 5 * unit, y, corner: true },
    ]);
    return fits ? corners : [];
  }
  const within = fits ? [foot, high, low].map((y) => ({ anchor: 'middle', x: middle, y, within: true })) : [];
  const beside = [
    { anchor: 'end', x: x - 5 * unit, y: foot },
    { anchor: 'start', x: x + wide + 5 * unit, y: foot },
  ];
  if (middle < 0) beside.reverse();
  const about = [y - 5 * unit, y + tall + 13 * unit].flatMap((y) => [
    { anchor: 'middle', x: middle, y },
    { anchor: 'end', x: x + wide, y },
    { anchor: 'start', x, y },
  ]);
  return [...within, ...beside, ...(of.width_m ? about : [])];
}

function spread(low, high, least) {
  const wide = Math.max(high - low, least);
  return [0.5 * (low + high - wide), wide];
}

// In mm, without what the last bits add.
function middle({ along_m, across_m }) {
  const of = ([low, high]) => Math.round(5e5 * (low + high)) / 1e3;
  return [of(along_m), across_m ? of(across_m) : 0];
}

// Where the middle of each part would be safe.
function zoned(of, all, zones) {
  const bands = (zones ?? []).map((zone, n) => {
    const thing = all.find((thing) => thing.kind === 'component' && thing.n === n);
    if (!zone || !thing) return undefined;
    const [low, high] = reach(of, thing);
    const [from, to] = zone.map((m) => 1e3 * Math.min(0.5 * of.length_m, Math.max(-0.5 * of.length_m, m)));
    const tall = 0.3 * (high - low);
    return drawn('rect', {
      class: 'zone',
      x: from,
      width: Math.max(0, to - from),
      y: -1e3 * (high + tall),
      height: 1e3 * (high - low + 2 * tall),
    });
  });
  $('zones').replaceChildren(...bands.filter(Boolean));
}

// One move after the other, each in the text as it then is.
let moves = Promise.resolve();
function nudge(event, thing) {
  const by = event.shiftKey ? 10 * GRID : GRID;
  const way = { ArrowRight: [by, 0], ArrowLeft: [-by, 0], ArrowUp: [0, by], ArrowDown: [0, -by] }[event.key];
  if (!way || (way[1] && !thing.across_m)) return;
  event.preventDefault();
  moves = moves.then(() => moved(product.text, thing.item, way, true));
}

// Moves what stands in a text, up to the edge unless a number was typed; where the product has become another one meanwhile, nothing.
async function moved(text, item, by, isNew, stops = true) {
  const before = product.text;
  try {
    const { shown } = await quick.ask({ ask: 'move', text, item, by, stops });
    if (product.text !== before) return false;
    change(shown, { isNew });
    return true;
  } catch (error) {
    problem($('product-problem'), error);
    return false;
  }
}

function grab(event, thing) {
  const node = event.currentTarget;
  const [x, y, text] = [event.clientX, event.clientY, product.text];
  const scale = $('plan').getScreenCTM().a;
  let [wanted, running, isNew] = [undefined, false, true];
  node.setPointerCapture(event.pointerId);
  node.focus({ preventScroll: true });
  event.preventDefault();
  node.classList.add('held');
  const go = async () => {
    if (running) return;
    running = true;
    while (wanted) {
      const by = wanted;
      wanted = undefined;
      if (!(await moved(text, thing.item, by, isNew))) return; // and nothing more of this drag
      isNew = false;
    }
    running = false;
  };
  let last = '0,0';
  node.onpointermove = (event) => {
    const on = (pixels) => (Math.round(pixels / scale) * GRID * 1e3) / 1e3;
    const by = [on(event.clientX - x), thing.across_m ? -on(event.clientY - y) : 0];
    if (String(by) === last) return;
    last = String(by);
    wanted = by;
    go();
  };
  node.onpointerup = node.onpointercancel = () => {
    node.onpointermove = node.onpointerup = node.onpointercancel = null;
    node.classList.remove('held');
  };
}

// The same places as numbers. A field that is typed in stays.
function places(of) {
  const all = items(of);
  const key = JSON.stringify([!!of.width_m, all.map((thing) => [thing.kind, thing.name])]);
  if (key !== $('places').dataset.key) {
    $('places').dataset.key = key;
    const heads = ['Middle of', 'along, mm', ...(of.width_m ? ['across, mm'] : [])].map((head) =>
      element('th', { scope: 'col' }, head),
    );
    const row = (thing, n) =>
      element(
        'tr',
        {},
        element('th', { scope: 'row' }, thing.name, element('small', {}, thing.kind === 'mass' ? ' mass' : ' part')),
        ...[0, 1]
          .filter((side) => side === 0 || of.width_m)
          .map((side) => element('td', {}, side && !thing.across_m ? '' : field(thing, n, side))),
      );
    $('places').replaceChildren(element('thead', {}, element('tr', {}, ...heads)), element('tbody', {}, ...all.map(row)));
  }
  plan.things = all;
  for (const input of $('places').querySelectorAll('input')) {
    if ('typed' in input.dataset) continue;
    input.removeAttribute('aria-invalid');
    input.value = middle(all[input.dataset.n])[input.dataset.side];
  }
}

function field({ name: of }, n, side) {
  const name = ['along', 'across'][side];
  return element('input', {
    type: 'number',
    step: 'any',
    'data-n': n,
    'data-side': side,
    'aria-label': `${of}: middle ${name}, mm`,
    oninput: ({ target }) => (target.dataset.typed = ''),
    onchange: ({ target }) => {
      delete target.dataset.typed;
      const thing = plan.things[n];
      const mm = target.value.trim() === '' ? NaN : Number(target.value);
      target.setAttribute('aria-invalid', !Number.isFinite(mm));
      if (!Number.isFinite(mm)) return problem($('product-problem'), new Error(`the place of ${thing.name} ${name} is no number`));
      const by = [0, 0];
      by[side] = (mm - middle(thing)[side]) * 1e-3;
      moves = moves.then(() => moved(product.text, thing.item, by, true, false));
    },
  });
}
