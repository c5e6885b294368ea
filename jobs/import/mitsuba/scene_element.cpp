#include "jobs/import/mitsuba/scene_element.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <pugixml.hpp>
#include <system_error>

#include "base/json/json_cursor.h"
#include "base/storage/atomic_file.h"
#include "renderer/core/scene_error.h"

namespace lacuna::mitsuba {
namespace {

/// Lines of a text by their offsets.
class Lines {
 public:
  explicit Lines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') ends_.push_back(i);
    }
  }
  std::size_t of(std::ptrdiff_t offset) const {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, offset));
    return 1 + static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), at) -
                                        ends_.begin());
  }

 private:
  std::vector<std::size_t> ends_;
};

class SceneFileReader {
 public:
  explicit SceneFileReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  SceneElement read_file_at(const std::filesystem::path& file) {
    std::string text;
    try {
      text = read_file(std::filesystem::canonical(file), max_xml_bytes - bytes_);
    } catch (const std::length_error&) {
      throw SceneError(
          fmt::format("{}: the scene has more than {} bytes of XML", file.string(), max_xml_bytes));
    }
    return read_text(text, file.filename().string());
  }

  SceneElement read_text(std::string_view text, const std::string& label) {
    bytes_ += text.size();
    const Lines lines(text);
    pugi::xml_document document;
    const auto result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_doctype);
    if (!result) {
      throw SceneError(
          fmt::format("{}:{}: no XML: {}", label, lines.of(result.offset), result.description()));
    }
    SceneElement root;
    for (const pugi::xml_node& node : document.children()) {
      if (node.type() == pugi::node_doctype) {
        throw SceneError(
            fmt::format("{}: has a document type (<!DOCTYPE>), which is not read", label));
      }
      if (node.type() == pugi::node_element) root = element_of(node, lines, label, 0);
    }
    if (root.tag != "scene") {
      throw SceneError(fmt::format("{}: the root element is {}; allowed: <scene>", label,
                                   root.tag.empty() ? "missing" : in_quotes(root.tag)));
    }
    return root;
  }

 private:
  SceneElement element_of(const pugi::xml_node& node, const Lines& lines, const std::string& label,
                          int depth) {
    SceneElement e;
    e.tag = node.name();
    // As Mitsuba called them up to 0.3.
    if (e.tag == "luminaire") e.tag = "emitter";
    if (e.tag == "camera") e.tag = "sensor";
    e.place = fmt::format("{}:{}", label, lines.of(node.offset_debug()));
    if (depth > max_element_depth) e.fail("is nested more than 64 deep");
    if (++elements_ > max_elements) e.fail(fmt::format("is one of more than {}", max_elements));
    for (const pugi::xml_attribute& a : node.attributes()) {
      e.attributes.emplace_back(a.name(), replaced(a.value(), e));
    }
    if (e.tag == "spectrum" && e.has("filename")) read_spectrum(e);
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_pcdata) e.fail("has text in it; allowed: elements");
      if (child.type() != pugi::node_element) continue;
      SceneElement inner = element_of(child, lines, label, depth + 1);
      if (inner.tag == "default") {
        defaults_.emplace(inner.attribute("name"), inner.attribute("value"));
      } else if (inner.tag == "include") {
        include(inner, e.children);
      } else {
        e.children.push_back(std::move(inner));
      }
    }
    return e;
  }

  void include(const SceneElement& at, std::vector<SceneElement>& into) {
    if (folder_.empty()) at.fail("includes a file; allowed: a scene without");
    const auto file = file_within(folder_, at.attribute("filename"), at);
    std::error_code error;
    const auto canonical = std::filesystem::canonical(file, error);
    if (error) at.fail(fmt::format("cannot find {}", in_quotes(at.attribute("filename"))));
    if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) {
      at.fail(fmt::format("includes {}, which includes it: a circle",
                          in_quotes(at.attribute("filename"))));
    }
    if (open_.size() >= max_include_depth) at.fail("is included more than 16 files deep");
    open_.push_back(canonical);
    SceneElement root = read_file_at(canonical);
    open_.pop_back();
    std::move(root.children.begin(), root.children.end(), std::back_inserter(into));
  }

  /// A spectrum that is a file: lines of wavelength and value, which become its `value`.
  void read_spectrum(SceneElement& at) {
    if (folder_.empty()) at.fail("names a file; allowed: a scene without");
    const auto file = find_within(folder_, at.attribute("filename"));
    std::error_code none;
    if (!file || !std::filesystem::exists(*file, none)) return;
    constexpr std::size_t most_bytes = 1 << 20;
    std::string text;
    try {
      text = read_file(*file, most_bytes);
    } catch (const std::exception& e) {
      at.fail(fmt::format("cannot be read: {}", e.what()));
    }
    std::string values;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t end = std::min(text.find('\n', from), text.size());
      const std::string line = text.substr(from, std::min(text.find('#', from), end) - from);
      from = end + 1;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      values += fmt::format("{}:", line);  // any separator does
    }
    at.attributes.emplace_back("value", values);
  }

  /// Replaces `$name`, the longest names first. A `$` of no parameter is an error.
  std::string replaced(std::string value, const SceneElement& at) const {
    std::size_t from = 0;
    while ((from = value.find('$', from)) != std::string::npos) {
      const std::string* best = nullptr;
      std::size_t length = 0;
      for (const auto& [name, text] : defaults_) {
        if (name.size() > length && value.compare(from + 1, name.size(), name) == 0) {
          best = &text;
          length = name.size();
        }
      }
      if (best == nullptr) {
        at.fail(fmt::format("has {}, and no <default> says what {} is", in_quotes(value),
                            in_quotes(value.substr(from))));
      }
      value.replace(from, length + 1, *best);
      from += best->size();
      if (value.size() > 1 << 16) at.fail("has an attribute longer than 65536 bytes");
    }
    return value;
  }

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> open_;
  std::map<std::string, std::string> defaults_;
  std::size_t bytes_ = 0, elements_ = 0;

 public:
  void begin_with(const std::filesystem::path& file) { open_.push_back(file); }
};

