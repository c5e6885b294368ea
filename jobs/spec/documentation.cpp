#include <fmt/format.h>

#include <string>

#include "jobs/spec/figure_spec.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/sweep_spec.h"
#include "jobs/spec/type_tree.h"

namespace lacuna {
namespace {

/// Text in a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string sentence(std::string_view text) {
  std::string s(text);
  if (!s.empty() && s[0] >= 'a' && s[0] <= 'z') s[0] = char(s[0] - 'a' + 'A');
  return s + '.';
}

/// The type and range of a value.
std::string type_text(const Type& type) {
  const auto with = [](std::string_view thing, const std::string& limits) {
    return limits.empty() ? std::string(thing) : fmt::format("{} {}", thing, limits);
  };
  switch (type.kind) {
    case Type::Kind::boolean:
      return "true or false";
    case Type::Kind::integer:
      return with("integer", range_text(type.limits));
    case Type::Kind::number:
      return with("number", range_text(type.limits));
    case Type::Kind::auto_number:
      return with("number", range_text(type.limits)) + fmt::format(", or `{}`", auto_name);
    case Type::Kind::string:
      return with("string", length_text(type.limits, "characters"));
    case Type::Kind::name_or_object:
      return with("string", length_text(type.limits, "characters")) + ", or an object, see below";
    case Type::Kind::array:
      return fmt::format("list of {}, each: {}", type.array_size, type_text(type.elements.front()));
    case Type::Kind::list:
      return fmt::format("{}, each: {}", with("list", length_text(type.limits, "elements")),
                         type_text(type.elements.front()));
    case Type::Kind::object:
      return "object, see below";
    case Type::Kind::any:
      return "any value";
    case Type::Kind::table:
      return fmt::format("object of any keys, each: {}", type_text(type.elements.front()));
    case Type::Kind::word:
    case Type::Kind::word_or_object:
    case Type::Kind::choice:
      break;
  }
  std::string names;
  for (const Type::Name& n : type.names) {
    names += fmt::format("{}`{}`", names.empty() ? "" : ", ", n.name);
  }
  if (type.kind == Type::Kind::word_or_object) names += ", or an object, see below";
  return (type.kind == Type::Kind::choice ? "one of these methods, see below: " : "one of ") +
         names;
}

std::string default_text(const Member& member) {
  if (member.field.required) return "required";
  if (member.type.kind == Type::Kind::object && !member.type.optional) return "";
  if (member.type.kind == Type::Kind::choice && member.default_value.is_object()) {
    return fmt::format("`{}`", json_text(member.default_value[std::string(variant_key)]));
  }
  return member.default_value.is_null() ? "none"
                                        : fmt::format("`{}`", json_text(member.default_value));
}

void put_names(std::string& page, const Member& member) {
  const Type& named =
      member.type.kind == Type::Kind::list ? member.type.elements.front() : member.type;
  if (named.kind != Type::Kind::word && named.kind != Type::Kind::word_or_object) return;
  page += fmt::format("\n`{}`:\n\n", member.name);
  for (const Type::Name& n : named.names) page += fmt::format("- `{}`: {}\n", n.name, n.doc);
}

void put_section(std::string& page, const Type& object, const std::string& path);

/// Appends the sections for the contents of a member.
void put_parts(std::string& page, const Member& member, const std::string& path) {
  if (member.type.kind == Type::Kind::object || member.type.kind == Type::Kind::name_or_object) {
    page += fmt::format("\n## {}\n\n{}\n", path, sentence(member.field.doc));
    put_section(page, member.type, path);
  }
  if (member.type.kind == Type::Kind::list &&
      (member.type.elements.front().kind == Type::Kind::object ||
       member.type.elements.front().kind == Type::Kind::word_or_object)) {
    page +=
        fmt::format("\n## {}\n\nAn element of the list: {}\n", path, sentence(member.field.doc));
    put_section(page, member.type.elements.front(), path);
  }
  for (std::size_t i = 0; member.type.kind == Type::Kind::choice && i < member.type.names.size();
       ++i) {
    const Type::Name& name = member.type.names[i];
    const std::size_t start = page.size();
    page += fmt::format("\n## {}: {}\n\n`{{\"type\": \"{}\"}}`. {}\n", path, name.name, name.name,
                        sentence(name.doc));
    put_section(page, member.type.elements[i], path);
    // Integrators share their choices of a guide: one section each.
    if (page.find(page.substr(start)) < start) page.resize(start);
  }
}

/// Appends one object: a table of keys, the meaning of names, then its parts.
void put_section(std::string& page, const Type& object, const std::string& path) {
  if (object.members.empty()) {
    page += "\nIt has no settings.\n";
    return;
  }
  page += "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
  for (const Member& m : object.members) {
    page += fmt::format("| `{}` | {} | {} | {} |\n", m.name, cell(type_text(m.type)),
                        cell(default_text(m)), cell(meaning_text(m.field)));
  }
  for (const Member& m : object.members) put_names(page, m);
  for (const Member& m : object.members) {
    put_parts(page, m, path.empty() ? std::string(m.name) : fmt::format("{}.{}", path, m.name));
  }
}

}  // namespace

namespace {

template <class T>
std::string titled_page(std::string_view title, std::string_view note = {}) {
  std::string page = fmt::format(
      "# {}\n\n"
      "One JSON object. Keys that are left out take their defaults; unknown keys are "
      "errors.\n{}",
      title, note);
  put_section(page, TypeReader::type_of(T{}, Field{}), "");
  return page;
}

}  // namespace

std::string job_documentation() {
  return titled_page<JobSpec>(
      "The job file",
      "\n`\"as\": \"published\"`, in the job or in any object below it with a value \"as "
      "published\", "
      "selects that value for every setting that the object and those below it leave out; "
      "`\"as\": \"default\"` undoes it further below. `{\"type\": \"path\", \"as\": \"published\", "
      "\"guide\": {\"type\": \"skeleton\", \"strength\": 8}}` is the method of Noel 2015, chapter "
      "9.\n");
}
std::string figure_documentation() { return titled_page<FigureSpec>("The file of a figure"); }
std::string sweep_documentation() { return titled_page<SweepSpec>("The sweep file"); }

}  // namespace lacuna
