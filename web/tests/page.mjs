// The page in Chromium, held to the command: `web/tests/run`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, writeFileSync, truncateSync, openSync, closeSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { after, before, beforeEach, afterEach, test } from 'node:test';
import { fileURLToPath } from 'node:url';

const target = fileURLToPath(new URL('../../target/', import.meta.url));
const { chromium } = createRequire(join(target, 'web/node/'))('playwright-core');
const address = `file://${join(target, 'web/clatter.html')}`;
const folder = mkdtempSync(join(tmpdir(), 'clatter-page-'));

// Files that the tests of records hold.
const records = fileURLToPath(new URL('../../crates/clatter-record/tests/', import.meta.url));
const [data, cases] = ['data', 'cases'].map((of) => (name) => join(records, of, name));

let browser, context, page, complaints;

before(async () => {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ['--no-sandbox'] });
});
after(() => browser.close());
beforeEach(() => open());
afterEach(async () => {
  await context.close();
  assert.deepEqual(complaints, [], 'the console is silent');
});

// Offline, from a file. Without motion, so that nothing moves but what is asked to.
async function open(options = {}) {
  await context?.close();
  context = await browser.newContext({
    offline: true,
    reducedMotion: 'reduce',
    viewport: { width: 1280, height: 900 },
    ...options,
  });
  page = await context.newPage();
  complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  await page.goto(address);
  await answered();
}

// Until the answer to the last change is there, and the pictures after it.
async function answered(timeout = 30_000) {
  await page.waitForFunction(() => document.getElementById('state').textContent.startsWith('Answered'), undefined, { timeout });
}
// The same once the text has become what an act makes of it.
async function changed(act, expected) {
  await act();
  await page.waitForFunction((expected) => document.getElementById('toml').value.includes(expected), expected);
  await answered();
}

const answer = (name) => page.evaluate((name) => window.clatter.answers[name], name);
const text = () => page.inputValue('#toml');
const words = (id) => page.textContent(`#${id}`);

// What the command line that stands on the page prints, run where the files of the page are saved.
function run(line) {
  const path = `${join(target, 'release')}:${process.env.PATH}`;
  return spawnSync('sh', ['-c', line], { cwd: folder, env: { ...process.env, PATH: path }, encoding: 'utf8', maxBuffer: 1 << 28 });
}
async function repeats(place, name) {
  const line = await page.textContent(`${place} code`);
  const { stdout, stderr, status } = run(line);
  assert.ok(status < 2, `${line}: ${stderr}`);
  assert.equal(await answer(name), stdout.trimEnd(), line);
}
// The verdicts that the page shows are those of its answer.
async function shows() {
  const told = JSON.parse(await answer('assess'));
  const cells = await page.$$eval('#limits td.verdict', (cells) => cells.map((cell) => cell.textContent));
  assert.deepEqual(cells, told.components.flatMap((part) => part.limits.map((limit) => limit.verdict)));
  assert.equal(await page.getAttribute('#verdict', 'data-verdict'), told.verdict);
}
async function saved() {
  const [file] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
  await file.saveAs(join(folder, file.suggestedFilename()));
  return readFileSync(join(folder, file.suggestedFilename()), 'utf8');
}

const difference = (before, after) => {
  const [old, fresh] = [before, after].map((text) => text.split('\n'));
  assert.equal(old.length, fresh.length);
  return old.flatMap((line, i) => (line === fresh[i] ? [] : [[line, fresh[i]]]));
};

async function drag(name, x, y = 0) {
  await page.locator('#plan').scrollIntoViewIfNeeded();
  const box = await page.locator(`[data-key="${name}"] rect`).boundingBox();
  const [fromX, fromY] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(fromX, fromY);
  await page.mouse.down();
  for (let k = 1; k <= 8; k++) await page.mouse.move(fromX + (x * k) / 8, fromY + (y * k) / 8);
  await page.mouse.up();
}

test('the answers are those of the command, to the last bit', async () => {
  await saved();
  await repeats('#product-command', 'assess');
  await repeats('#bar-commands .command:first-child', 'impacts');
  await repeats('#bar-commands .command:last-child', 'zone');
  const first = run('clatter assess scanner-wand.toml --model=finite-tilt --format=json');
  assert.equal(await answer('first'), first.stdout.trimEnd(), 'the first answer');
  const line = await page.textContent('#drops code');
  assert.match(line, /^clatter respond --product=scanner-wand.toml --component='scan engine' --worst=acceleration$/);
  const asked = JSON.parse(await answer('assess')).components[0].limits[0].demand;
  assert.ok(run(`${line} --format=json`).stdout.includes(String(asked)), 'the worst drop once more');
});

