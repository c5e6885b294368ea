#include "jobs/run/checkpoint.h"

#include <algorithm>
#include <cstring>

#include "base/storage/atomic_file.h"
#include "jobs/run/render_loop.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

// A checkpoint. The bytes are read as a whole file, where the checksum stops nearly all of them,
// and as the content of a file with a right header: refused, or a state from which the loop goes
// on, and which it writes as it was.

namespace lacuna::fuzz {
namespace {

/// Gives a picture without rendering one, and has some state to save.
class Still final : public Integrator {
 public:
  static constexpr std::size_t saved_bytes = sizeof(std::uint64_t);

  SceneNeeds needs() const override { return {}; }
  std::vector<std::string> layers(std::span<const ImageLayer>) override { return {"a", "b"}; }
  Counters iterate(const IterationContext& context, Image& image) override {
    for (Rgb& p : image.pixels) p = Rgb(1, 2, static_cast<float>(context.iteration));
    for (Image& layer : context.layers) layer.pixels = image.pixels;
    ++learned_;
    return {image.pixels.size(), image.pixels.size(), 0, 0, 0};
  }
  void save(ByteWriter& out) const override { out.put(learned_); }
  void load(ByteReader& in) override { learned_ = in.get<std::uint64_t>(); }

 private:
  std::uint64_t learned_ = 0;
};

class Quiet final : public Observer {
 public:
  void phase(const std::string&) override {}
  void progress(const Progress&) override {}
  void milestone(const std::string&) override {}
  void warning(const std::string&) override { ++warnings; }
  int warnings = 0;
};

SceneData one_triangle() {
  SceneData data;
  data.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  data.meshes.push_back(std::move(mesh));
  return data;
}

/// The content of a checkpoint of `key`. Throws std::runtime_error.
std::string content_of(const std::filesystem::path& file, const std::string& key) {
  std::string content;
  read_checkpoint(file, key, [&](ByteReader& in) {
    content.resize(in.remaining());
    in.read(content.data(), content.size());
  });
  return content;
}

/// A job that renders two by two pixels.
class Job {
 public:
  Job() {
    spec.scene = "a.glb";
    spec.resolution = {2, 2};
    spec.budget.iterations = 1000;
    spec.checkpoint_seconds = 86400;
  }

  /// Goes on from `checkpoint`, for `iterations` more, and gives the content that is saved after
  /// them; nothing if the checkpoint was refused.
  std::optional<std::string> go_on(int iterations) {
    Still still;
    Quiet quiet;
    int left = iterations;
    const std::function<bool()> interrupted = [&] { return left-- <= 0; };
    RenderLoop loop({folder, spec, scene, camera, pool, still, &reference, interrupted, quiet,
                     phases, "content"});
    loop.resume();
    if (quiet.warnings > 0) return std::nullopt;
    loop.run();
    return content_of(checkpoint(), key_of(read_file(checkpoint(), 1 << 20)));
  }

  std::filesystem::path checkpoint() const { return folder.file("checkpoint.bin"); }
  /// The key in the header of a checkpoint.
  static std::string key_of(const std::string& bytes) {
    ByteReader in(bytes);
    in.get_string();
    return in.get_string();
  }

  Folder temporary;
  JobFolder folder{temporary.dir()};
  JobSpec spec;
  ThreadPool pool{1};
  Scene scene{one_triangle(), {}, std::nullopt, pool};
  Camera camera{CameraData{}, 2, 2};
  Reference reference{"reference", std::vector<double>(12, 1.0), 0.5};
  PhaseSeconds phases;
};

/// The job, the key of its checkpoints, and one that the loop wrote itself.
struct Ready {
  Job job;
  std::string own = job.go_on(3).value();
  std::string key = Job::key_of(read_file(job.checkpoint(), 1 << 20));
};
Ready& ready() {
  static Ready once;
  return once;
}

void read_as_file(std::string_view bytes) {
  Job& job = ready().job;
  write_file_atomically(job.checkpoint(), bytes, false);
  try {
    content_of(job.checkpoint(), ready().key);
  } catch (const std::runtime_error&) {
  }
}

void read_as_content(const std::string& content) {
  Job& job = ready().job;
  write_checkpoint(job.checkpoint(), ready().key,
                   [&](ByteWriter& out) { out.append(content.data(), content.size()); });
  job.phases.clear();
  if (const auto saved = job.go_on(0)) {
    // At its end stand the seconds of the phases, which go on, and what was learned.
    const std::size_t learned = sizeof(std::uint64_t) + Still::saved_bytes;
    std::size_t tail = sizeof(std::uint64_t) + learned;
    for (const auto& [name, seconds] : job.phases) {
      tail += sizeof(std::uint64_t) + name.size() + sizeof seconds;
    }
    const std::string_view all = *saved;
    expect(content.starts_with(all.substr(0, all.size() - tail)) &&
               content.ends_with(all.substr(all.size() - learned)),
           "what a checkpoint restores is saved as it was");
  }
}

}  // namespace
}  // namespace lacuna::fuzz

/// Begins with a checkpoint of today's layout, so that no stored one can be out of date.
LACUNA_FUZZ_MUTATOR(checkpoint) {
  const std::string& own = lacuna::fuzz::ready().own;
  if (size < 16 && own.size() <= max_size) {
    std::copy(own.begin(), own.end(), data);
    size = own.size();
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

LACUNA_FUZZ_TARGET(checkpoint) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  lacuna::fuzz::read_as_file(bytes);
  lacuna::fuzz::read_as_content(bytes);
  return 0;
}
