// Answers one question after the other. What WebAssembly asks of a system is told that there is none; what it says of a panic is kept.
let engine;
let said = '';

function system(module) {
  const text = new TextDecoder();
  const imports = {};
  for (const { module: name, name: call } of WebAssembly.Module.imports(module)) (imports[name] ??= {})[call] = () => 52; // ENOSYS
  const zeros = (...places) => {
    for (const place of places) new DataView(engine.memory.buffer).setUint32(place, 0, true);
    return 0;
  };
  Object.assign(imports.wasi_snapshot_preview1 ?? {}, {
    environ_sizes_get: zeros,
    environ_get: () => 0,
    sched_yield: () => 0,
    random_get: (place, length) => (crypto.getRandomValues(new Uint8Array(engine.memory.buffer, place, length)), 0),
    proc_exit: () => {
      throw new Error(said);
    },
    fd_write(descriptor, list, count, written) {
      const view = new DataView(engine.memory.buffer);
      let all = 0;
      for (let i = 0; i < count; i++) {
        const [at, length] = [view.getUint32(list + 8 * i, true), view.getUint32(list + 8 * i + 4, true)];
        said += text.decode(new Uint8Array(engine.memory.buffer, at, length));
        all += length;
      }
      view.setUint32(written, all, true);
      return 0;
    },
  });
  imports.page = { progress: (done, all) => told(done, all) };
  return imports;
}

// Not more often than a screen shows it.
let last = 0;
function told(done, all) {
  const now = performance.now();
  if (now - last < 50) return;
  last = now;
  postMessage({ progress: all > 0 ? done / all : 0 });
}

function answer(question, file) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const room = engine.room(bytes.length + file.length);
  const given = new Uint8Array(engine.memory.buffer, room, bytes.length + file.length);
  given.set(bytes);
  given.set(file, bytes.length);
  const length = engine.answer(bytes.length);
  return new TextDecoder().decode(new Uint8Array(engine.memory.buffer, engine.told(), length));
}

onmessage = async ({ data: { module, number, question, file } }) => {
  if (module) {
    engine = (await WebAssembly.instantiate(module, system(module))).exports;
    engine._initialize?.();
    return;
  }
  try {
    postMessage({ number, told: answer(question, file ?? new Uint8Array()) });
  } catch (error) {
    postMessage({ number, failed: said.trim() || String(error) });
  }
};
