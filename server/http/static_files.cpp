#include "server/http/static_files.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "server/http/conditional.h"
#include "server/http/file_response.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

std::string_view media_type(const fs::path& file) {
  using Pair = std::pair<std::string_view, std::string_view>;
  constexpr std::array<Pair, 5> types{{{".html", "text/html; charset=utf-8"},
                                       {".css", "text/css; charset=utf-8"},
                                       {".js", "text/javascript; charset=utf-8"},
                                       {".svg", "image/svg+xml"},
                                       {".png", "image/png"}}};
  for (const auto& [ending, type] : types) {
    if (file.extension() == ending) return type;
  }
  return {};
}

bool is_regular(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(file, error));
}

}  // namespace

StaticFiles::StaticFiles(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!media_type(entry.path()).empty()) {
      add(fmt::format("/{}", entry.path().filename().string()), entry.path());
    }
  }
  if (!has("/index.html")) {
    throw std::invalid_argument(fmt::format("{} contains no page (index.html)", folder.string()));
  }
  files_["/"] = files_.at("/index.html");
}

void StaticFiles::add(const std::string& path, const fs::path& file) {
  if (!is_regular(file)) return;
  files_[path] = {file.parent_path(), file.filename().string(), media_type(file)};
}

void StaticFiles::add_made(const std::string& path, std::string text) {
  made_[path] = std::move(text);
  files_.erase(path);
}

void StaticFiles::add_to(Router& router) const {
  for (const auto& [path, text] : made_) {
    router.add("GET", path, {.for_programs = false},
               [&path = path, &text = text](const Request& request, const Router::Parts&) {
                 Response response;
                 response.content_type = media_type(path);
                 response.body = text;
                 return with_tag(request, std::move(response));
               });
  }
  for (const auto& [path, entry] : files_) {
    router.add("GET", path, {.for_programs = false},
               [&entry = entry](const Request& request, const Router::Parts&) {
                 return file_response(request, entry.folder, entry.name, entry.media_type);
               });
  }
}

}  // namespace lacuna
