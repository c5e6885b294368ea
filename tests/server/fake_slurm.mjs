#!/usr/bin/env node
// Stands in for sbatch, squeue, sacct, scancel and scontrol, by the name that it is called by: one cluster in the
// folder $FAKE_SLURM, with a file for each job. Its answers have the form, and its refusals the words, of Slurm 22.05.
// Files in the folder say what goes wrong:
//   down          the controller is away
//   full          what is submitted waits (Resources)
//   lose          sbatch makes a job, and its answer is lost
//   deaf          sbatch waits before it makes a job until the file is gone; mute: after it has
//   accounts      sacct has accounts
//   quota         no more jobs may be submitted
// A job's file may be changed by a test: what runs looks at nothing but `wanted` in it.
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const folder = process.env.FAKE_SLURM;
const self = fileURLToPath(import.meta.url);
const [name, args] = process.argv[2] === "--run"
  ? ["run", process.argv.slice(3)] : [path.basename(process.argv[1]), process.argv.slice(2)];
const is = (what) => fs.existsSync(path.join(folder, what));
const file = (id) => path.join(folder, `${id}.json`);
const read = (id) => JSON.parse(fs.readFileSync(file(id), "utf8"));
const ids = () => fs.readdirSync(folder).filter((n) => /^\d+\.json$/.test(n)).map((n) => parseInt(n, 10))
  .sort((a, b) => a - b);
const pause = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

/// Waits until a file is gone. It ends with the command that called it, whatever has become of the file.
async function gone(what) {
  const caller = process.ppid;
  while (is(what)) {
    await pause(10);
    if (process.ppid !== caller) process.exit(1);
  }
}

function write(job) {
  const temporary = path.join(folder, `.${job.id}.${process.pid}`);
  fs.writeFileSync(temporary, JSON.stringify(job));
  fs.renameSync(temporary, file(job.id));
}
const change = (id, more) => write({ ...read(id), ...more });
function fail(code, ...lines) {
  for (const line of lines) console.error(line);
  process.exit(code);
}
function called() {
  fs.appendFileSync(path.join(folder, "calls"), `${name} ${args.join(" ")}\n`);
}

function start(id) {
  spawn(process.execPath, [self, "--run", String(id)], { detached: true, stdio: "ignore" }).unref();
}

/// The slurmstepd of a job: its batch script is a group of its own.
async function run(id) {
  const job = read(id);
  const out = fs.openSync(job.options.output, "a");
  const script = spawn("/bin/sh", [job.copy], {
    stdio: ["ignore", out, out], detached: true, cwd: job.options.chdir,
    env: { ...process.env, SLURM_JOB_ID: String(id), SLURM_JOB_NAME: job.name, SLURM_CPUS_ON_NODE: "2" } });
  change(id, { state: "RUNNING", reason: "None", nodes: "node1", group: script.pid });
  const [code, signal] = await new Promise((resolve) => { script.on("exit", (...how) => resolve(how)); });
  const { wanted } = read(id);
  if (wanted === "requeue") {
    change(id, { state: "PENDING", reason: "BeginTime", nodes: "", wanted: undefined, restarts: (job.restarts ?? 0) + 1 });
  } else {
    const state = wanted ?? (code === 0 ? "COMPLETED" : "FAILED");
    change(id, { state, reason: state === "FAILED" ? "NonZeroExitCode" : "None", code, signal });
  }
}

async function sbatch() {
  const options = {};
  for (const word of args.slice(0, -1)) {
    const [, option, value] = /^--([a-z-]+)(?:=(.*))?$/.exec(word) ?? [];
    if (!option) fail(255, `sbatch: unrecognized option '${word}'`, 'Try "sbatch --help" for more information');
    options[option] = value ?? true;
  }
  if (is("down")) {
    fail(1, "sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)");
  }
  if (options.partition === "nowhere") {
    fail(1, "sbatch: error: invalid partition specified: nowhere",
      "sbatch: error: Batch job submission failed: Invalid partition name specified");
  }
  if (options.partition === "closed") {
    fail(1, "sbatch: error: Batch job submission failed: User's group not permitted to use this partition");
  }
  if (is("quota")) {
    fail(1, "sbatch: error: QOSMaxSubmitJobPerUserLimit", "sbatch: error: Batch job submission failed: Job violates "
      + "accounting/QOS policy (job submit limit, user's size and/or time limits)");
  }
  await gone("deaf");
  const id = 1 + Math.max(0, ...ids());
  const job = { id, name: options["job-name"], options, args, nodes: "", restarts: 0,
    state: "PENDING", reason: is("full") ? "Resources" : "None" };
  if (parseInt(options.mem, 10) > 100000) {
    write({ ...job, state: "FAILED", reason: "BadConstraints" });
    fail(1, "sbatch: error: Memory specification can not be satisfied",
      "sbatch: error: Batch job submission failed: Requested node configuration is not available");
  }
  job.copy = path.join(folder, `${id}.sh`);
  fs.copyFileSync(args.at(-1), job.copy);
  write(job);
  if (!is("full")) start(id);
  await gone("mute");
  if (is("lose")) {
    fail(1, "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation");
  }
  console.log(id);
}

function squeue() {
  if (args.join(" ") !== "--me --noheader --states=all --format=%i|%T|%r|%N|%j") fail(1, "squeue: not so");
  if (is("down")) fail(1, "slurm_load_jobs error: Unable to contact slurm controller (connect failure)");
  for (const job of ids().map(read).filter((j) => !j.forgotten)) {
    console.log([job.id, job.state, job.reason, job.nodes, job.name].join("|"));
  }
}

function sacct() {
  if (!is("accounts")) fail(1, "Slurm accounting storage is disabled");
  const names = args.find((word) => word.startsWith("--name=")).slice(7).split(",");
  for (const job of ids().map(read).filter((j) => names.includes(j.name))) {
    console.log([job.id, job.state === "CANCELLED" ? "CANCELLED by 0" : job.state, "None", "node1", job.name].join("|"));
  }
}

function signal(job, number) {
  try {
    process.kill(-job.group, number);
  } catch { /* it has just ended */ }
}

function scancel() {
  const job = read(Number(args.at(-1)));
  const over = !["PENDING", "RUNNING"].includes(job.state);
  if (over || (args.includes("--state=PENDING") && job.state !== "PENDING")) return;
  if (args.includes("--signal=TERM")) return signal(job, "SIGTERM");
  if (job.state === "PENDING") return change(job.id, { state: "CANCELLED" });
  change(job.id, { wanted: "CANCELLED" });
  signal(job, "SIGTERM");
  setTimeout(() => signal(job, "SIGKILL"), 200);
}

function scontrol() {
  const [verb, which, value] = args;
  const id = Number(/^JobId=(\d+)$/.exec(which)?.[1]);
  if (verb !== "update" || !ids().includes(id)) fail(1, `Invalid job id specified for job ${id}`);
  if (read(id).state !== "PENDING") fail(1, `Job is no longer pending execution for job ${id}`);
  const job = read(id);
  change(id, { options: { ...job.options, nice: /^Nice=(-?\d+)$/.exec(value)[1] } });
}

if (name !== "run") called();
await { run: () => run(Number(args[0])), sbatch, squeue, sacct, scancel, scontrol }[name]();
