// A service's data folder with very many jobs.
import fs from "node:fs";
import path from "node:path";

export const many = 10000;

/// `count` copies of the finished job in the folder `template`, with `more` of its files, under other
/// names and with times of their own. Every `every`-th of them waits (0: none).
export function fill(data, template, { more = [], count = many, every = 0 } = {}) {
  const state = JSON.parse(fs.readFileSync(path.join(template, "outcome.json")));
  const files = ["job.json", "progress.json", "report.json", "curve.csv", ...more]
    .map((name) => [name, fs.readFileSync(path.join(template, name))]);
  const letters = "abcdefghijklmnopqrstuvwxyz";
  for (let i = 0; i < count; i += 1) {
    const created = new Date(Date.UTC(2026, 0, 1) + 60000 * i).toISOString();
    const stamp = created.replace(/[-:]/g, "").replace("T", "-").slice(0, 15);
    const name = [0, 1, 2, 3, 4, 5].map((k) => letters[Math.floor(i / 26 ** k) % 26]).join("");
    const dir = path.join(data, "jobs", `${stamp}-${name}`);
    fs.mkdirSync(dir);
    const waits = every > 0 && i % every === 0;
    for (const [file, content] of files) {
      if (!waits || file === "job.json") fs.writeFileSync(path.join(dir, file), content);
    }
    fs.writeFileSync(path.join(dir, "outcome.json"), JSON.stringify(waits
      ? { state: "queued", attempts: 0, created } : { ...state, created, finished: created }));
  }
}