test('a drag moves one length of the text, and the verdicts follow', async () => {
  const old = await text();
  const wide = (await page.locator('#plan .body').boundingBox()).width;
  await changed(() => drag('component-0', (-40 * wide) / 220), 'position = "55 mm"');
  assert.deepEqual(difference(old, await text()), [['position = "95 mm"', 'position = "55 mm"']]);
  assert.equal(await saved(), await text());
  await repeats('#product-command', 'assess');
  const places = JSON.parse(await answer('assess')).components.map((part) => part.position_m);
  assert.deepEqual(places, [0.055, 0.03, -0.02]);
  await changed(() => page.click('#undo'), 'position = "95 mm"\nextent');
  assert.equal(await text(), old);
});

test('a mass is dragged with both of its ends', async () => {
  const old = await text();
  const wide = (await page.locator('#plan .body').boundingBox()).width;
  await changed(() => drag('mass-1', (20 * wide) / 220, 15), 'from = "-70 mm", to = "-10 mm"');
  assert.equal(difference(old, await text()).length, 1);
  await saved();
  await repeats('#product-command', 'assess');
});

test('arrow keys move a part, and it keeps the focus', async () => {
  const old = await text();
  await page.focus('[data-key="component-1"]');
  await changed(async () => {
    for (const key of ['ArrowRight', 'ArrowRight', 'Shift+ArrowLeft', 'ArrowUp']) await page.keyboard.press(key);
  }, '"22 mm"');
  assert.deepEqual(difference(old, await text()), [['position = "30 mm"', 'position = "22 mm"']]);
  assert.equal(await page.evaluate(() => document.activeElement.dataset.key), 'component-1');
  assert.equal(await page.getAttribute('[data-key="component-1"]', 'aria-valuetext'), '22 mm along');
});

test('on a plate a part moves both ways, and the latest change wins', async () => {
  await page.selectOption('#worked', 'handheld-terminal.toml');
  await page.waitForFunction(() => document.querySelector('[data-key="component-2"]')?.ariaLabel === 'Part gyroscope');
  const old = await text();
  const wide = (await page.locator('#plan .body').boundingBox()).width;
  const seen = await page.evaluateHandle(() => {
    const seen = [];
    new MutationObserver(() => seen.push(document.getElementById('product-command').textContent)).observe(
      document.getElementById('product-command'),
      { childList: true },
    );
    return seen;
  });
  await drag('component-2', (10 * wide) / 220, (-5 * wide) / 220);
  await page.waitForFunction(() => document.getElementById('toml').value.includes('["-10 mm", "-20 mm"]'));
  assert.deepEqual(difference(old, await text()), [['position = ["-20 mm", "-25 mm"]', 'position = ["-10 mm", "-20 mm"]']]);
  assert.match(await words('state'), /computing|first drops/);
  // The plate takes seconds: it is left for a product that takes less.
  await changed(() => page.selectOption('#worked', 'scanner-wand.toml'), 'Scanner wand');
  await page.waitForTimeout(300);
  const lines = (await seen.jsonValue()).filter((line) => line && !line.startsWith('clatter assess scanner-wand.toml'));
  assert.deepEqual(lines, [], 'no answer to what was left');
  await saved();
  await repeats('#product-command', 'assess');
});

