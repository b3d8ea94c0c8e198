// Search where pages are opened as files: browsers start no workers there. In the place of a worker its script runs in a hidden frame, and gets
// and gives messages as a worker does. Pages from a server keep their workers. (The theme takes it for a shim by its name.)
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      // Begins empty, with the address of this page: its scripts may come from the same folder.
      document.body.appendChild(frame);
      const inside = frame.contentWindow;
      // What a worker calls: answers go to this object alone, and scripts load one after another.
      inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
      const load = (address) =>
        new Promise((loaded, failed) => {
          const script = inside.document.createElement("script");
          script.src = address;
          script.onload = loaded;
          script.onerror = () => failed(new Error(`cannot load ${address}`));
          inside.document.body.appendChild(script);
        });
      inside.importScripts = (...addresses) => addresses.reduce((before, address) => before.then(() => load(address)), Promise.resolve());
      this.inside = inside;
      this.ready = load(String(url));
    }

    postMessage(data) {
      this.ready.then(() => this.inside.dispatchEvent(new MessageEvent("message", { data })));
    }
  };
}
