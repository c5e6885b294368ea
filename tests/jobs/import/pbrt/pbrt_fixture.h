#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "jobs/import/pbrt/read_pbrt.h"
#include "renderer/core/scene_error.h"
#include "tests/temporary_folder.h"

namespace lacuna {

/// Scene files of a test in a folder of their own.
class PbrtFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const auto file = folder_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  ImportedScene import(const std::string& text, MissingFiles missing = MissingFiles::refuse) const {
    return read_pbrt(write("scene.pbrt", text), missing);
  }
  /// The message that the import of `text` ends with.
  std::string error(const std::string& text) const {
    try {
      import(text);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "no error";
  }
  std::filesystem::path path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// Names of the statements that have notes, in order.
inline std::string noted(const ImportedScene& scene) {
  std::string out;
  for (const ImportNote& n : scene.notes) out += n.name + ": " + n.how + "\n";
  return out;
}

inline void expect_near(const V3d& a, const V3d& b, double tolerance = 1e-6) {
  EXPECT_LE((a - b).length(), tolerance) << a << " " << b;
}
inline void expect_colour(const Rgb& a, const Rgb& b, double tolerance = 1e-5) {
  expect_near(V3d(a), V3d(b), tolerance);
}

/// A film that only this version has.
inline const std::string v3_film =
    "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 32\n";
inline const std::string v4_film =
    "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 32\n";
inline const std::string triangle =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer indices\" [0 1 2]\n";

}  // namespace lacuna
