// Workers with the engine: `quick` for what takes some milliseconds, `slow` for what may take long and may be stopped.

// What `lzma.rs` has packed, where each kind of bit has its chances at the same places.
function unpacked(packed) {
  const out = new Uint8Array(new DataView(packed.buffer).getUint32(0));
  const chances = new Uint16Array(1020 + 8 * 0x300).fill(1024);
  let [at, range, code, n, state] = [8, 0xffffffff, new DataView(packed.buffer).getUint32(4), 0, 0];
  const distances = [0, 0, 0, 0];

  const next = () => {
    if (range >= 0x1000000) return;
    range = (range << 8) >>> 0;
    code = ((code << 8) | packed[at++]) >>> 0;
  };
  const bit = (place) => {
    const chance = chances[place];
    const bound = (range >>> 11) * chance;
    const is = code >= bound;
    if (is) {
      range -= bound;
      code -= bound;
      chances[place] -= chance >> 5;
    } else {
      range = bound;
      chances[place] += (2048 - chance) >> 5;
    }
    next();
    return is ? 1 : 0;
  };
  const plain = () => {
    range >>>= 1;
    const is = code >= range;
    if (is) code -= range;
    next();
    return is ? 1 : 0;
  };
  const tree = (base, count) => {
    let m = 1;
    for (let k = 0; k < count; k++) m = 2 * m + bit(base + m);
    return m - (1 << count);
  };
  const reversed = (base, count) => {
    let [m, value] = [1, 0];
    for (let k = 0; k < count; k++) {
      const is = bit(base + m);
      m = 2 * m + is;
      value |= is << k;
    }
    return value;
  };
  const length = (base) => (!bit(base) ? 2 + tree(base + 2, 3) : !bit(base + 1) ? 10 + tree(base + 10, 3) : 18 + tree(base + 18, 8));
  const distance = (length) => {
    const slot = tree(72 + 64 * Math.min(length - 2, 3), 6);
    if (slot < 4) return slot;
    const count = (slot >> 1) - 1;
    const base = (2 | (slot & 1)) << count;
    if (slot < 14) return base + reversed(328 + base - slot, count);
    let high = 0;
    for (let k = 4; k < count; k++) high = 2 * high + plain();
    return base + 16 * high + reversed(456, 4);
  };
  const literal = () => {
    const base = 1020 + 0x300 * (n > 0 ? out[n - 1] >> 5 : 0);
    let symbol = 1;
    if (state >= 7) {
      const beside = out[n - distances[0] - 1];
      for (let k = 7; k >= 0 && symbol < 0x100; k--) {
        const other = (beside >> k) & 1;
        const is = bit(base + ((1 + other) << 8) + symbol);
        symbol = 2 * symbol + is;
        if (is !== other) break;
      }
    }
    while (symbol < 0x100) symbol = 2 * symbol + bit(base + symbol);
    out[n++] = symbol;
    state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
  };
  const copy = () => {
    const isEarly = state < 7;
    let count;
    if (!bit(12 + state)) {
      count = length(472);
      distances.unshift(distance(count));
      distances.pop();
      state = isEarly ? 7 : 10;
    } else {
      const which = !bit(24 + state) ? 0 : !bit(36 + state) ? 1 : !bit(48 + state) ? 2 : 3;
      const isShort = which === 0 && !bit(60 + state);
      count = isShort ? 1 : length(746);
      distances.unshift(...distances.splice(which, 1));
      state = isShort ? (isEarly ? 9 : 11) : isEarly ? 8 : 11;
    }
    for (const end = Math.min(n + count, out.length); n < end; n++) out[n] = out[n - distances[0] - 1];
  };
  while (n < out.length) bit(state) ? copy() : literal();
  return out;
}

class Stopped extends Error {}

class Engine {
  static module = Promise.resolve(document.getElementById('wasm').textContent).then((text) =>
    WebAssembly.compile(unpacked(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)))),
  );
  static source = URL.createObjectURL(new Blob([document.getElementById('worker').textContent], { type: 'text/javascript' }));

  constructor() {
    this.number = 0;
    this.waiting = new Map();
  }

  start() {
    const worker = new Worker(Engine.source);
    this.worker = worker;
    this.ready = Engine.module.then((module) => worker.postMessage({ module }));
    worker.onmessage = ({ data }) => {
      if (data.progress !== undefined) return this.progress?.(data.progress);
      const waits = this.waiting.get(data.number);
      this.waiting.delete(data.number);
      if (data.told !== undefined) return waits?.resolve(data.told);
      // Its memory is not to be trusted any more: the next question begins anew.
      waits?.reject(new Error(`the engine of this page failed: ${data.failed}`));
      this.stop();
    };
  }

  // What a question is told; a refusal is an error with the words of the command.
  async ask(question, file) {
    if (!this.worker) this.start();
    const worker = this.worker;
    await this.ready;
    if (worker !== this.worker) throw new Stopped();
    const number = ++this.number;
    const told = await new Promise((resolve, reject) => {
      this.waiting.set(number, { resolve, reject });
      worker.postMessage({ number, question, file });
    });
    const answer = JSON.parse(told);
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer;
  }

  get busy() {
    return this.waiting.size > 0;
  }

  // Leaves what it is at.
  stop() {
    this.worker?.terminate();
    this.worker = undefined;
    for (const { reject } of this.waiting.values()) reject(new Stopped());
    this.waiting.clear();
  }
}

const quick = new Engine();
const slow = new Engine();

// The texts of the last answers, as the command prints them: for scripts, and for the tests of the page.
const answers = {};
window.clatter = { answers };