for (const name of ['handheld-terminal.toml', 'handheld-transit.toml']) {
  test(`${name}: what the first drops ask comes first, then the answer of the command, with the picture`, async () => {
    await page.evaluate(() => {
      window.seen = [];
      new MutationObserver(() => {
        const rows = [...document.querySelectorAll('#limits .verdict')].map((cell) => cell.textContent);
        window.seen.push({ rows, command: document.getElementById('product-command').textContent, took: { ...window.clatter.took } });
      }).observe(document.getElementById('product-figures').lastElementChild, { childList: true });
    });
    await page.selectOption('#worked', name);
    await page.waitForFunction((name) => document.querySelector('#product-command code')?.textContent.includes(name), name, {
      timeout: 600_000,
    });
    const demands = async (of) =>
      JSON.parse(await answer(of)).components.flatMap((part) => part.limits.map((limit) => limit.demand));
    const [first, whole] = [await demands('first'), await demands('assess')];
    assert.equal(first.length, whole.length);
    first.forEach((demand, i) => assert.ok(demand > 0 && demand <= whole[i], `${demand} of ${whole[i]}`));
    const verdicts = JSON.parse(await answer('first')).components.map((part) => part.verdict);
    assert.ok(!verdicts.includes('safe'), 'no part is safe before the search is done');
    const seen = await page.evaluate(() => window.seen);
    console.log(`${name}: first ${seen[0].took.first} ms, whole ${seen.at(-1).took.whole} ms`);
    assert.equal(seen[0].command, '', 'no command repeats what was found so far');
    assert.ok(seen[0].took.first < 0.5 * seen.at(-1).took.whole, 'the first answer takes less than half of the time');
    assert.match(await page.textContent('#product-figures figcaption'), /^From above/);
    const svg = decodeURIComponent((await page.getAttribute('#product-figures img', 'src')).split(',').slice(1).join(','));
    const parts = JSON.parse(await answer('assess')).components.map((part) => part.name);
    parts.forEach((part) => assert.ok(svg.includes(`>${part}<`), `${part} is in the picture`));
    await saved();
    await repeats('#product-command', 'assess');
    await shows();
    await page.locator('#product').screenshot({ path: join(target, `web/${name}.png`) });
  });
}

for (const [name, product] of [['phone.toml', 'Phone'], ['laptop.toml', 'Laptop'], ['handheld-terminal.toml', 'Handheld terminal']]) {
  test(`${name}: the answer is that of the command, and its verdicts are shown`, async () => {
    await changed(() => page.selectOption('#worked', name), `name = "${product}"`);
    await saved();
    await repeats('#product-command', 'assess');
    await shows();
  });
}

test('the page and its pictures tell the version', async () => {
  const version = run('clatter --version').stdout.trim();
  assert.equal(await page.textContent('footer p'), version);
  assert.equal(await page.getAttribute('meta[name=generator]', 'content'), version);
  await page.waitForSelector('#product-figures img', { state: 'attached' });
  const svg = decodeURIComponent(await page.getAttribute('#product-figures img', 'src'));
  assert.ok(svg.includes(`<metadata>${version}</metadata>`), svg.slice(0, 400));
  assert.equal(JSON.parse(await answer('impacts')).clatter, version.split(' ')[1]);
});

test('the first verdict comes long before the whole answer', async () => {
  // From the key to the first row of verdicts.
  const first = await page.evaluateHandle(() => {
    const took = [];
    let begun;
    document.addEventListener('keydown', () => (begun = performance.now()), true);
    new MutationObserver(() => {
      if (begun) took.push(Math.round(performance.now() - begun));
      begun = undefined;
    }).observe(document.getElementById('limits'), { childList: true });
    return took;
  });
  const whole = [];
  for (let k = 0; k < 10; k++) {
    await page.focus('[data-key="component-0"]');
    await changed(() => page.keyboard.press('ArrowLeft'), `position = "${94 - k} mm"`);
    whole.push(await page.evaluate(() => window.clatter.took.whole));
  }
  const took = await first.jsonValue();
  console.log(`from a key to the first verdict ${took.join(' ')} ms, to the last ${whole.join(' ')} ms`);
  assert.equal(took.length, 10);
  // Times hang on the machine; of one run, the first takes less than half of the whole.
  const middle = (times) => times.toSorted((a, b) => a - b)[5];
  assert.ok(2 * middle(took) < middle(whole), `${middle(took)} of ${middle(whole)} ms`);
});

