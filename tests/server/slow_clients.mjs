// Clients that are slow on purpose, as a program of its own so that they do not slow down who
// measures: node slow_clients.mjs PORT KIND NUMBER [TARGET] holds NUMBER such connections open, opens
// anew those that are closed, prints "ready" once all have been opened, and goes on until it is killed.
import net from "node:net";

const [port, kind, number, target = "/health"] = process.argv.slice(2);
const json = "Host: localhost\r\nContent-Type: application/json\r\n";

/// What each kind sends at once, and then byte by byte (nothing: it reads nothing).
const kinds = {
  head: ["", `GET /health HTTP/1.1\r\nHost: localhost\r\nLong: ${"a".repeat(1000)}`],
  body: [`POST /api/jobs HTTP/1.1\r\n${json}Content-Length: 10000\r\n\r\n`, " ".repeat(10000)],
  "large body": [`POST /api/jobs HTTP/1.1\r\n${json}Content-Length: 100000\r\n\r\n`, " ".repeat(100000)],
  chunks: [`POST /api/jobs HTTP/1.1\r\n${json}Transfer-Encoding: chunked\r\n\r\n10000\r\n`, " ".repeat(65536)],
  reader: [`GET ${target} HTTP/1.1\r\nHost: localhost\r\n\r\n`, ""],
};
if (!kinds[kind]) throw new Error(`kinds are ${Object.keys(kinds).join(", ")}`);
const [first, slowly] = kinds[kind];

const clients = new Set();
let opened = 0;
function open() {
  const socket = net.connect(Number(port), "127.0.0.1");
  const client = { socket, sent: 0 };
  socket.on("error", () => {});
  socket.on("connect", () => {
    if (first) socket.write(first);
    opened += 1;
    if (opened === Number(number)) console.log("ready");
  });
  if (slowly) {
    socket.resume();  // sees when the service gives it up
  } else {
    socket.pause();
  }
  socket.on("close", () => {
    clients.delete(client);
    setTimeout(open, 100);
  });
  clients.add(client);
}

for (let i = 0; i < Number(number); i += 1) open();
setInterval(() => {
  for (const client of clients) {
    if (client.sent < slowly.length && client.socket.writable) {
      client.socket.write(slowly[client.sent]);
      client.sent += 1;
    }
  }
}, 250);
