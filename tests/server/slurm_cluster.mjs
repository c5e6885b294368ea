// A stand-in for a cluster with Slurm: its programs, and what they know.
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const fake = path.join(path.dirname(fileURLToPath(import.meta.url)), "fake_slurm.mjs");

/// A cluster in a folder of its own.
export class Cluster {
  constructor(root) {
    this.folder = path.join(root, "slurm");
    const bin = path.join(root, "bin");
    for (const folder of [this.folder, bin]) fs.mkdirSync(folder);
    for (const name of ["sbatch", "squeue", "sacct", "scancel", "scontrol"]) fs.symlinkSync(fake, path.join(bin, name));
    this.environment = [`PATH=${bin}:${process.env.PATH}`, `FAKE_SLURM=${this.folder}`];
  }

  set(...whats) { for (const what of whats) fs.writeFileSync(path.join(this.folder, what), ""); }
  unset(...whats) { for (const what of whats) fs.rmSync(path.join(this.folder, what), { force: true }); }

  jobs() {
    return fs.readdirSync(this.folder).filter((n) => /^\d+\.json$/.test(n)).sort((a, b) => parseInt(a) - parseInt(b))
      .map((n) => JSON.parse(fs.readFileSync(path.join(this.folder, n), "utf8")));
  }

  change(id, more) {
    const file = path.join(this.folder, `${id}.json`);
    const job = { ...JSON.parse(fs.readFileSync(file, "utf8")), ...more };
    fs.writeFileSync(`${file}.new`, JSON.stringify(job));
    fs.renameSync(`${file}.new`, file);
    return job;
  }

  /// The job's machine is taken: Slurm calls that so.
  take(id, wanted, signal = "SIGKILL") {
    process.kill(-this.change(id, { wanted }).group, signal);
  }

  calls(program) {
    const file = path.join(this.folder, "calls");
    const lines = fs.existsSync(file) ? fs.readFileSync(file, "utf8").split("\n") : [];
    return lines.filter((line) => line.startsWith(`${program} `));
  }

  /// What waits is begun, as once there is room.
  startWaiting() {
    for (const job of this.jobs()) {
      if (job.state !== "PENDING") continue;
      spawn(process.execPath, [fake, "--run", String(job.id)], { detached: true, stdio: "ignore",
        env: { ...process.env, FAKE_SLURM: this.folder } }).unref();
    }
  }

  async end() {
    for (const job of this.jobs()) {
      try {
        if (job.group) process.kill(-job.group, "SIGKILL");
      } catch { /* it has ended */ }
    }
  }
}