test('a broken product is told in the words of the command, and nothing is lost', async () => {
  const old = await text();
  const broken = join(folder, 'broken.toml');
  writeFileSync(broken, old.replace('length', 'lenght').replace('"1 ms"', '"1 mm"'));
  await page.setInputFiles('#open', broken);
  await page.waitForSelector('#product-problem:visible');
  const { stderr } = run('clatter assess broken.toml');
  assert.equal(`${await words('product-problem')}\n`, stderr);
  assert.equal(await page.locator('#plan .thing').count(), 6, 'the plan stays');
  assert.ok((await page.locator('#limits tr').count()) > 0, 'the verdicts stay');
  await changed(() => page.click('#undo'), '"1 ms"');
  assert.equal(await text(), old);
  assert.equal(await page.isVisible('#product-problem'), false);

  writeFileSync(join(folder, 'bytes.toml'), Buffer.from([0x61, 0xff]));
  await page.setInputFiles('#open', join(folder, 'bytes.toml'));
  await page.waitForSelector('#product-problem:visible');
  assert.equal(`error: ${await words('product-problem')}\n`, run('clatter assess bytes.toml').stderr);
  writeFileSync(join(folder, 'large.toml'), `${old}\n${'#'.repeat(2 << 20)}`);
  await page.setInputFiles('#open', join(folder, 'large.toml'));
  await page.waitForFunction(() => document.getElementById('product-problem').textContent.includes('bytes'));
  assert.equal(await text(), old);
});

test('what is no number is told, and the last bar stays', async () => {
  const old = await answer('impacts');
  for (const [field, given, said] of [
    ['q', '', 'q is no number'],
    ['e', '7', /e = 7/],
    ['q', '-1', /q = -1/],
  ]) {
    await page.fill(`#${field}-number`, given);
    await page.waitForSelector('#bar-problem:visible');
    await page.waitForFunction(
      (said) => new RegExp(said).test(document.getElementById('bar-problem').textContent),
      said.source ?? said,
    );
    assert.equal(await answer('impacts'), old);
    await page.fill(`#${field}-number`, { q: '0.5', e: '0.3' }[field]);
    await page.waitForSelector('#bar-problem', { state: 'hidden' });
  }
  await page.click('summary:has-text("Places in numbers")');
  await page.fill('#places input >> nth=0', '');
  await page.keyboard.press('Tab');
  assert.match(await words('product-problem'), /no number/);
  await changed(async () => {
    await page.fill('#places input >> nth=3', '70');
    await page.keyboard.press('Tab');
  }, 'position = "70 mm"\nextent = "20 mm"');
  assert.equal(await page.isVisible('#product-problem'), false);
});

test('q and e are dragged, typed and stepped, and the film goes from impact to impact', async () => {
  const count = async () => JSON.parse(await answer('impacts')).count;
  assert.equal(await count(), 4);
  await page.fill('#q-number', '0.73');
  await page.fill('#e-number', '0.2');
  await page.waitForFunction(() => JSON.parse(window.clatter.answers.impacts).count === 16);
  await repeats('#bar-commands .command:first-child', 'impacts');
  await page.focus('#stage');
  await page.keyboard.press('Home');
  assert.match(await words('caption'), /^Falling/);
  for (const number of [1, 2, 3]) {
    await page.keyboard.press('ArrowRight');
    assert.match(await words('caption'), new RegExp(`^Impact ${number}: end ${number % 2 ? 'a' : 'b'}`));
  }
  const before = await page.inputValue('#scrub');
  await page.keyboard.press(' ');
  await page.waitForFunction((before) => document.getElementById('scrub').value > before, before);
  await page.keyboard.press(' ');
  assert.equal(await words('play'), 'Play');
  // The plane: a pointer and keys.
  const box = await page.locator('#plane .frame').boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.25 * box.height);
  const [q, e] = [await page.inputValue('#q-number'), await page.inputValue('#e-number')].map(Number);
  assert.ok(Math.abs(q - 0.75) < 0.011 && Math.abs(e - 0.4) < 0.011, `${q} ${e}`);
  await page.keyboard.press('ArrowUp');
  assert.equal(Number(await page.inputValue('#q-number')), Math.round(100 * q + 1) / 100);
});

