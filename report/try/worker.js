// Runs the program: one command after the other, each with files of its own.

import { XzReadableStream } from 'xz-decompress';
import { WASI, Directory, File, OpenFile, PreopenDirectory, ConsoleStdout } from '@bjorn3/browser_wasi_shim';

let program = null;

/** Compiles the program from its compressed bytes. */
async function compiled(bytes) {
  return WebAssembly.compile(await new Response(new XzReadableStream(new Blob([bytes]).stream())).arrayBuffer());
}

/** A command with its files: what it prints, says, and leaves in its folder. */
async function run(args, files) {
  const text = [[], []];
  const into = of => new ConsoleStdout(bytes => text[of].push(bytes.slice()));
  const root = new Map();
  for (const [path, content] of Object.entries(files)) {
    const [name, ...folders] = path.split('/').reverse();
    const inside = folders.reverse().reduce((contents, folder) => {
      if (!contents.has(folder)) contents.set(folder, new Directory(new Map()));
      return contents.get(folder).contents;
    }, root);
    inside.set(name, new File(new TextEncoder().encode(content)));
  }
  const folder = new PreopenDirectory('.', root);
  const wasi = new WASI(['roulement', ...args], [], [new OpenFile(new File([])), into(0), into(1), folder], { debug: false });
  const instance = await WebAssembly.instantiate(await program, { wasi_snapshot_preview1: wasi.wasiImport });
  let code = 1;
  try {
    code = wasi.start(instance);
  } catch (why) {
    // A program that ends by itself is none that has found an answer.
    text[1].push(new TextEncoder().encode(`error: the program ended: ${why}\n`));
  }
  const [out, said] = await Promise.all(text.map(parts => new Blob(parts).text()));
  const left = {};
  const gather = (contents, path) => {
    for (const [name, entry] of contents) {
      if (entry instanceof File) left[path + name] = new TextDecoder().decode(entry.data);
      else gather(entry.contents, `${path}${name}/`);
    }
  };
  gather(folder.dir.contents, '');
  return { code, out, said, files: left };
}

onmessage = async ({ data }) => {
  if (data.program) {
    program = compiled(data.program);
    program.then(() => postMessage({ ready: true }), why => postMessage({ failed: String(why) }));
    return;
  }
  postMessage({ id: data.id, ...(await run(data.args, data.files)) });
};
