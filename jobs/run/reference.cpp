#include "jobs/run/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "jobs/spec/reference_spec.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/images/image_read.h"

namespace lacuna {

namespace {

const std::vector<std::string_view> reference_extensions{".exr", ".hdr", ".pfm", ".tif", ".tiff"};

bool is_image_file(const std::string& name) {
  return std::any_of(reference_extensions.begin(), reference_extensions.end(),
                     [&](std::string_view e) { return name.ends_with(e); });
}

bool is_plain_name(const std::string& s) {
  return !s.empty() && s.front() != '.' && s.find('/') == std::string::npos &&
         s.find('\0') == std::string::npos;
}

}  // namespace

Reference read_reference(const std::string& name, const std::filesystem::path& image,
                         const std::array<int, 2>& resolution) {
  const FloatImage file = read_reference_image(image);
  if (file.width != resolution[0] || file.height != resolution[1]) {
    throw SceneError(fmt::format("reference \"{}\" has {} x {} pixels, but the job has {} x {}",
                                 name, file.width, file.height, resolution[0], resolution[1]));
  }
  require_finite(file, fmt::format("reference \"{}\"", name));
  Reference r{name, {file.rgb.begin(), file.rgb.end()}, std::nullopt, image, file.file};
  r.input.role = InputRole::reference;
  r.input.name = name;
  if (const auto rmse = file.attributes.find("lacuna:est_rmse"); rmse != file.attributes.end()) {
    double value = 0;
    const std::string& text = rmse->second;
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc()) {
      r.mse = value * value;
    }
  }
  return r;
}

std::filesystem::path reference_file(const std::string& name, const DataRoot& data,
                                     const ScenesRoots& scenes, std::string_view what) {
  if (is_image_file(name)) {
    try {
      return scenes.resolve(name, reference_extensions);
    } catch (const std::invalid_argument& e) {
      throw SceneError(fmt::format("{} \"{}\": {}", what, name, e.what()));
    }
  }
  std::error_code error;
  const auto is_there = [&](const std::filesystem::path& path) {
    const bool there = std::filesystem::exists(path, error);
    throw_if_it_may_pass(error.value(), path, path.parent_path());
    return there;
  };
  if (is_job_id(name)) {
    const JobFolder folder(data.jobs() / name);
    if (is_there(folder.dir())) return folder.file("image.exr");
    throw SceneError(fmt::format("{} \"{}\": no such job", what, name));
  }
  const auto file = data.references() / name / "image.exr";
  if (is_plain_name(name) && is_there(file)) return file;
  throw SceneError(fmt::format(
      "{} \"{}\": neither \"auto\", nor an .exr, .hdr, .pfm or .tif below a scenes root, "
      "nor a job's id, nor a folder in {}",
      what, name, data.references().string()));
}

Reference find_reference(const JobSpec& spec, const DataRoot& data, const ScenesRoots& scenes) {
  const std::string& name = spec.reference;
  const std::filesystem::path file = reference_file(name, data, scenes);
  if (is_job_id(name)) {
    const State state = JobFolder(file.parent_path()).read_state().state;
    if (state != State::done) {
      throw SceneError(
          fmt::format("reference \"{}\": that job is {}, not done", name, enum_name(state)));
    }
  }
  return read_reference(name, file, spec.resolution);
}

ReferenceJob auto_reference(const JobSpec& spec, const DataRoot& data, const std::string& content) {
  JobSpec r = reference_spec(spec);
  const std::string name =
      fmt::format("auto-{}-{}-{}", picture_key(r), content, spec.reference_iterations);
  return {r, JobFolder(data.references() / name)};
}

}  // namespace lacuna