test('a record is read and its spectrum drawn; a broken one is told, and nothing is lost', async () => {
  const rows = Array.from(
    { length: 400 },
    (_, i) => `${(i * 1e-4).toFixed(4)},${(i < 110 ? 50 * Math.sin((Math.PI * i) / 110) : 0).toFixed(4)}`,
  );
  writeFileSync(join(folder, 'half sine.csv'), `time [s],az [g]\n${rows.join('\n')}\n`);
  await page.setInputFiles('#record-open', join(folder, 'half sine.csv'));
  await page.waitForSelector('#record-figures img >> nth=1');
  await repeats('#record-commands .command:first-child', 'record');
  await repeats('#record-commands .command:last-child', 'spectrum');

  const spectrum = await answer('spectrum');
  writeFileSync(join(folder, 'torn.csv'), 'time [s],a [g]\n0,0\n0.001,50\n0.002,x\n');
  await page.setInputFiles('#record-open', join(folder, 'torn.csv'));
  await page.waitForSelector('#record-problem:visible');
  assert.ok(run('clatter spectrum torn.csv').stderr.startsWith(`error: ${await words('record-problem')}\n`));
  assert.equal(await answer('spectrum'), spectrum);
  assert.equal(await page.locator('#record-figures img').count(), 2, 'the figures stay');

  // Units that the file does not name.
  writeFileSync(join(folder, 'bare.csv'), `t,a\n${rows.join('\n')}\n`);
  await page.setInputFiles('#record-open', join(folder, 'bare.csv'));
  await page.waitForFunction(() => document.getElementById('record-problem').textContent.startsWith('bare.csv'));
  await page.fill('#units', 's,g');
  await page.keyboard.press('Tab');
  await page.waitForFunction((old) => window.clatter.answers.spectrum !== old, spectrum);
  await repeats('#record-commands .command:last-child', 'spectrum');
  assert.match(await page.textContent('#record-commands code'), /--units=s,g/);

  const huge = join(folder, 'huge.csv');
  closeSync(openSync(huge, 'w'));
  truncateSync(huge, 400e6);
  await page.setInputFiles('#record-open', huge);
  await page.waitForFunction(() => document.getElementById('record-problem').textContent.includes('at most 256 MB'));
});

test('all that is operated has a name, and the order of tabs shows where it is', async () => {
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, input, select, textarea, [tabindex]')]
      .filter((node) => {
        const label =
          node.getAttribute('aria-label') ?? [...(node.labels ?? [])].map((label) => label.textContent).join('') + node.textContent;
        return label.trim() === '';
      })
      .map((node) => node.outerHTML),
  );
  assert.deepEqual(nameless, []);
  for (let k = 0; k < 40; k++) {
    await page.keyboard.press('Tab');
    const [name, shown] = await page.evaluate(() => {
      const node = document.activeElement;
      const style = getComputedStyle(node.closest('.button') ?? node);
      const rect = node.querySelector?.('rect');
      return [node.outerHTML.slice(0, 80), style.outlineStyle !== 'none' || (rect && getComputedStyle(rect).strokeWidth !== '0px')];
    });
    assert.ok(shown, name);
  }
});

// Words of a picture that stand on other words of it, or beyond its side.
const unreadable = () =>
  page.evaluate(() =>
    [...document.querySelectorAll('svg')].flatMap((svg) => {
      const frame = svg.getBoundingClientRect();
      const boxes = [...svg.querySelectorAll('text')].map((text) => [text.textContent, text.getBoundingClientRect()]);
      const seen = boxes.filter(([, box]) => box.width > 0);
      const beyond = seen.filter(([, box]) => box.left < frame.left - 1 || box.right > frame.right + 1);
      const on = ([, a], [, b]) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 3 && b.top < a.bottom - 3;
      const covered = seen.filter((one, i) => seen.some((other, k) => k < i && on(one, other)));
      return [...beyond, ...covered].map(([words]) => `${svg.id} ${words}`);
    }),
  );

