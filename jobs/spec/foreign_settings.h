#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/settings/field.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// A picture that another program has rendered.
struct ForeignPicture {
  std::string file;
  double seconds = 0;
  std::optional<double> cpu_seconds;
  std::optional<std::uint64_t> seed;
  bool operator==(const ForeignPicture&) const = default;
};
template <class V>
void describe(V& v, ForeignPicture& s) {
  v("file", s.file,
    {.doc = "EXR, Radiance HDR, PFM or TIFF of floats, below a scenes root; {scene} is the stem of "
            "the job's scene, {seed} the run's seed",
     .min = 1,
     .max = 1024,
     .required = true});
  v("seconds", s.seconds,
    {.doc = "render time, wall clock",
     .min = 0,
     .max = 1e7,
     .above_min = true,
     .required = true,
     .unit = "s"});
  v("cpu_seconds", s.cpu_seconds,
    {.doc = "render time, CPU seconds divided by threads; none: not known",
     .min = 0,
     .max = 1e7,
     .above_min = true,
     .unit = "s"});
  v("seed", s.seed,
    {.doc = "the run that the picture belongs to; none: 1, or every seed if the file is named by "
            "{seed}",
     .min = 0,
     .max = 9007199254740991.0});
}

/// The time of a program before it renders.
struct ForeignStart {
  double seconds = 0, cpu_seconds = 0;
  bool operator==(const ForeignStart&) const = default;
};
template <class V>
void describe(V& v, ForeignStart& s) {
  v("seconds", s.seconds, {.doc = "wall clock", .min = 0, .max = 1e7, .unit = "s"});
  v("cpu_seconds", s.cpu_seconds,
    {.doc = "CPU seconds divided by threads", .min = 0, .max = 1e7, .unit = "s"});
}

/// The format of a picture that a program writes.
enum class ForeignFormat { exr, pfm, hdr };

template <>
struct EnumTable<ForeignFormat> {
  static constexpr std::array<EnumValue<ForeignFormat>, 3> values{{
      {ForeignFormat::exr, "exr", "OpenEXR"},
      {ForeignFormat::pfm, "pfm", "portable float map"},
      {ForeignFormat::hdr, "hdr", "Radiance HDR"},
  }};
};

/// integrator: foreign. Not a method of the renderer: jobs/run/foreign_job.h runs the program, or
/// reads what it has rendered.
struct ForeignSettings : PathLengths {
  static constexpr std::string_view name = "foreign";
  static constexpr std::string_view doc =
      "another program's pictures, with their times, or a command that renders them; what cannot "
      "be known of them (rays, halves) is empty";

  std::string program;
  std::vector<ForeignPicture> pictures;
  std::vector<std::string> command;
  std::vector<double> seconds;
  ForeignFormat format = ForeignFormat::exr;
  std::string layer;
  ForeignStart start;
  double timeout = 3600;

  std::string_view conflict() const {
    if (pictures.empty() == command.empty()) {
      return "\"pictures\" and \"command\" both or neither; allowed: one of the two";
    }
    if (!command.empty() && command.front().empty()) {
      return "a command without a program; allowed: the name of a program, then its arguments";
    }
    return {};
  }
  static std::string_view without_lengths() { return "renders with another program"; }
  static std::string_view without_letters() { return without_lengths(); }
  bool operator==(const ForeignSettings&) const = default;
};

template <class V>
void describe(V& v, ForeignSettings& s) {
  v("name", s.program,
    {.doc = "name of the program and its method, in tables and figures",
     .min = 1,
     .max = 100,
     .required = true});
  v("max_depth", s.max_depth,
    {.doc = "longest path that the program renders: that of an \"auto\" reference, too",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("pictures", s.pictures, {.doc = "what the program has rendered", .max = 10000});
  v("command", s.command,
    {.doc =
         "program and arguments that render one picture, without a shell; {out} is the file to "
         "write, {scene} the scene's file, and {camera}, {width}, {height}, {max_depth}, {seed}, "
         "{seconds}, {threads} are those of the run. Only `lacuna` runs commands, the service "
         "refuses them",
     .max = 256});
  v("seconds", s.seconds,
    {.doc = "render times that the command is asked for, one picture each; none: the budget's",
     .max = 64});
  v("format", s.format, {.doc = "format of {out}"});
  v("layer", s.layer,
    {.doc = "layer of an EXR: \"beauty\" is beauty.R, beauty.G, beauty.B; empty: R, G, B",
     .max = 200});
  v("start", s.start, {.doc = "time of the command before it renders, which does not count"});
  v("timeout", s.timeout,
    {.doc = "time after which a command is killed and the run fails",
     .min = 0,
     .max = 1e7,
     .above_min = true,
     .unit = "s"});
}

}  // namespace lacuna
