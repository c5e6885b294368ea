// A stand-in for Slurm that answers from a table and runs nothing: what the service costs by itself.
import fs from "node:fs";
import path from "node:path";

/// sbatch adds a line to the table, squeue prints it. `held`: lines of other submissions of the same person.
/// Gives the words of `env` that put them in front of PATH, and the table's file.
export function tableSlurm(root, held = 0) {
  const bin = path.join(root, "slurm-bin"), table = path.join(root, "slurm-table"), number = path.join(root, "slurm-number");
  fs.mkdirSync(bin);
  fs.writeFileSync(table, Array.from({ length: held }, (_, i) => `${i + 1}|PENDING|Priority||other-${i + 1}\n`).join(""));
  fs.writeFileSync(number, `${held}\n`);
  const program = (name, text) => fs.writeFileSync(path.join(bin, name), `#!/bin/sh\n${text}\n`, { mode: 0o755 });
  program("sbatch", `read n <"${number}"; n=$((n + 1)); echo $n >"${number}"
for word; do case "$word" in --job-name=*) echo "$n|PENDING|Resources||\${word#*=}" >>"${table}";; esac; done
echo $n`);
  program("squeue", `exec cat "${table}"`);
  program("sacct", "exit 1");
  program("scancel", "exit 0");
  program("scontrol", "exit 0");
  return { environment: ["env", `PATH=${bin}:${process.env.PATH}`], table };
}
