// The program in a worker: commands wait in line, and each gives what it printed, said and left.

export class Program {
  /** From elements whose text is the program (xz, base64) and the worker's script. */
  constructor(program, script) {
    this.waiting = new Map();
    this.count = 0;
    this.worker = new Worker(URL.createObjectURL(new Blob([script.textContent], { type: 'text/javascript' })));
    this.ready = new Promise((resolve, reject) => {
      this.worker.onmessage = ({ data }) => {
        if (data.ready) resolve();
        else if (data.failed) reject(new Error(data.failed));
        else { this.waiting.get(data.id)(data); this.waiting.delete(data.id); }
      };
      this.worker.onerror = why => reject(new Error(why.message));
    });
    this.worker.postMessage({ program: Uint8Array.from(atob(program.textContent), c => c.charCodeAt(0)) });
  }

  /** Runs a command in a folder with these files, texts by their names. */
  run(args, files = {}) {
    const id = ++this.count;
    return new Promise(resolve => {
      this.waiting.set(id, resolve);
      this.worker.postMessage({ id, args, files });
    });
  }
}
