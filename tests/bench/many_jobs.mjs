// A service's data folder with very many jobs.
import fs from "node:fs";
import path from "node:path";

export const many = 10000;

/// `many` copies of the finished job in the folder `template`, with `more` of its files, under other
/// names and with times of their own.
export function fill(data, template, more = []) {
  const state = JSON.parse(fs.readFileSync(path.join(template, "state.json")));
  const letters = "abcdefghijklmnopqrstuvwxyz";
  for (let i = 0; i < many; i += 1) {
    const created = new Date(Date.UTC(2026, 0, 1) + 60000 * i).toISOString();
    const stamp = created.replace(/[-:]/g, "").replace("T", "-").slice(0, 15);
    const name = [0, 1, 2, 3, 4, 5].map((k) => letters[Math.floor(i / 26 ** k) % 26]).join("");
    const dir = path.join(data, "jobs", `${stamp}-${name}`);
    fs.mkdirSync(dir);
    for (const file of ["job.json", "progress.json", "report.json", "curve.csv", ...more]) {
      fs.copyFileSync(path.join(template, file), path.join(dir, file));
    }
    fs.writeFileSync(path.join(dir, "state.json"), JSON.stringify({ ...state, created, finished: created }));
  }
}
