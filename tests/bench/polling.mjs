// Clients that ask a service for its list, and what the service uses meanwhile.
import fs from "node:fs";
import net from "node:net";
import { setTimeout as pause } from "node:timers/promises";

/// One request, by a client that costs next to nothing: it shares its cores with the renderers.
export function get(service, target) {
  const begin = performance.now();
  return new Promise((resolve, reject) => {
    const socket = net.connect(service.port, "127.0.0.1");
    let first = null;
    socket.on("data", (d) => { first ??= d.subarray(0, 16).toString("latin1"); });
    socket.on("error", reject);
    socket.on("close", () => (first?.startsWith("HTTP/1.1 200")
      ? resolve(performance.now() - begin) : reject(new Error(`answer ${first}`))));
    socket.end(`GET ${target} HTTP/1.1\r\nHost: localhost\r\n\r\n`);
  });
}

/// `clients` of them ask for the list once a second; gives the times of the answers, in milliseconds.
export async function poll(service, ms, clients) {
  const times = [], end = performance.now() + ms;
  await Promise.all(Array.from({ length: clients }, async (_, i) => {
    await pause(1000 * i / clients);
    while (performance.now() < end) {
      times.push(await get(service, "/api/jobs"));
      await pause(1000);
    }
  }));
  return times;
}

/// The service's memory now and at most so far, in MB.
export function memory(service) {
  const status = fs.readFileSync(`/proc/${service.child.pid}/status`, "utf8");
  const [now, most] = ["VmRSS", "VmHWM"].map((key) => Number(new RegExp(`${key}:\\s+(\\d+) kB`).exec(status)[1]) / 1024);
  return { now, most };
}

/// CPU seconds of the service so far.
export function cpu(service) {
  const fields = fs.readFileSync(`/proc/${service.child.pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}
