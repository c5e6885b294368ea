// Computes pictures of errors beside the page, so that it stays quick.
import { errorPicture } from "./errors.js";

addEventListener("message", ({ data: { image, reference, kind, port } }) => {
  try {
    const picture = errorPicture(image, reference, kind);
    port.postMessage({ picture }, [picture.data.buffer]);
  } catch (error) {
    port.postMessage({ message: error.message });
  }
});
