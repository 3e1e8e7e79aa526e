// Workers that simulate runs. Each run stays with one worker, which remembers its start; only the newest question counts.

export class Pool {
  /** `source` is the worker's text, `campaign` what it loads; `told(run, result)` hears every answer to the newest question. */
  constructor(source, campaign, told) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    const count = Math.max(1, Math.min(navigator.hardwareConcurrency || 2, 4, campaign.runs.length));
    this.told = told;
    this.newest = 0;
    this.workers = Array.from({ length: count }, () => {
      const worker = { thread: new Worker(url), queue: [], busy: false };
      worker.thread.onmessage = ({ data }) => this.heard(worker, data);
      worker.thread.postMessage({ load: campaign });
      return worker;
    });
    this.waiting = new Map();
  }

  /** Simulate these runs, in this order, with these values. Questions not yet begun are dropped. */
  ask(runs, values, exact) {
    this.newest++;
    for (const worker of this.workers) worker.queue = [];
    for (const run of runs)
      this.workers[run % this.workers.length].queue.push({ job: this.newest, run, values, exact });
    this.workers.forEach((worker) => this.next(worker));
    return this.newest;
  }

  /** One bare simulation; resolves to its result. */
  trace(record) {
    return new Promise((resolve, reject) => {
      const job = `trace ${this.waiting.size} ${performance.now()}`;
      this.waiting.set(job, { resolve, reject });
      this.workers[0].thread.postMessage({ job, trace: record });
    });
  }

  next(worker) {
    if (worker.busy || !worker.queue.length) return;
    worker.busy = true;
    worker.thread.postMessage(worker.queue.shift());
  }

  heard(worker, data) {
    if (this.waiting.has(data.job)) {
      const { resolve, reject } = this.waiting.get(data.job);
      this.waiting.delete(data.job);
      return data.error ? reject(new Error(data.error)) : resolve(data);
    }
    worker.busy = false;
    this.next(worker);
    if (data.job === this.newest) this.told(data.run, data);
  }
}