for (const colorScheme of ['light', 'dark']) {
  for (const width of [350, 800, 1400]) {
    test(`${width} pixels wide, ${colorScheme}: nothing is beyond the side, and no words on others`, async () => {
      await open({ colorScheme, viewport: { width, height: 900 } });
      await page.waitForSelector('#product-figures img >> nth=2', { state: 'attached' });
      await page.setInputFiles('#record-open', data('even.uff'));
      await page.waitForSelector('#record-figures img >> nth=1');
      await page.evaluate(() => document.querySelectorAll('details').forEach((details) => (details.open = true)));
      const wide = () => page.evaluate(() => document.documentElement.scrollWidth);
      assert.equal(await wide(), width);
      assert.deepEqual(await unreadable(), []);
      await page.screenshot({ path: join(target, `web/${width}-${colorScheme}.png`), fullPage: true });
      // That of README.
      if (width === 1400 && colorScheme === 'light') {
        await page.evaluate(() => {
          document.querySelectorAll('#product details').forEach((details) => (details.open = false));
          document.getElementById('state').textContent = '';
        });
        const { x, y } = await page.locator('#product').boundingBox();
        const clip = { x: x - 20, y: y + (await page.evaluate(() => window.scrollY)), width: 1160, height: 818 };
        await page.screenshot({ path: join(target, 'web/page.png'), fullPage: true, clip });
      }
      if (colorScheme === 'dark') return;
      for (const name of await page.$$eval('#worked option[value]:not([value=""])', (options) => options.map(({ value }) => value))) {
        await page.selectOption('#worked', name);
        // The plan and its names are there; of plates that is enough.
        await page.waitForFunction((name) => {
          const [command, state] = ['product-command', 'state'].map((id) => document.getElementById(id).textContent);
          return command.includes(name) || (document.querySelector('.cross') && /%|first drops/.test(state));
        }, name);
        assert.equal(await wide(), width, name);
        assert.deepEqual(await unreadable(), [], name);
      }
      // Two parts of a plate beside one another, whose names would be one on the other.
      await page.selectOption('#worked', 'handheld-terminal.toml');
      await page.waitForSelector('.cross', { state: 'attached' });
      const beside = (await text()).replace('["-20 mm", "-25 mm"]', '["75 mm", "15 mm"]');
      await page.fill('#toml', beside);
      await page.waitForFunction(() => document.querySelector('[data-key="component-2"]').ariaValueText === '75 mm along, 15 mm across');
      assert.deepEqual(await unreadable(), [], 'beside one another');
      // Names without an end, and what is refused.
      await page.selectOption('#worked', 'scanner-wand.toml');
      const endless = (await text()).replaceAll('display', 'd'.repeat(80)).replaceAll('Scanner wand', 'S'.repeat(80));
      await changed(() => page.fill('#toml', endless), 'd'.repeat(80));
      assert.equal(await wide(), width, 'long names');
      await page.fill('#toml', `${endless}\nmore = "${'m'.repeat(300)}"`);
      await page.waitForSelector('#product-problem:visible');
      assert.equal(await wide(), width, 'a problem');
    });
  }
}

test('what is edited is there again after a reload, and Undo leads back to the example', async () => {
  const example = await text();
  assert.equal(await page.evaluate(() => localStorage.length), 0, 'of the example nothing is kept');
  await page.focus('[data-key="component-0"]');
  await changed(() => page.keyboard.press('ArrowLeft'), 'position = "94 mm"');
  await page.fill('#product-name', 'mine.toml');
  await page.keyboard.press('Tab');
  await page.fill('#q-number', '0.73');
  await page.fill('#threshold-number', '1.5');
  const edited = await text();
  const again = async () => {
    await answered();
    await page.waitForFunction(() => JSON.parse(window.clatter.answers.impacts).q === 0.73);
    assert.equal(await text(), edited);
    assert.equal(await page.inputValue('#product-name'), 'mine.toml');
    assert.equal(await page.inputValue('#q-slider'), '0.73');
    assert.equal(await page.inputValue('#threshold-number'), '1.5');
    await saved();
    await repeats('#product-command', 'assess');
  };
  await page.reload();
  await again();
  // Left, and come back to.
  await page.goto('about:blank');
  await page.goto(address);
  await again();
  await changed(() => page.click('#undo'), 'position = "95 mm"');
  assert.equal(await text(), example);
  await page.fill('#q-number', '0.5');
  await page.fill('#threshold-number', '1');
  assert.equal(await page.evaluate(() => localStorage.length), 0, 'nor after the way back');
  await page.reload();
  await answered();
  assert.equal(await text(), example);
});

test('what cannot be read of what was kept breaks nothing', async () => {
  const example = await text();
  const begun = async (kept) => {
    await page.evaluate((kept) => localStorage.setItem('clatter', kept), kept);
    await page.reload();
    await page.waitForFunction(() => window.clatter?.answers.impacts && document.querySelectorAll('#limits tr').length > 0);
  };
  for (const kept of ['', '{', 'null', '[]', '7', '{"text":5,"q":"0.7","e":null,"name":{}}', '{"q":9,"e":-1,"threshold":-3}']) {
    await begun(kept);
    await answered();
    assert.equal(await text(), example, kept);
    assert.equal(JSON.parse(await answer('impacts')).q, 0.5, kept);
    assert.equal(await page.isVisible('#bar-problem'), false, kept);
  }
  await begun(JSON.stringify({ name: 'torn.toml', text: '[product\nlength' }));
  await page.waitForSelector('#product-problem:visible');
  assert.match(await words('product-problem'), /torn\.toml/);
  assert.equal(await text(), '[product\nlength', 'what was written is not lost');
  assert.equal(await page.locator('#plan .thing').count(), 6, 'the plan of the example');
  await page.click('#undo');
  await answered();
  assert.equal(await text(), example);
});

