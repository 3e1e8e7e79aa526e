// Workers that simulate runs. Each run stays with one worker, which remembers its start; of what the page shows only the newest
// question counts, and it alone is ever dropped: somebody waits for each of the others. What is urgent goes before it, what is
// asked aside waits until nothing else is to be done.

export class Pool {
  /** `source` is the worker's text, `campaign` what it loads; `told(run, result)` hears every answer to the newest question,
   *  `broken(words)` that a worker cannot run. */
  constructor(source, campaign, told, broken) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    const count = Math.max(1, Math.min(navigator.hardwareConcurrency || 2, 4, campaign.runs.length));
    Object.assign(this, { told, newest: 0, waiting: new Map(), aside: [], asked: 0 });
    this.workers = Array.from({ length: count }, () => {
      const worker = { thread: new Worker(url), urgent: [], queue: [], aside: [], busy: false };
      worker.thread.onmessage = ({ data }) => this.heard(worker, data);
      worker.thread.onerror = (event) => { event.preventDefault(); broken(event.message); };
      worker.thread.postMessage({ load: campaign });
      return worker;
    });
  }

  /** Simulate these runs, in this order, with these values; `full(run)` says of which the series are wanted. What was asked
   *  here before and is not yet begun is dropped; so what takes long is asked run by run, what is quick in one message. */
  ask(runs, values, exact, full = () => true) {
    this.newest++;
    this.workers.forEach((worker, k) => {
      const own = runs.filter((run) => run % this.workers.length === k).map((run) => ({ run, brief: !full(run) }));
      if (exact) worker.queue = own.map((one) => ({ job: this.newest, ...one, values, exact }));
      else worker.queue = own.length ? [{ job: this.newest, several: own, values, exact }] : [];
      this.next(worker);
    });
    return this.newest;
  }

  /** One question beside these: resolves to its answer. `urgent` goes before what was asked with `ask`. */
  later(message, urgent = false) {
    return new Promise((resolve, reject) => {
      const job = `aside ${++this.asked}`, worker = this.workers[(message.run ?? 0) % this.workers.length];
      this.waiting.set(job, { resolve, reject });
      worker[urgent ? "urgent" : "aside"].push({ ...message, job });
      this.next(worker);
    });
  }

  /** One bare simulation; resolves to its result. */
  trace(record) {
    return this.later({ trace: record }, true);
  }

  next(worker) {
    const queue = [worker.urgent, worker.queue, worker.aside].find((q) => q.length);
    if (worker.busy || !queue) return;
    worker.busy = true;
    worker.thread.postMessage(queue.shift());
  }

  heard(worker, data) {
    if (data.more) return data.job === this.newest ? this.told(data.run, data) : undefined;
    worker.busy = false;
    const waiting = this.waiting.get(data.job);
    this.waiting.delete(data.job);
    this.next(worker);
    if (waiting) return data.error ? waiting.reject(new Error(data.error)) : waiting.resolve(data);
    if (data.job === this.newest) for (const one of data.briefs ?? [data]) this.told(one.run, one);
  }
}
