// Log axes: their ends, their ticks, and where a value lies.

/// Ticks of a log axis: decades, and between them as many steps as the range leaves room for.
export function logTicks(min, max) {
  const decades = Math.log10(max / min);
  if (!(decades > 0)) return [min];
  if (decades < 0.7) {
    const rough = (max - min) / 4;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((n) => n * power >= rough);
    const count = Math.floor(max / step) - Math.ceil(min / step) + 1;
    return Array.from({ length: count }, (_, i) => (Math.ceil(min / step) + i) * step);
  }
  const parts = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const every = Math.ceil(decades / 8);
  const first = Math.floor(Math.log10(min));
  return Array.from({ length: Math.floor(Math.log10(max)) - first + 1 }, (_, i) => first + i)
    .filter((e) => e % every === 0).flatMap((e) => parts.map((part) => Number(`${part}e${e}`)))
    .filter((value) => value >= min && value <= max);
}

export function tickLabel(value) {
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e5 ? String(Number(value.toPrecision(3)))
    : value.toExponential().replace("e+", "e");
}

/// An axis with room for `values`, from the place `from` to `to`: `at(value)` is a place, and of the
/// `ticks` no two are nearer to one another than `apart`.
export function logAxis(values, from, to, apart) {
  const [min, max] = [Math.min(...values) / 1.15, Math.max(...values) * 1.15];
  const at = (v) => from + ((to - from) * Math.log(v / min)) / Math.log(max / min);
  const ticks = [];
  for (const v of logTicks(min, max)) {
    if (ticks.length === 0 || Math.abs(at(v) - at(ticks.at(-1))) >= apart) ticks.push(v);
  }
  return { at, ticks };
}
