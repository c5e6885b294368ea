// What can be said of pictures side by side: only the last of each job is kept.
import { note, warning } from "./dom.js";
import { seconds } from "./format.js";

const mostApart = 1.05;  // times that differ by no more count as equal

export function aboutTimes(times) {
  const [least, most] = [Math.min(...times), Math.max(...times)];
  return most <= mostApart * least ? note("Of equal time: the jobs' last pictures, at most 5 % apart in render time.")
    : warning(`Not of equal time: the jobs' last pictures, after ${seconds(least)} to ${seconds(most)} of rendering.`);
}
