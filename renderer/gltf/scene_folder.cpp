#include "renderer/gltf/scene_folder.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "base/storage/passing_error.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {
namespace {

constexpr std::uintmax_t byte_limit = (std::uintmax_t{1} << 31) - 1;  // tinygltf counts in int

constexpr std::size_t max_uri = 4096;  // PATH_MAX of Linux

[[noreturn]] void refuse_escape(const std::string& uri, const std::string& place) {
  throw SceneError(place + " has a broken escape in \"" + uri +
                   "\"; allowed: % and two hexadecimal digits, not 00");
}

}  // namespace

std::string percent_decode(const std::string& uri, const std::string& place) {
  std::string out;
  out.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out.push_back(uri[i]);
      continue;
    }
    unsigned value = 0;
    const char* first = uri.data() + i + 1;
    const bool complete = i + 2 < uri.size();
    if (!complete || std::from_chars(first, first + 2, value, 16).ptr != first + 2 || value == 0) {
      refuse_escape(uri, place);
    }
    out.push_back(static_cast<char>(value));
    i += 2;
  }
  return out;
}

SceneFolder::SceneFolder(const std::filesystem::path& main_file)
    : main_file_(main_file), bytes_left_(byte_limit) {
  std::error_code error;
  const auto parent = main_file.has_parent_path() ? main_file.parent_path() : ".";
  root_ = std::filesystem::canonical(parent, error);
  if (!error) return;
  if (may_pass(error.value())) throw_if_it_may_pass(error.value(), main_file, parent);
  throw SceneError("its folder cannot be opened: " + error.message());
}

Bytes SceneFolder::read_main() {
  return read_regular(main_file_, "the scene file", {.role = InputRole::scene});
}

Bytes SceneFolder::read(const std::string& uri, const std::string& place, InputRole role) {
  return read_regular(find(uri, place), place + ": \"" + uri + "\"", {.role = role, .name = uri});
}

std::filesystem::path SceneFolder::find(const std::string& uri, const std::string& place) const {
  if (uri.size() > max_uri) {
    throw SceneError(place + " is a path of " + std::to_string(uri.size()) +
                     " bytes; allowed: " + std::to_string(max_uri));
  }
  std::string name = percent_decode(uri, place);
  std::replace(name.begin(), name.end(), '\\', '/');  // as exporters on Windows write paths
  const std::filesystem::path relative(name);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (name.empty() || name.find('\0') != std::string::npos || relative.is_absolute() || climbs ||
      name.find(':') != std::string::npos) {
    throw SceneError(place + " is \"" + uri +
                     "\"; allowed: a relative path inside the scene's folder");
  }
  std::error_code error;
  const auto file = std::filesystem::canonical(root_ / relative, error);
  if (error) {
    throw_if_it_may_pass(error.value(), root_ / relative, root_);
    throw SceneError(place + ": \"" + uri + "\" cannot be opened: " + error.message());
  }
  const auto [root_end, rest] = std::mismatch(root_.begin(), root_.end(), file.begin(), file.end());
  if (root_end != root_.end()) {
    throw SceneError(place + ": \"" + uri + "\" leaves the scene's folder by a symbolic link");
  }
  return file;
}

Bytes SceneFolder::read_regular(const std::filesystem::path& file, const std::string& place,
                                InputFile about) {
  try {
    Bytes bytes = read_input(file, bytes_left_, about);
    bytes_left_ -= bytes.size();
    const auto same = [&](const InputFile& i) {
      return i.role == about.role && i.name == about.name;
    };
    if (std::none_of(inputs_.begin(), inputs_.end(), same)) inputs_.push_back(std::move(about));
    return bytes;
  } catch (const std::length_error& e) {
    throw SceneError(place + " " + e.what() + "; allowed: " + std::to_string(byte_limit) +
                     " for all files of a scene");
  } catch (const std::invalid_argument& e) {
    throw SceneError(place + " " + e.what());
  }
}

}  // namespace lacuna
