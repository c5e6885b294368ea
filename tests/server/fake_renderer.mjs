#!/usr/bin/env node
// Stands in for `lacuna render FOLDER`: keeps its contract with the service and renders nothing.
// The job's label, up to a colon (a sweep adds the settings behind one), says what happens:
//   finish            done at once
//   gate NAME         done as soon as the file NAME is in the working directory
//   turn NAME         done as soon as the file NAME is there, which it takes away
//   stubborn          never ends, not even when asked
//   fail              state failed, exit code 3
//   crash             kills itself, each time
//   crash once        kills itself the first time, leaving a checkpoint
//   exit N            ends with code N, leaving the state `running`
//   memory            out of memory, each time: exit code 71, state interrupted
//   hog               takes ever more memory
//   interrupt         interrupted by itself, each time, without an iteration more
//   interrupt on      likewise, with one iteration more each time; done at the fourth attempt
//   full NAME         state interrupted because its disk is full, until the file NAME is there; then done
//   mute NAME         likewise, but it could not even write its state
//   linger            done, and ends a little later
//   clock HOURS       done, on a machine whose clock is so many hours ahead
//   lag               ends as done, and its state says so half a second later, as through a shared folder
//   limits            done; its limits, niceness and oom_score_adj go to report.json
//   environment       done; its environment goes to report.json
import { spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";

const [command, folder, ...rest] = process.argv.slice(2);
const threads = rest.length === 2 && rest[0] === "--threads" ? rest[1] : null;
if (command !== "render" || !folder || (rest.length > 0 && !threads)) process.exit(2);

const file = (name) => path.join(folder, name);
const read = (name) => JSON.parse(fs.readFileSync(file(name), "utf8"));
function write(name, content) {
  const temporary = file(`.${name}.${process.pid}`);
  fs.writeFileSync(temporary, typeof content === "string" ? content : JSON.stringify(content));
  fs.utimesSync(temporary, new Date(), new Date(Date.now() + ahead));
  fs.renameSync(temporary, file(name));
}
const outcome = () => (fs.existsSync(file("outcome.json")) ? read("outcome.json") : { state: "queued", attempts: 0 });
const state = (change) => write("outcome.json", { ...outcome(), ...change });
const dieNow = () => process.kill(process.pid, "SIGKILL");

const [word, argument] = read("job.json").label.split(":")[0].split(" ");
const resumed = fs.existsSync(file("checkpoint.bin"));
const stubborn = word === "stubborn";
const ahead = word === "clock" ? Number(argument) * 3600e3 : 0;
const now = () => new Date(Date.now() + ahead).toISOString();

function interrupt() {
  write("checkpoint.bin", "checkpoint");
  state({ state: "interrupted", phase: "", finished: now() });
  process.exit(75);
}
for (const signal of ["SIGTERM", "SIGINT"]) process.on(signal, stubborn ? () => {} : interrupt);

function progress(share) {
  write("progress.json", {
    iteration: Math.round(100 * share), seconds: share, cpu_seconds: share, share,
    remaining_seconds: 1 - share, error: 0.5, error_metric: "est_rmse",
  });
}

function finish() {
  state({ phase: "writing" });
  write("image.png", Buffer.from("89504e470d0a1a0a", "hex").toString("latin1"));
  write("image.exr", "0123456789".repeat(10000));
  write("curve.csv", "iteration,seconds,est_rmse\n100,1,0.5\n");
  const seen = {
    directory: process.cwd(), data: process.env.LACUNA_DATA, scenes: process.env.LACUNA_SCENES,
    cache: process.env.LACUNA_CACHE, threads,
    descriptors: fs.readdirSync("/proc/self/fd").length, group: process.pid,
  };
  const limits = {
    nice: os.getPriority(), oom_score_adj: Number(fs.readFileSync("/proc/self/oom_score_adj", "utf8")),
    data: /Max data size\s+(\w+)/.exec(fs.readFileSync("/proc/self/limits", "utf8"))[1],
  };
  write("report.json", { resumed, ...(word === "environment" ? seen : {}), ...(word === "limits" ? limits : {}) });
  progress(1);
  state({ state: "done", phase: "", finished: now(), exit_code: -1 });
  process.exit(0);
}

const attempts = outcome().attempts + 1;
state({ state: "running", phase: "rendering", started: now(), attempts });
progress(0.25);
console.error(`attempt ${attempts}${resumed ? ", resumed" : ""}`);

switch (word) {
  case "crash":
    if (argument === "once" && resumed) finish();
    write("checkpoint.bin", "checkpoint");
    dieNow();
    break;
  case "exit":
    process.exit(Number(argument));
    break;
  case "fail":
    state({ state: "failed", phase: "", error: "the scene is not to my liking", finished: now() });
    process.exit(3);
    break;
  case "memory":
    state({ state: "interrupted", phase: "", error: "out of memory", finished: now() });
    process.exit(71);
    break;
  case "hog": {
    const held = [];
    setInterval(() => held.push(Buffer.alloc(8 << 20, 1)), 1);
    break;
  }
  case "interrupt":
    if (argument !== "on") interrupt();
    if (attempts === 4) finish();
    progress((24 + attempts) / 100);
    interrupt();
    break;
  case "full":
    if (fs.existsSync(argument)) finish();
    state({ state: "interrupted", phase: "", error: "cannot write image.exr: No space left on device", finished: now() });
    process.exit(75);
    break;
  case "mute":
    if (fs.existsSync(argument)) finish();
    process.exit(75);
    break;
  case "linger":
    state({ state: "done", phase: "", finished: now(), exit_code: -1 });
    setTimeout(() => process.exit(0), 600);
    break;
  case "lag":
    fs.writeFileSync(file(".late"), JSON.stringify({ ...outcome(), state: "done", phase: "", finished: now() }));
    spawn("/bin/sh", ["-c", "sleep 0.5; mv .late outcome.json"], { cwd: folder, detached: true, stdio: "ignore" }).unref();
    process.exit(0);
    break;
  case "gate":
    setInterval(() => { if (fs.existsSync(argument)) finish(); }, 10);
    break;
  case "turn":
    setInterval(() => {
      try {
        fs.unlinkSync(argument);
      } catch {
        return;  // not yet
      }
      finish();
    }, 5);
    break;
  case "stubborn":
    setInterval(() => {}, 1000);
    break;
  default:
    finish();
}
