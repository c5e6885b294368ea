#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "jobs/import/imported_scene.h"
#include "jobs/import/pbrt/pbrt_parameters.h"

namespace lacuna::pbrt {

enum class Version { v3, v4 };

enum class ColourSpace { srgb, rec2020, dci_p3, aces };

/// A material of the file. It may be named before it is defined.
struct MaterialEntry {
  std::shared_ptr<ImportedMaterial> material;
  bool defined = false;
  bool invisible = false;  ///< `interface`: a boundary of media only
  Place first_use;
  std::string name;
};

/// Named textures and materials. In pbrt-v3 they belong to the graphics state.
struct Names {
  std::map<std::string, ImportedValue> float_textures, spectrum_textures;
  std::map<std::string, std::shared_ptr<MaterialEntry>> materials;
};

/// What all readers of statements need: the file's version and folder, and the notes.
class Context {
 public:
  Context(const std::filesystem::path& file, Version file_version)
      : version(file_version), folder(file.parent_path()) {}

  const Version version;
  const std::filesystem::path folder;  ///< of the main file
  ColourSpace colours = ColourSpace::srgb;
  Names names;

  bool is_v3() const { return version == Version::v3; }

  void approximated(const Place& place, const std::string& name, const std::string& how) {
    note(place, name, "approximated", how);
  }
  void left_out(const Place& place, const std::string& name, const std::string& how) {
    note(place, name, "left out", how);
  }
  /// Notes the parameters that no look-up has found.
  void note_unused(const Parameters& parameters);
  /// The notes, each once, with the number of further places.
  std::vector<ImportNote> notes() const;

  /// The path of a file that a statement names. None if the folder of the main file has no such
  /// file, which is remembered. Throws SceneError for a link that leads out of the folder.
  std::optional<std::filesystem::path> find_file(const std::string& name, const Place& place,
                                                 const std::string& owner);
  struct MissingFile {
    Place place;
    std::string owner;
    std::string how;  ///< name and reason
  };
  const std::vector<MissingFile>& missing() const { return missing_; }

  /// The same, whether the file exists or not. Throws SceneError if it lies outside the folder.
  std::filesystem::path resolve(const std::string& name, const Place& place) const;

  /// Remembers a material that is named before it is defined.
  void expect(std::shared_ptr<MaterialEntry> entry) { expected_.push_back(std::move(entry)); }
  /// Throws SceneError for the first material that no statement has defined.
  void require_materials() const;

 private:
  void note(const Place& place, const std::string& name, const std::string& treatment,
            const std::string& how);

  struct Counted {
    ImportNote note;
    std::size_t more = 0;
  };
  std::vector<Counted> notes_;
  std::map<std::string, std::size_t> known_;  // treatment, kind of thing and how -> index of notes_
  std::vector<MissingFile> missing_;
  std::vector<std::shared_ptr<MaterialEntry>> expected_;
};

}  // namespace lacuna::pbrt
