// Workers with the engine: `quick` for what takes some milliseconds, `slow` for what may take long and may be stopped.

async function unpacked(id) {
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

class Stopped extends Error {}

class Engine {
  static module = unpacked('wasm').then((bytes) => WebAssembly.compile(bytes));
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
