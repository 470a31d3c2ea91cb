// A product: its text, its plan, and what `clatter assess` says of it.

const product = { name: '', text: '', plan: undefined, verdicts: undefined, zones: undefined, before: [], turn: 0 };

// The one way in which the text changes: by a drag, by hand, from a file.
function change(text, { isNew = true, name = product.name, typed = false } = {}) {
  if (text === product.text && name === product.name) return;
  if (isNew && product.text) {
    product.before.push({ text: product.text, name: product.name });
    product.before.splice(0, product.before.length - 200);
  }
  $('undo').disabled = product.before.length === 0;
  Object.assign(product, { text, name });
  if (!typed) $('toml').value = text;
  $('product-name').value = name;
  keep();
  judge();
}

function undo() {
  const last = product.before.pop();
  if (last) change(last.text, { ...last, isNew: false });
}

// The first answer, then the one with the most physics. Of changes that come faster than answers the latest is answered; an answer
// to an earlier one is never shown over that of a later.
const judging = { running: false, again: false };
async function judge() {
  product.turn++;
  product.changed = performance.now();
  if (slow.busy) slow.stop();
  state('computing …');
  judging.again = true;
  if (judging.running) return;
  judging.running = true;
  while (judging.again) {
    judging.again = false;
    await first();
  }
  judging.running = false;
  if (product.readable) whole(product.turn);
}

async function first() {
  const { name, text, changed } = product;
  try {
    const { shown, warnings } = await quick.ask({ ask: 'plan', name, text });
    if (!product.plan || planKey(shown) !== planKey(product.plan))
      Object.assign(product, { verdicts: undefined, zones: undefined });
    product.plan = shown;
    redrawn(true);
    warned(warnings);
    // That of a plate takes too long to wait for while it is dragged.
    if (shown.quick && !shown.width_m) {
      const told = await quick.ask({ ask: 'assess', name, text, quick: true });
      verdicts(told, { first: true, changed });
    }
    product.readable = true;
    problem($('product-problem'));
  } catch (error) {
    product.readable = false;
    problem($('product-problem'), error);
    state(product.plan ? 'The plan and the verdicts are those of the last text that could be read.' : '');
    $('product').classList.add('stale');
  }
}

const planKey = (plan) => JSON.stringify([plan.product, plan.length_m, plan.width_m, plan.components.map((part) => part.name)]);

function redrawn(stale) {
  $('product').classList.remove('stale');
  $('zones')?.classList.toggle('stale', stale);
  drawPlan(product.plan, product.verdicts, product.zones);
  places(product.plan);
  $('take').disabled = product.plan.q === null;
  $('bands').hidden = product.plan.width_m !== null;
}

async function whole(turn) {
  const { name, text, changed } = product;
  const current = () => turn === product.turn;
  // Where there is a first answer, what is still being dragged is not begun with.
  if (product.plan.quick) await new Promise((done) => setTimeout(done, 60));
  if (!current()) return;
  try {
    const started = performance.now();
    slow.progress = (share) => {
      const seconds = Math.round((performance.now() - started) / 1000);
      state(`computing … ${Math.round(100 * share)} %${seconds > 1 ? `, ${seconds} s` : ''}`, share);
    };
    if (product.plan.width_m) {
      const told = await slow.ask({ ask: 'assess', name, text, quick: true });
      if (!current()) return;
      verdicts(told, { first: true, changed });
    }
    const told = await slow.ask({ ask: 'assess', name, text, quick: false });
    if (!current()) return;
    verdicts(told, { first: false, changed });
    if (product.plan.width_m) return; // further ones of plates take minutes
    slow.progress = undefined;
    const drawings = await slow.ask({ ask: 'figures', name, text });
    if (!current()) return;
    product.zones = drawings.shown;
    redrawn(false);
    figures(drawings.figures);
  } catch (error) {
    if (current()) problem($('product-problem'), error);
  }
}

function figures(list) {
  $('product-figures').hidden = list.length === 0;
  $('product-figures').lastElementChild.replaceChildren(...list.map(figure));
}

function warned(warnings = []) {
  $('product-warnings').textContent = warnings.join('\n\n');
  $('product-warnings').hidden = warnings.length === 0;
}

function state(words, share) {
  $('state').textContent = words;
  const bar = $('share');
  bar.hidden = share === undefined;
  if (share !== undefined) bar.value = share;
}

