// What a bench prints: each figure beside the bound it has to keep.
let missed = 0;

export function figure(name, value, unit, allowed) {
  const ok = value <= allowed;
  if (!ok) missed += 1;
  console.log(`${name.padEnd(66)} ${value.toFixed(1).padStart(8)} ${unit}   ${ok ? "ok" : "MISSED"}: ${allowed} ${unit}`);
}

export const quantile = (times, share) =>
  [...times].sort((a, b) => a - b)[Math.min(times.length - 1, Math.floor(share * times.length))];

/// Runs `measure({after})`, whose cleanups are done at the end, and ends with 1 if a figure was missed.
export async function bench(measure) {
  const cleanups = [];
  try {
    await measure({ after: (f) => cleanups.push(f) });
  } finally {
    for (const cleanup of cleanups.reverse()) await cleanup();
  }
  console.log(`${missed} figures missed`);
  process.exitCode = missed > 0 ? 1 : 0;
}
