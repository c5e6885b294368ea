// The jobs that the mock server starts with.
import { layerFiles } from "./layers.mjs";
import { noise, radiance, room } from "./png.mjs";

const columns = ["iteration", "seconds", "cpu_seconds", "samples", "rays", "shadow_rays", "mae", "rmse",
  "mse", "relmse", "smape", "est_rmse", "negative", "rejected", "at_floor", "longest_seconds"];

/// curve.csv of a job with `rows` rows, an iteration lasting `cost` seconds, and the error `level`
/// after the first. Errors against the reference stop falling at `floor`; null: there is none.
export function curve({ rows, cost, level, floor = null, seed = 1 }) {
  const random = noise(seed);
  const lines = [columns.join(",")];
  for (let i = 0; i < rows; i += 1) {
    const iteration = 2 ** i;
    const wobble = 1 + 0.1 * (random() - 0.5);
    const own = (level / Math.sqrt(iteration)) * wobble;
    const rmse = floor === null ? null : Math.hypot(own, floor);
    const errors = rmse === null ? ["", "", "", "", ""]
      : [0.6 * rmse, rmse, rmse ** 2, 4 * rmse ** 2, 2 * rmse].map((v) => v.toPrecision(6));
    const seconds = iteration * cost;
    lines.push([iteration, seconds.toPrecision(6), (0.97 * seconds).toPrecision(6), iteration * 262144,
      iteration * 900000, iteration * 500000, ...errors, own.toPrecision(6), 0, 0,
      rmse === null ? "" : Number(own < floor), seconds.toPrecision(6)].join(","));
  }
  return `${lines.join("\n")}\n`;
}

export const report = {
  version: "0.1.0",
  job: "20260131-101400-cornell",
  seconds: { load: 0.0412, reference: 12.4, evaluate: 0.31, checkpoint: 0.05, write: 0.122, render: 30.02,
    render_cpu: 29.4 },
  counts: { iterations: 1024, samples: 268435456, rays: 921600000, shadow_rays: 512000000, negative: 0,
    rejected: 0 },
  rates: { rays_per_second: 19873122.4, rays_per_cpu_second: 10120300.1, rays_per_sample: 5.34 },
  errors: { rmse: 0.0138, est_rmse: 0.0125, efficiency: 174.9,
    reference: { name: "auto", own_rmse: 0.02, at_floor: true } },
  scene: { triangles: 36, dropped_triangles: 0, emitters: 2,
    textures: { in_scene: 3, decoded: 1, decoded_bytes: 0 }, mask_filters: 0, ray_caster_bytes: 52480,
    content_hash: "f00dcafe00112233" },
  artefacts: { built: [{ name: "skeleton", seconds: 1.5, disk_bytes: 2048 }], loaded: ["octree"] },
  strategies: [{ type: "camera", share: 0.31 }, { type: "emitter", share: 0.69 }],
  warnings: [],
  threads: { serial_seconds: 0.53, waiting_seconds: 1.02, sections: {
    "eye paths": { serial: 0.01, loops: 14.1, busy: 28.1, waiting: 0.1, bodies: 4096 },
    "photon grid": { serial: 0.4, loops: 1, busy: 1.1, waiting: 0.9, bodies: 512 },
    curve: { serial: 0.12, loops: 0, busy: 0, waiting: 0, bodies: 0 } } },
  machine: { processor: "A processor, 2 GHz", cores: 2, threads: 2, peak_memory_bytes: 183500800 },
};

/// Of a job of `auto` with three candidates.
const turn = (iterations, seconds, noise, expected) => ({ iterations, seconds, cpu_seconds: seconds, rays: 1e6 * seconds, noise, bias: 0, expected });
const choice = {
  metric: "relmse", chosen: 1,
  candidates: [
    { name: "path, reuse 16", integrator: { type: "path" }, left: "a larger error than that of others",
      turns: [turn(4, 0.1, 0.2, 0.004), turn(8, 0.2, 0.1, 0.004)] },
    { name: "metropolis, path_space", integrator: { type: "metropolis" }, left: "",
      turns: [turn(3, 0.1, 0.1, 0.002), turn(6, 0.2, 0.04, 0.0016)] },
    { name: "bdpt, skeleton", integrator: { type: "bdpt" }, left: "an iteration takes longer than its turn",
      turns: [turn(0, 0.1, null, null)] },
  ],
};

