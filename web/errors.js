// Pictures of errors, computed once by a worker of the page's own.

let worker = null;

function compute(image, reference, kind) {
  worker ??= new Worker("/error_worker.js", { type: "module" });
  const { port1, port2 } = new MessageChannel();
  return new Promise((resolve, reject) => {
    worker.addEventListener("error", () => {  // it could not be read: the next question starts another
      worker = null;
      reject(new Error("The errors could not be computed."));
    }, { once: true });
    port1.onmessage = ({ data: { picture, message } }) => (picture ? resolve(picture) : reject(new Error(message)));
    worker.postMessage({ image, reference, kind, port: port2 }, [port2]);
  });
}

const kept = new WeakMap();

/// Errors of one picture against another: a promise of what errorPicture() gives for the key `kind`.
export function errorOf(image, reference, kind) {
  if (!kept.has(image)) kept.set(image, new Map());
  const known = kept.get(image);
  const found = known.get(kind);
  if (found?.reference === reference) return found.picture;
  const picture = compute(image, reference, kind);
  known.set(kind, { reference, picture });
  picture.catch(() => known.delete(kind));
  return picture;
}