const std::string no_attribute;

}  // namespace

const std::string& SceneElement::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes) {
    if (key == wanted) return value;
  }
  return no_attribute;
}

bool SceneElement::has(std::string_view wanted) const {
  return std::any_of(attributes.begin(), attributes.end(),
                     [&](const auto& a) { return a.first == wanted; });
}

std::string SceneElement::name() const { return plain_name(attribute("name")); }

std::string SceneElement::label() const {
  std::string text = tag;
  const std::string& called = attribute(has("id") ? "id" : "name");
  if (!called.empty()) text += fmt::format(" {}", in_quotes(called));
  if (!type().empty()) text += fmt::format(" ({})", type());
  return text;
}

void SceneElement::fail(const std::string& what) const {
  throw SceneError(fmt::format("{}: {} {}", place, label(), what));
}

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

SceneElement read_scene_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto canonical = std::filesystem::canonical(file, error);
  if (error) throw std::system_error(error, file.string());
  SceneFileReader reader(canonical.parent_path());
  reader.begin_with(canonical);
  return reader.read_file_at(canonical);
}

SceneElement read_scene_text(std::string_view xml, const std::string& label) {
  return SceneFileReader({}).read_text(xml, label);
}

std::optional<std::filesystem::path> find_within(const std::filesystem::path& folder,
                                                 const std::string& name) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  const std::filesystem::path relative(slashed);
  if (name.empty() || relative.is_absolute()) return {};
  const auto root = std::filesystem::weakly_canonical(folder);
  const auto file = std::filesystem::weakly_canonical(root / relative);
  const auto [end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  if (end != root.end() || rest == file.end()) return {};
  return file;
}

std::filesystem::path file_within(const std::filesystem::path& folder, const std::string& name,
                                  const SceneElement& at) {
  if (name.empty()) at.fail("names no file");
  const auto file = find_within(folder, name);
  if (!file) {
    at.fail(fmt::format("names {}; allowed: files in the folder of the scene", in_quotes(name)));
  }
  return *file;
}

}  // namespace lacuna::mitsuba