function jobFile(changes) {
  return {
    scene: "cornell.glb", camera: "", label: "", resolution: [512, 512],
    integrator: { type: "path", max_depth: 6, guide: { type: "bsdf" }, next_event_estimation: true,
      roulette_depth: 4 },
    budget: { seconds: 30, iterations: null }, reference: "auto", reference_iterations: 1024,
    analysis: { resolution: 128 }, seed: 1, threads: 0, layers: [], pixel_filter: "box", pixel_type: "float", checkpoint_seconds: 10, ...changes,
  };
}

function state(name, changes = {}) {
  return {
    state: name, attempts: 1, exit_code: name === "done" ? 0 : -1, created: "2026-01-31T10:15:00.000Z",
    started: "2026-01-31T10:15:01.000Z", finished: name === "done" ? "2026-01-31T10:15:44.000Z" : "",
    phase: "", error: "", warnings: [], ...changes,
  };
}

export function progress(iteration, share, changes = {}) {
  return {
    iteration, seconds: 30 * share, cpu_seconds: 29 * share, share,
    remaining_seconds: 30 * (1 - share), error: 0.4 / Math.sqrt(Math.max(1, iteration)),
    error_metric: "rmse", ...changes,
  };
}

const exr = Buffer.alloc(3145728);

function files(job, curveText, image, more = {}) {
  return {
    "job.json": JSON.stringify(job, null, 2), "curve.csv": curveText, "image.png": image,
    "image.exr": exr, "log.txt": "loaded the scene in 41 ms\nrendering\n", ...more,
  };
}

const rgb = ["R", "G", "B"];

/// What `make` gives for the same arguments, made once: pictures take long, and nobody writes into them.
function once(make) {
  const made = new Map();
  return (...given) => {
    const key = given.join();
    if (!made.has(key)) made.set(key, make(...given));
    return made.get(key);
  };
}
const picture = once(room);

/// The layers of the room, `side` pixels wide and high.
const roomLayers = once((side, grain, seed) => {
  const smooth = radiance(side, side, 0, 1);
  return layerFiles(side, side, [
    { name: "", channels: rgb, scale: 2 ** -10, pixel: radiance(side, side, grain, seed) },
    { name: "variance", channels: rgb, scale: 2 ** -20, pixel: (x, y) => smooth(x, y).map((v) => (grain * v) ** 2 / 12) },
    { name: "normal", channels: ["X", "Y", "Z"], pixel: (x) => [x < 0.2 * side ? 1 : x > 0.8 * side ? -1 : 0, 0,
      x >= 0.2 * side && x <= 0.8 * side ? 1 : 0] },
    { name: "depth", channels: ["Z"], scale: 2, pixel: (x, y) => [400 + y] },
    { name: "reference", channels: rgb, scale: 2 ** -10, pixel: smooth },
  ]);
});

const withReport = { "report.json": JSON.stringify(report) };
const ended = (iteration, error) => progress(iteration, 1, { remaining_seconds: 0, error });

export const hostile = "<img src=x onerror=window.hacked=1>";

/// Fresh fixtures: [{id, job, state, progress, files}], newest first.
export function makeJobs() {
  const plain = jobFile({ label: "Cornell box, 6 edges" });
  const shallow = jobFile({ label: "Cornell box, without next event estimation",
    integrator: { ...plain.integrator, next_event_estimation: false }, seed: 2 });
  const atrium = jobFile({ scene: "atrium.glb", resolution: [640, 360], reference: "" });
  const normals = jobFile({ scene: "door/scene.glb", integrator: { type: "inspect", show: "normal" },
    reference: "" });
  const evil = jobFile({ scene: `${hostile}.glb`, label: hostile, camera: hostile });
  return [
    { id: "20260131-101900-running", job: atrium, state: state("running", { phase: "rendering" }),
      progress: progress(4, 0.1, { error_metric: "est_rmse" }),
      files: files(atrium, curve({ rows: 3, cost: 0.7, level: 0.4 }), picture(160, 90, 0.5, 3)) },
    { id: "20260131-101800-waiting", job: jobFile({ label: "waits" }),
      state: state("queued", { attempts: 0, started: "" }), progress: null,
      files: { "job.json": JSON.stringify(jobFile({ label: "waits" })) } },
    { id: "20260131-101700-hostile", job: evil,
      state: state("failed", { exit_code: 3, error: `scene ${hostile}.glb: no such file`,
        warnings: [`the scene has no light: the picture is black (${hostile})`] }),
      progress: null, files: { "job.json": JSON.stringify(evil), "log.txt": hostile } },
    { id: "20260131-101600-stopped", job: normals, state: state("cancelled"), progress: null,
      files: { "job.json": JSON.stringify(normals) } },
    { id: "20260131-101500-shallow", job: shallow, state: state("done"), progress: ended(1024, 0.0391),
      files: files(shallow, curve({ rows: 11, cost: 0.021, level: 1.25, floor: 0.004, seed: 5 }),
        picture(128, 128, 0.4, 7), { "report.json": JSON.stringify({ ...report, choice }), ...roomLayers(128, 1.2, 7) }) },
    { id: "20260131-101400-cornell", job: plain, state: state("done"), progress: ended(1024, 0.0138),
      files: files(plain, curve({ rows: 11, cost: 0.029, level: 0.4, floor: 0.02, seed: 9 }),
        picture(128, 128, 0.1, 9), { ...withReport, ...roomLayers(128, 0.3, 9) }) },
  ];
}

