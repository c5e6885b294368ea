// The service with the real renderer and the project's own scenes.
import path from "node:path";
import { fileURLToPath } from "node:url";

import { binary, folders, Service } from "./service.mjs";

export const lacuna = path.join(path.dirname(binary), "lacuna");
export const ownScenes = fileURLToPath(new URL("../../jobs/scenes", import.meta.url));

/// Fresh folders (see folders()) whose scenes are the project's own.
export const realFolders = (t) => ({ ...folders(t), scenes: ownScenes });

/// A running service in such folders; `args` are added to its command line. Its renderers do not stand back:
/// a busy machine would keep whoever waits for them waiting.
export const startReal = (places, args = []) => Service.start(places, ["--renderer", lacuna, "--nice", "0", ...args]);