test('where nothing can be kept, leaving asks; else it does not', async () => {
  let asked;
  page.on('dialog', (dialog) => {
    asked = dialog.type() === 'beforeunload';
    dialog.accept();
  });
  const asks = async () => {
    asked = false;
    await page.reload();
    await answered();
    return asked;
  };
  const edit = async () => {
    await page.click('[data-key="component-0"]');
    await changed(() => page.keyboard.press('ArrowLeft'), 'position = "94 mm"');
  };
  await edit();
  assert.equal(await asks(), false, 'kept');
  await changed(() => page.click('#undo'), 'position = "95 mm"');
  // More than is kept.
  await page.click('#toml');
  const large = `${await text()}#${'x'.repeat(1_040_000)}\n#${'"'.repeat(5000)}`;
  await changed(() => page.fill('#toml', large), 'xxx');
  assert.match(await words('kept'), /save it/);
  assert.equal(await asks(), true, 'too large');
  await context.addInitScript(() => {
    Storage.prototype.setItem = () => {
      throw new DOMException('no room', 'QuotaExceededError');
    };
  });
  await page.evaluate(() => localStorage.clear());
  await page.reload();
  await answered();
  assert.equal(await asks(), false, 'without edits');
  await edit();
  assert.match(await words('kept'), /save it/);
  assert.equal(await asks(), true, 'no room');
});

test('what is dragged stops at the edge', async () => {
  const wide = (await page.locator('#plan .body').boundingBox()).width;
  await changed(() => drag('component-0', wide), 'position = "100 mm"\nextent = "20 mm"');
  await changed(() => drag('mass-1', -wide), 'from = "-110 mm", to = "-50 mm"');
  await page.focus('[data-key="component-1"]');
  await changed(async () => {
    for (let k = 0; k < 6; k++) await page.keyboard.press('Shift+ArrowRight');
  }, 'position = "65 mm"\nextent = "90 mm"');
  assert.equal(await page.isVisible('#product-problem'), false);
  // A number that is typed is taken as it is, and told.
  await page.click('summary:has-text("Places in numbers")');
  await page.fill('#places input >> nth=3', '170');
  await page.keyboard.press('Tab');
  await page.waitForSelector('#product-problem:visible');
  assert.match(await text(), /position = "170 mm"/);
  // From beyond the edge it is dragged back.
  await changed(() => drag('component-0', -0.5 * wide), 'position = "60 mm"');
});

test('nothing moves under the pointer', async () => {
  const at = (selector) => page.locator(selector).boundingBox();
  // A part whose row is at the foot of the window.
  await page.setViewportSize({ width: 800, height: 600 });
  await page.evaluate(() => {
    const rect = document.querySelector('[data-key="component-2"] rect').getBoundingClientRect();
    window.scrollBy(0, rect.top - window.innerHeight + 8);
  });
  const scrolled = () => page.evaluate(() => window.scrollY);
  const [before, part] = [await scrolled(), await at('[data-key="component-2"] rect')];
  await page.mouse.move(part.x + part.width / 2, part.y + 4);
  await page.mouse.down();
  await page.mouse.move(part.x + part.width / 2 + 30, part.y + 4);
  await page.mouse.up();
  await page.waitForFunction(() => !document.getElementById('toml').value.includes('position = "-20 mm"'));
  assert.equal(await scrolled(), before);
  await answered();
  // A plan while its text becomes one that is refused, and one that is warned of.
  await page.setViewportSize({ width: 1400, height: 900 });
  await page.evaluate(() => document.getElementById('product').scrollIntoView());
  const plan = await at('#plan');
  const good = await text();
  await page.fill('#toml', `${good}\nmore = 1\n`);
  await page.waitForSelector('#product-problem:visible');
  assert.deepEqual(await at('#plan'), plan);
  const told = await at('#product-problem');
  assert.ok(told.y > plan.y && told.y + told.height <= 900, 'what is wrong is in sight');
  await page.fill('#toml', `${good}\n[verdict]\nreliability = 0.99\n`);
  await page.waitForSelector('#product-warnings:visible');
  assert.deepEqual(await at('#plan'), plan);
  await page.fill('#toml', good);
  await page.waitForSelector('#product-warnings', { state: 'hidden' });
  // The plane of q and e while a problem goes away.
  await page.fill('#e-number', '7');
  await page.waitForSelector('#bar-problem:visible');
  const frame = await at('#plane .frame');
  const [x, y] = [frame.x + 0.4 * frame.width, frame.y + 0.25 * frame.height];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.waitForSelector('#bar-problem', { state: 'hidden' });
  await page.mouse.move(x + 1, y);
  await page.mouse.up();
  assert.ok(Math.abs(Number(await page.inputValue('#q-number')) - 0.75) < 0.02, await page.inputValue('#q-number'));
});