/// `n` finished jobs, newest first, with curves of `rows` rows that differ.
export function manyJobs(n, rows = 11) {
  const like = makeJobs().at(-1);
  return Array.from({ length: n }, (_, i) => ({
    ...like, id: `20260130-101400-${10000 + i}`, job: { ...like.job, label: `job ${i}` }, state: { ...like.state },
    files: { ...like.files, "curve.csv": n > 100 ? like.files["curve.csv"]
      : curve({ rows, cost: 0.02 * (1 + i / n), level: 0.4 + 0.05 * i, floor: 0.001, seed: i + 1 }) },
  }));
}

export const scenes = ["atrium.glb", "cornell.glb", "door/scene.glb", hostile];

export const schema = {
  $schema: "https://json-schema.org/draft/2020-12/schema",
  type: "object",
  required: ["scene"],
  additionalProperties: false,
  properties: {
    scene: { type: "string", minLength: 1, description: "glTF or GLB file, below a scenes root" },
    resolution: { type: "array", items: { type: "integer", minimum: 1, maximum: 16384 },
      default: [512, 512], description: "width and height" },
    integrator: { description: "the method", oneOf: [
      { type: "object", description: "path tracing", properties: { type: { const: "path" },
        max_depth: { type: "integer", minimum: 1, maximum: 1024, default: 6,
          description: "longest path" } } },
      { type: "object", description: "false colour", properties: { type: { const: "inspect" },
        show: { enum: ["normal", "albedo"], default: "normal", description: "the quantity" } } }] },
  },
};

const waits = ["cancel", "hold", "priority"];
const stopped = ["retry", "extend", "delete"];

/// What GET /api/states says of them, but for the words.
export const states = [
  { name: "queued", terminal: false, actions: waits },
  { name: "running", terminal: false, actions: waits },
  { name: "held", terminal: false, actions: ["cancel", "release", "priority"] },
  { name: "cancelling", terminal: false, actions: [] },
  { name: "interrupted", terminal: false, actions: [] },
  { name: "done", terminal: true, actions: ["extend", "delete"] },
  { name: "failed", terminal: true, actions: stopped },
  { name: "cancelled", terminal: true, actions: stopped },
];

/// Two paths as `lacuna trace` tells them, in a scene of 4 by 3 by 1: one to an emitter, one to the environment.
export const paths = {
  seed: 1, mean: [0.5, 0.25, 0.125], bounds: [[0, 0, 0], [4, 3, 1]], count: 17, paths: [
    { iteration: 3, s: 1, t: 2, letters: "EDL", value: [8, 4, 2], share: 0.75, weight: 0.5, vertices: [
      { position: [4, 1, 1], from: "eye", density: 0 }, { position: [1, 0, 0.5], from: "eye", density: 0.25 },
      { position: [2, 3, 0.5], from: "light", density: 1 }] },
    { iteration: 0, s: 0, t: 3, letters: "ESL", value: [1, 1, 1], share: 0.125, weight: 1, vertices: [
      { position: [4, 1, 1], from: "eye", density: 0 }, { position: [0, 1, 0.5], from: "eye", density: 2 },
      { direction: [0, 1, 0], from: "eye", density: 3 }] }] };
