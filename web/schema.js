// The job file's JSON Schema as rows that people read.

const json = (value) => (value === undefined ? "" : JSON.stringify(value));

/// The choices of a slot such as `integrator`: objects told apart by a constant `type`.
const choices = (schema) => schema.oneOf ?? schema.anyOf ?? [];

function typeName(schema) {
  if (choices(schema).length > 0) return "choice";
  if (schema.const !== undefined) return "constant";
  if (schema.enum) return "word";
  return [schema.type ?? ""].flat().join(" or ");
}

function allowed(schema) {
  if (choices(schema).length > 0) {
    return choices(schema).map((c) => json(c.properties?.type?.const)).filter(Boolean).join(", ");
  }
  if (schema.const !== undefined) return json(schema.const);
  if (schema.enum) return schema.enum.map(json).join(", ");
  const parts = [];
  if (schema.exclusiveMinimum !== undefined) parts.push(`> ${schema.exclusiveMinimum}`);
  if (schema.minimum !== undefined) parts.push(`≥ ${schema.minimum}`);
  if (schema.exclusiveMaximum !== undefined) parts.push(`< ${schema.exclusiveMaximum}`);
  if (schema.maximum !== undefined) parts.push(`≤ ${schema.maximum}`);
  if (schema.items) parts.push(allowed(schema.items));
  return parts.filter(Boolean).join(", ");
}

/// What an object's keys are by default stands beside them; of a slot, which choice it is.
function defaultText(value) {
  const isObject = value !== null && typeof value === "object" && !Array.isArray(value);
  return isObject ? json(value.type) : json(value);
}

function resolve(schema, root) {
  if (!schema.$ref?.startsWith("#/")) return schema;
  const target = schema.$ref.slice(2).split("/")
    .reduce((at, key) => at[key.replaceAll("~1", "/").replaceAll("~0", "~")], root);
  return { ...target, ...schema, $ref: undefined };
}

/// One row a key: {pointer, type, allowed, default, doc}; what belongs to one choice of a slot has
/// the choice's name in its pointer, as in "/integrator (path)/max_depth".
export function schemaRows(schema, root = schema, pointer = "", depth = 0) {
  const rows = [];
  if (depth > 8) return rows;
  for (const [key, raw] of Object.entries(schema.properties ?? {})) {
    if (key === "type" && raw.const !== undefined) continue;
    const child = resolve(raw, root);
    const at = `${pointer}/${key}`;
    const required = (schema.required ?? []).includes(key);
    rows.push({
      pointer: at,
      type: typeName(child),
      allowed: allowed(child),
      default: required ? "required" : defaultText(child.default),
      doc: child.description ?? "",
    });
    rows.push(...schemaRows(child, root, at, depth + 1));
    for (const choice of choices(child).map((c) => resolve(c, root))) {
      const name = choice.properties?.type?.const;
      const place = name === undefined ? at : `${at} (${name})`;
      rows.push(...schemaRows(choice, root, place, depth + 1));
    }
  }
  return rows;
}
