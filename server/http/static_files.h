#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "server/http/router.h"

namespace lacuna {

/// The page: a fixed list of files, made when the service starts.
class StaticFiles {
 public:
  /// Lists the regular files directly in `folder` with the extensions of web pages; `index.html` is
  /// also "/". Throws std::invalid_argument if there is no index.html.
  explicit StaticFiles(const std::filesystem::path& folder);

  /// Also serves `file` at `path`, unless it is missing.
  void add(const std::string& path, const std::filesystem::path& file);

  /// Serves a generated file of the page, in place of any file at `path`.
  void add_made(const std::string& path, std::string text);

  bool has(const std::string& path) const { return files_.contains(path) || made_.contains(path); }
  /// Adds a route for each; must outlive `router`.
  void add_to(Router& router) const;

 private:
  struct Entry {
    std::filesystem::path folder;
    std::string name;
    std::string_view media_type;
  };
  std::map<std::string, Entry> files_;
  std::map<std::string, std::string> made_;  ///< texts
};

}  // namespace lacuna
