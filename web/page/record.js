// A file of measured accelerations and its shock response spectrum.

const MOST_BYTES = 256e6; // an engine of 4 GB holds what is read of it
// What a file does not say of itself, by the field that says it.
const UNSAID = { units: 'units', sample_rate: 'rate', full_scale: 'full-scale', sensitivity: 'sensitivity' };
const record = { file: undefined, turn: 0 };

async function measured() {
  if (!record.file) return;
  const turn = ++record.turn;
  const current = () => turn === record.turn;
  if (reader.busy) reader.stop();
  const { name, size } = record.file;
  $('record-state').textContent = `reading ${name} …`;
  try {
    if (size > MOST_BYTES)
      throw new Error(
        `${name} has ${digits(size / 1e6, 3)} MB, and this page reads at most ${MOST_BYTES / 1e6} MB: clatter spectrum ${name} reads it`,
      );
    const file = new Uint8Array(await record.file.arrayBuffer());
    const source = { name, ...Object.fromEntries(Object.entries(UNSAID).map(([key, id]) => [key, $(id).value])) };
    const held = await reader.ask({ ask: 'record', ...source }, file);
    if (!current()) return;
    $('record-state').textContent = 'computing the spectrum …';
    const spectrum = await reader.ask({ ask: 'spectrum', ...source }, file);
    if (!current()) return;
    Object.assign(answers, { record: held.answer, spectrum: spectrum.answer });
    $('record-told').textContent = [held.shown, ...(held.warnings ?? []).map((warning) => `Warning: ${warning}`)]
      .filter(Boolean)
      .join('\n');
    $('record-figures').replaceChildren(...[...held.figures, ...spectrum.figures].map(figure));
    $('record-commands').replaceChildren(command(held.command, held.answer), command(spectrum.command, spectrum.answer));
    $('record-state').textContent = name;
    problem($('record-problem'));
  } catch (error) {
    if (!current()) return;
    $('record-state').textContent = '';
    problem($('record-problem'), error);
  }
}

const reader = new Engine();

function recordBegins() {
  $('record-open').onchange = ({ target }) => {
    if (target.files[0]) {
      record.file = target.files[0];
      measured();
    }
    target.value = '';
  };
  for (const id of Object.values(UNSAID)) $(id).onchange = measured;
}

Engine.module.catch((error) =>
  problem($('page-problem'), new Error(`this browser cannot run the engine of this page: ${error.message}`)),
);
filmBegins();
productBegins();
recordBegins();
