// The page in Chromium, held to the command: `web/tests/run`.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync, truncateSync, openSync, closeSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, beforeEach, afterEach, test } from 'node:test';
import { fileURLToPath } from 'node:url';

const target = fileURLToPath(new URL('../../target/', import.meta.url));
const { chromium } = createRequire(join(target, 'web/node/'))('playwright-core');
const address = `file://${join(target, 'web/clatter.html')}`;
const folder = mkdtempSync(join(tmpdir(), 'clatter-page-'));

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
  await page.waitForFunction(() => document.querySelector('[data-key="component-2"] text')?.textContent === 'gyroscope');
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
      timeout: 120_000,
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

for (const colorScheme of ['light', 'dark']) {
  for (const width of [375, 768, 1280]) {
    test(`${width} pixels wide, ${colorScheme}: nothing is beyond the side`, async () => {
      await open({ colorScheme, viewport: { width, height: 900 } });
      await page.waitForSelector('#product-figures img >> nth=2', { state: 'attached' });
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
      await page.screenshot({ path: join(target, `web/${width}-${colorScheme}.png`), fullPage: true });
      // That of README.
      if (width === 1280 && colorScheme === 'light') {
        await page.evaluate(() => {
          document.getElementById('product-figures').open = false;
          document.getElementById('state').textContent = '';
        });
        const { x, y } = await page.locator('#product').boundingBox();
        const clip = { x: x - 20, y: y + (await page.evaluate(() => window.scrollY)), width: 1160, height: 818 };
        await page.screenshot({ path: join(target, 'web/page.png'), fullPage: true, clip });
      }
    });
  }
}

test('the film begins by itself where motion is welcome', async () => {
  await open({ reducedMotion: 'no-preference' });
  assert.equal(await words('play'), 'Pause');
  await open({ reducedMotion: 'reduce' });
  assert.equal(await words('play'), 'Play');
});
