// Runs the real `lacuna` for the tests beside this file.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
export const program = join(process.env.LACUNA_BIN ?? join(root, "build/release/bin"), "lacuna");

/// A folder of one test, removed after it.
export function temporaryFolder(test) {
  const folder = mkdtempSync(join(tmpdir(), "lacuna-cli-"));
  test.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/// Starts `lacuna ARGS` in `folder`; `ended` gives {code, signal, out, err}.
export const start = (folder, ...args) => startWith([], folder, ...args);

/// The same by a program in front, as ["nice"].
export function startWith(front, folder, ...args) {
  const [command, ...rest] = [...front, program, ...args];
  const child = spawn(command, rest, {
    cwd: folder,
    env: { ...process.env, LACUNA_DATA: join(folder, "data"), LACUNA_SCENES: `${join(root, "jobs/scenes")}:${folder}` },
  });
  let out = "";
  let err = "";
  child.stdout.on("data", (bytes) => (out += bytes));
  child.stderr.on("data", (bytes) => (err += bytes));
  const ended = new Promise((done) => child.on("close", (code, signal) => done({ code, signal, out, err })));
  return { child, ended };
}

export const run = (folder, ...args) => start(folder, ...args).ended;

/// Writes a job file; text or an object laid over a small good job.
export function job(folder, name, content) {
  const file = join(folder, name);
  const base = { scene: "cornell.glb", resolution: [24, 16], budget: { iterations: 2 } };
  writeFileSync(file, typeof content === "string" ? content : JSON.stringify({ ...base, ...content }));
  return file;
}