const took = { first: undefined, whole: undefined };
function verdicts(told, { first, changed }) {
  const answer = JSON.parse(told.answer);
  answers[first ? 'first' : 'assess'] = told.answer;
  product.verdicts = answer.components.map((part) => part.verdict);
  drawPlan(product.plan, product.verdicts, product.zones);
  const count = (verdict) => answer.components.filter((part) => part.verdict === verdict).length;
  const [bad, open, all] = [count('unsafe'), count('undecided'), answer.components.length];
  const rest = open ? `, ${open} undecided` : '';
  const headline = bad
    ? `is unsafe: ${bad} of ${all} components${rest}`
    : open
      ? `is undecided: ${open} of ${all} components`
      : 'is safe: every limit holds in the worst drop';
  const body = answer.assumed.find((assumed) => assumed.input === 'body');
  const assumed = body ? `, as a ${body.taken}; ${body.why.replaceAll('`', '')}` : '';
  const friction = answer.assumed.find((assumed) => assumed.input === 'friction');
  $('friction').textContent = friction ? `Friction: ${friction.taken}, assumed: ${friction.why}.` : '';
  const verdict = $('verdict');
  verdict.dataset.verdict = answer.verdict;
  const line = `${answer.product} ${headline}${assumed}`;
  if (verdict.textContent !== line) verdict.textContent = line;
  $('limits').replaceChildren(
    ...answer.components.flatMap((part, i) => part.limits.map((limit, k) => row(part, limit, told.shown[i][k], k === 0))),
  );
  $('drops').replaceChildren(
    ...answer.components.flatMap((part, i) => part.limits.map((limit, k) => worst(part, limit, told.shown[i][k]))),
  );
  // What is found so far stands without a command: none repeats it.
  $('product-command').replaceChildren(...(told.command ? [command(told.command, told.answer)] : []));
  if (product.plan.width_m) figures(told.figures);
  const ms = Math.round(performance.now() - changed);
  took[first ? 'first' : 'whole'] = ms;
  window.clatter.took = { ...took };
  if (first && judging.again) state('computing …');
  else if (first && product.plan.width_m) state(`The most that the first drops ask, after ${ms} ms; searching on …`);
  else if (first) state(`First answer, by instant impacts, after ${ms} ms; computing with contacts that take time …`);
  else
    state(
      `Answered in ${ms < 1000 ? `${ms} ms` : `${digits(ms / 1000, 3)} s`}${product.plan.quick ? `, first after ${took.first} ms` : ''}.`,
    );
}

function row(part, limit, { unit, si }, isFirst) {
  const room = limit.margin;
  const share = typeof room === 'number' ? `${room < 0 ? '−' : '+'}${Math.abs(100 * room).toFixed(1)} %` : '–';
  // A margin of m is a demand of 1/(1 + m) of what is allowed.
  const used = typeof room === 'number' ? Math.min(1.5, 1 / (1 + room)) / 1.5 : 0;
  const name = limit.limit.replaceAll('-', ' ');
  return element(
    'tr',
    { 'data-verdict': limit.verdict },
    element(
      'th',
      { scope: 'row' },
      isFirst ? part.name : element('span', { class: 'unseen' }, part.name),
      element('small', {}, name),
    ),
    element('td', { class: 'verdict' }, limit.verdict),
    element(
      'td',
      { class: 'number' },
      `${limit.demand === null ? '–' : digits(limit.demand / si)}`,
      element('small', {}, `of ${digits(limit.allowed / si)} ${unit}`),
    ),
    element(
      'td',
      { class: 'number' },
      share,
      element('span', { class: 'used', 'aria-hidden': true }, element('i', { style: `width:${(100 * used).toFixed(1)}%` })),
    ),
  );
}

function worst(part, limit, { drop, command: line }) {
  const found = limit.worst_case;
  const when = found ? `; impact ${found.impact} at ${digits(1e3 * found.time_s)} ms` : '';
  return element(
    'li',
    {},
    element('b', {}, `${part.name}, ${limit.limit.replaceAll('-', ' ')}`),
    `: ${drop ? drop + when : 'no drop was answered'}.`,
    limit.undecided ? element('p', {}, `Undecided: ${limit.governs ? `by ${limit.governs}, ` : ''}${limit.undecided}.`) : undefined,
    limit.decided_by ? element('p', {}, `Decided by: ${limit.decided_by}`) : undefined,
    ...limit.notes.map((note) => element('p', {}, typeof note === 'string' ? note : JSON.stringify(note))),
    line ? command(line) : undefined,
  );
}

// A file that is no text is refused as the command refuses it; one that cannot be read as a product is shown, with what is wrong.
async function opened(file) {
  const most = 1 << 20;
  const bytes = new Uint8Array(await file.slice(0, most + 1).arrayBuffer());
  try {
    const text = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(bytes);
    if (bytes.length > most) await quick.ask({ ask: 'plan', name: file.name, text });
    change(text, { name: file.name });
  } catch (error) {
    const words = error instanceof TypeError ? `cannot read ${file.name}: it is not text in UTF-8` : error.message;
    problem($('product-problem'), new Error(words));
  }
}

async function productBegins() {
  const { shown: worked } = await quick.ask({ ask: 'products' });
  for (const [name] of worked) $('worked').append(element('option', { value: name }, name));
  $('worked').onchange = ({ target }) => {
    const found = worked.find(([name]) => name === target.value);
    if (found) change(found[1], { name: found[0] });
    target.value = '';
  };
  $('open').onchange = ({ target }) => {
    if (target.files[0]) opened(target.files[0]);
    target.value = '';
  };
  $('save').onclick = () => download(product.name, product.text);
  $('undo').onclick = undo;
  $('product-name').onchange = ({ target }) => change(product.text, { name: target.value.trim() || 'product.toml' });
  let typed = 0;
  $('toml').oninput = ({ target }) => {
    const now = performance.now();
    change(target.value, { isNew: now - typed > 1000, typed: true });
    typed = now;
  };
  $('take').onclick = () => {
    set({ q: Number(product.plan.q.toFixed(4)), e: Number(product.plan.e.toFixed(4)) });
    $('film').scrollIntoView({ behavior: bar.still.matches ? 'auto' : 'smooth' });
  };
  new ResizeObserver(() => product.plan && drawPlan(product.plan, product.verdicts, product.zones)).observe($('plan'));
  // What was kept comes after the example, to which Undo leads back; so does what cannot be read.
  const [name, text] = worked[0];
  kept.example = edits({ name, text }, FIRST);
  const before = keptBefore();
  change(text, { name });
  change(before.text ?? text, { name: before.name ?? name });
}