test('a file of each kind is opened, with what the fields say of it', async () => {
  const rows = Array.from({ length: 200 }, (_, i) => `${i / 1e4}\t${(i < 110 ? 2 * Math.sin((Math.PI * i) / 110) : 0).toFixed(5)}`);
  writeFileSync(join(folder, 'volts.txt'), `time [s]\tsensor [V]\n${rows.join('\n')}\n`);
  const kinds = [
    [cases('h_labview.lvm'), {}],
    [join(folder, 'volts.txt'), { sensitivity: '100mV/g' }],
    [data('even.uff'), {}],
    [data('c_order.npy'), { units: 's,g' }],
    [data('one_i2_big.npy'), { units: 'g', rate: '10 kHz' }],
    [data('i16_two.wav'), { 'full-scale': '50g' }],
    [data('f32.wav'), { units: 'mg' }],
    [data('plain.mat'), { units: 'g', rate: '1024 Hz' }],
    [data('daqmx.tdms'), {}],
  ];
  for (const [path, fields] of kinds) {
    const name = basename(path);
    if (dirname(path) !== folder) copyFileSync(path, join(folder, name));
    for (const id of ['units', 'rate', 'full-scale', 'sensitivity']) await page.fill(`#${id}`, '');
    await page.setInputFiles('#record-open', join(folder, name));
    if (Object.keys(fields).length > 0) {
      await page.waitForFunction((name) => document.getElementById('record-problem').textContent.startsWith(name), name);
      for (const [id, value] of Object.entries(fields)) await page.fill(`#${id}`, value);
      await page.keyboard.press('Tab');
    }
    await page.waitForFunction((name) => document.getElementById('record-state').textContent === name, name);
    assert.equal(await page.isVisible('#record-problem'), false, name);
    assert.equal(await page.locator('#record-figures img').count(), 2, name);
    await repeats('#record-commands .command:first-child', 'record');
    await repeats('#record-commands .command:last-child', 'spectrum');
    const flags = { units: '--units', rate: '--sample-rate', 'full-scale': '--full-scale', sensitivity: '--sensitivity' };
    const line = await page.textContent('#record-commands code');
    for (const id of Object.keys(flags)) assert.equal(line.includes(flags[id]), id in fields, line);
  }
  // Fields that say nothing that can be read.
  for (const [id, given, said] of [
    ['full-scale', '-5g', /^full scale: .*not finite and > 0/],
    ['sensitivity', '5 V', /^sensitivity: .*100mV\/g/],
  ]) {
    await page.fill(`#${id}`, given);
    await page.keyboard.press('Tab');
    await page.waitForSelector('#record-problem:visible');
    assert.match(await words('record-problem'), said);
    await page.fill(`#${id}`, '');
    await page.keyboard.press('Tab');
    await page.waitForSelector('#record-problem', { state: 'hidden' });
  }
});

test('figures are reached by keys, and rolled where they are wider than the window', async () => {
  await open({ viewport: { width: 350, height: 700 } });
  await page.waitForSelector('#product-figures img >> nth=2', { state: 'attached' });
  await page.focus('#product-figures summary');
  for (const name of await page.$$eval('#product-figures img', (images) => images.map(({ alt }) => alt))) {
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement.querySelector('img')?.alt), name);
  }
  await page.focus('#product-figures figure');
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.activeElement.scrollLeft > 0);
  await page.focus('#stems');
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  assert.match(await words('caption'), /^Impact 1: end a/);
});

test('the film begins by itself where motion is welcome', async () => {
  await open({ reducedMotion: 'no-preference' });
  assert.equal(await words('play'), 'Pause');
  await open({ reducedMotion: 'reduce' });
  assert.equal(await words('play'), 'Play');
});
