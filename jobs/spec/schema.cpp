#include <fmt/format.h>

#include <cmath>

#include "jobs/spec/figure_spec.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/sweep_spec.h"
#include "jobs/spec/type_tree.h"

namespace lacuna {
namespace {

OrderedJson schema_of(const Type& type);

/// The key's description, its unit, and the meaning of each name.
std::string description(const Member& member) {
  std::string text = meaning_text(member.field);
  if (!member.field.unit.empty()) text += fmt::format(" [{}]", member.field.unit);
  const Type& named =
      member.type.kind == Type::Kind::list ? member.type.elements.front() : member.type;
  for (const Type::Name& n : named.names) {
    text += fmt::format("\n{}: {}", n.name, n.doc);
  }
  return text;
}

void put_limits(OrderedJson& schema, const Type& type) {
  const auto number = [&](double x) {
    return type.kind == Type::Kind::integer ? OrderedJson(static_cast<std::int64_t>(x))
                                            : OrderedJson(x);
  };
  if (std::isfinite(type.limits.min)) {
    schema[type.limits.above_min ? "exclusiveMinimum" : "minimum"] = number(type.limits.min);
  }
  if (std::isfinite(type.limits.max)) schema["maximum"] = number(type.limits.max);
}

void put_lengths(OrderedJson& schema, const Limits& length, const char* min, const char* max) {
  if (length.min > 0) schema[min] = static_cast<std::int64_t>(length.min);
  if (std::isfinite(length.max)) schema[max] = static_cast<std::int64_t>(length.max);
}

/// Adds the keys to an object's schema. `name`: of the alternative, if it is one.
void put_members(OrderedJson& schema, const Type& type, std::string_view name = {}) {
  OrderedJson properties = OrderedJson::object();
  OrderedJson required = OrderedJson::array();
  if (!name.empty()) {
    properties[std::string(variant_key)] = {{"const", name}};
    required.push_back(variant_key);
  }
  for (const Member& member : type.members) {
    OrderedJson property = {{"description", description(member)}};
    property.update(schema_of(member.type));
    if (member.field.required) {
      required.push_back(member.name);
    } else {
      property["default"] = member.default_value;
    }
    properties[std::string(member.name)] = std::move(property);
  }
  if (type.published) {
    const Member values{
        values_key, {.doc = values_doc}, TypeReader::type_of(Values::defaults, {}), {}};
    OrderedJson property = {{"description", description(values)}};
    property.update(schema_of(values.type));
    property["default"] = enum_name(Values::defaults);
    properties[std::string(values_key)] = std::move(property);
  }
  schema["properties"] = std::move(properties);
  schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
}

/// One object for each alternative, and the short form.
OrderedJson choice_schema(const Type& type) {
  OrderedJson choices = OrderedJson::array();
  OrderedJson names = OrderedJson::array();
  for (std::size_t i = 0; i < type.names.size(); ++i) {
    OrderedJson choice = {
        {"title", type.names[i].name}, {"description", type.names[i].doc}, {"type", "object"}};
    put_members(choice, type.elements[i], type.names[i].name);
    choices.push_back(std::move(choice));
    names.push_back(type.names[i].name);
  }
  choices.push_back({{"title", "name alone"},
                     {"description", "short for an object with this \"type\" and all defaults"},
                     {"enum", names}});
  if (type.optional) choices.push_back({{"type", "null"}});
  return {{"oneOf", choices}};
}

OrderedJson enum_schema(const Type& type) {
  OrderedJson names = OrderedJson::array();
  for (const Type::Name& n : type.names) names.push_back(n.name);
  if (type.optional) names.push_back(nullptr);
  return {{"enum", names}};
}

/// A number, or "auto".
OrderedJson auto_schema(const Type& type) {
  OrderedJson number = {{"type", "number"}};
  put_limits(number, type);
  OrderedJson choices = OrderedJson::array({number, {{"const", auto_name}}});
  if (type.optional) choices.push_back({{"type", "null"}});
  return {{"oneOf", choices}};
}

/// A name, or an object in its place.
OrderedJson name_schema(const Type& type) {
  OrderedJson name = {{"type", "string"}}, object = {{"type", "object"}};
  put_lengths(name, type.limits, "minLength", "maxLength");
  put_members(object, type);
  return {{"oneOf", {name, object}}};
}

/// One of some words, or an object in their place.
OrderedJson word_or_object_schema(const Type& type) {
  OrderedJson object = {{"type", "object"}};
  put_members(object, type);
  return {{"oneOf", {enum_schema(type), object}}};
}

std::string type_name(Type::Kind kind) {
  switch (kind) {
    case Type::Kind::boolean:
      return "boolean";
    case Type::Kind::integer:
      return "integer";
    case Type::Kind::number:
      return "number";
    case Type::Kind::array:
    case Type::Kind::list:
      return "array";
    case Type::Kind::object:
    case Type::Kind::table:
      return "object";
    default:
      return "string";
  }
}

OrderedJson schema_of(const Type& type) {
  if (type.kind == Type::Kind::choice) return choice_schema(type);
  if (type.kind == Type::Kind::word) return enum_schema(type);
  if (type.kind == Type::Kind::word_or_object) return word_or_object_schema(type);
  if (type.kind == Type::Kind::auto_number) return auto_schema(type);
  if (type.kind == Type::Kind::name_or_object) return name_schema(type);
  if (type.kind == Type::Kind::any) return OrderedJson::object();
  OrderedJson schema;
  schema["type"] = type_name(type.kind);
  if (type.optional) schema["type"] = OrderedJson::array({type_name(type.kind), "null"});
  switch (type.kind) {
    case Type::Kind::integer:
    case Type::Kind::number:
      put_limits(schema, type);
      break;
    case Type::Kind::string:
      put_lengths(schema, type.limits, "minLength", "maxLength");
      break;
    case Type::Kind::array:
      schema["items"] = schema_of(type.elements.front());
      schema["minItems"] = type.array_size;
      schema["maxItems"] = type.array_size;
      break;
    case Type::Kind::list:
      schema["items"] = schema_of(type.elements.front());
      put_lengths(schema, type.limits, "minItems", "maxItems");
      break;
    case Type::Kind::table:
      schema["additionalProperties"] = schema_of(type.elements.front());
      put_lengths(schema, type.limits, "minProperties", "maxProperties");
      break;
    case Type::Kind::object:
      put_members(schema, type);
      break;
    default:
      break;
  }
  return schema;
}

}  // namespace

std::string schema_text(const Type& type) { return document_text(schema_of(type)); }

namespace {

template <class T>
std::string titled_schema(const char* title) {
  OrderedJson schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                        {"title", title}};
  schema.update(schema_of(TypeReader::type_of(T{}, Field{})));
  return document_text(schema);
}

}  // namespace

std::string job_schema() { return titled_schema<JobSpec>("Lacuna job"); }
std::string figure_schema() { return titled_schema<FigureSpec>("Lacuna figure"); }
std::string sweep_schema() { return titled_schema<SweepSpec>("Lacuna sweep"); }

}  // namespace lacuna
