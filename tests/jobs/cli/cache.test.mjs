// `lacuna cache`, on entries as the analysis writes them.

import assert from "node:assert/strict";
import { cpSync, existsSync, readdirSync, readFileSync, utimesSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { root, run, temporaryFolder } from "./command.mjs";

const entries = join(root, "tests/fuzz/corpus/cache_entry");
const names = readdirSync(entries);
const old = new Date(Date.now() - 10 * 24 * 3600 * 1000);

/// A data folder with a cache of three artefacts, one of which was last used ten days ago.
function cache(t) {
  const folder = temporaryFolder(t);
  const cacheFolder = join(folder, "data/cache");
  cpSync(entries, cacheFolder, { recursive: true });
  utimesSync(join(cacheFolder, names[0]), old, old);
  return { folder, cacheFolder };
}

test("cache list: a line an artefact, the last used first", async (t) => {
  const { folder, cacheFolder } = cache(t);
  writeFileSync(join(cacheFolder, "notes.txt"), "of somebody else");
  const { code, out, err } = await run(folder, "cache", "list");
  assert.equal(code, 0, err);
  const lines = out.trimEnd().split("\n");
  assert.equal(lines.length, 5);
  assert.match(lines[0], /^TYPE +SIZE +LAST USED +KEY +OF/);
  assert.ok(lines[3].includes(names[0].replace(".artefact", "")), "the oldest comes last");
  assert.ok(lines[3].includes(old.toISOString().slice(0, 10)));
  assert.match(out, /^skeleton +\d+ bytes  \S+Z  [0-9a-f]{32}  door\.glb  skeleton 3 \{resolution=128\} geometry:00ff$/m);
  assert.match(lines[4], /^3 artefacts, \d+ bytes in .*data\/cache$/);
});

test("cache list: what cannot be read is shown, and no byte of it reaches the terminal", async (t) => {
  const { folder, cacheFolder } = cache(t);
  writeFileSync(join(cacheFolder, names[1]), "\x1b[31mno entry");
  const bytes = readFileSync(join(cacheFolder, names[2]));
  bytes[bytes.indexOf("door.glb")] = 0x1b;
  writeFileSync(join(cacheFolder, names[2]), bytes);
  const { code, out } = await run(folder, "cache", "list");
  assert.equal(code, 0);
  assert.match(out, /^\? .*not an entry of a Lacuna cache/m);
  assert.ok(!out.includes("\x1b"));
});

test("cache verify: exit 1 where an artefact is not whole", async (t) => {
  const { folder, cacheFolder } = cache(t);
  const whole = await run(folder, "cache", "verify");
  assert.equal(whole.code, 0, whole.err);
  assert.match(whole.out, /^3 artefacts, .*: all intact$/m);
  const file = join(cacheFolder, names[1]);
  const bytes = readFileSync(file);
  bytes[bytes.length - 1] ^= 1;
  writeFileSync(file, bytes);
  const damaged = await run(folder, "cache", "verify");
  assert.equal(damaged.code, 1);
  assert.ok(damaged.out.includes(`${file}: damaged (its checksum differs)`), damaged.out);
  assert.match(damaged.out, /: 1 damaged/);
});

test("cache clear: all, or what nobody has used for long; nothing else", async (t) => {
  const { folder, cacheFolder } = cache(t);
  writeFileSync(join(cacheFolder, "notes.txt"), "of somebody else");
  const some = await run(folder, "cache", "clear", "--older-than", "5");
  assert.equal(some.code, 0, some.err);
  assert.match(some.out, /^removed 1 artefact, /);
  assert.ok(!existsSync(join(cacheFolder, names[0])));
  assert.match((await run(folder, "cache", "clear")).out, /^removed 2 artefacts, /);
  assert.deepEqual(readdirSync(cacheFolder), ["notes.txt"]);
  assert.equal((await run(folder, "cache", "clear", "--older-than", "-1")).code, 2);
});

test("cache: none, another folder, and wrong ones", async (t) => {
  const folder = temporaryFolder(t);
  for (const [command, answer] of [["list", /^0 artefacts/m], ["verify", /all intact/], ["clear", /^removed 0/]]) {
    const { code, out, err } = await run(folder, "cache", command);
    assert.equal(code, 0, err);
    assert.match(out, answer);
  }
  assert.ok(!existsSync(join(folder, "data")), "nothing was made");
  assert.match((await run(folder, "cache", "list", "--cache", entries)).out, /^3 artefacts/m);
  writeFileSync(join(folder, "file"), "");
  const wrong = await run(folder, "cache", "list", "--cache", "file");
  assert.equal(wrong.code, 1);
  assert.match(wrong.err, /cannot list file: Not a directory/);
  assert.equal((await run(folder, "cache")).code, 2, "a command is asked for");
});
