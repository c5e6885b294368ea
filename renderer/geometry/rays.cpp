#include "renderer/geometry/rays.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <new>

#include "analysis/geometry/simd.h"
#include "renderer/geometry/alpha_mask.h"

namespace lacuna {

namespace {

// Embree's limit for coordinates (rtcore_ray checks) is 1.8e18.
constexpr float largest_coordinate = 1e18F;
// Embree includes both ends of a ray: the smallest float as the start excludes hits at 0.
constexpr float least_distance = std::numeric_limits<float>::min();

bool acceptable(const Ray& ray) {
  // Tests o and d at once; an ordered comparison is false for NaN, too.
  static_assert(sizeof(Ray) == 32);
  const Mask8 small = Float8(largest_coordinate) >= abs(Float8::load(&ray.o.x));
  return (movemask(small) & 0x3f) == 0x3f && ray.tmax >= 0.0F;
}

RTCRay to_embree(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.o.x;
  r.org_y = ray.o.y;
  r.org_z = ray.o.z;
  r.tnear = least_distance;
  r.dir_x = ray.d.x;
  r.dir_y = ray.d.y;
  r.dir_z = ray.d.z;
  r.time = 0.0F;
  r.tfar = ray.tmax;
  r.mask = ~0U;
  r.id = 0;
  r.flags = 0;
  return r;
}
/// Sets ray `i` of a packet that is zero, as to_embree() does.
void put(const Ray& ray, RTCRay8& packet, std::size_t i) {
  packet.org_x[i] = ray.o.x, packet.org_y[i] = ray.o.y, packet.org_z[i] = ray.o.z;
  packet.dir_x[i] = ray.d.x, packet.dir_y[i] = ray.d.y, packet.dir_z[i] = ray.d.z;
  packet.tnear[i] = least_distance, packet.tfar[i] = ray.tmax;
  packet.mask[i] = ~0U;
}

/// Whether ray `i` meets the surface at its candidate hit. The event depends on the bits of the ray
/// and the triangle: on no thread or packet, and not on how often or in which order Embree asks.
bool meets(const AlphaMask& mask, const RTCFilterFunctionNArguments* args, unsigned i) {
  const unsigned n = args->N;
  const std::uint32_t triangle = RTCHitN_primID(args->hit, n, i);
  const float coverage =
      mask.coverage(triangle, {RTCHitN_u(args->hit, n, i), RTCHitN_v(args->hit, n, i)});
  if (coverage >= 1 || !(coverage > 0)) return coverage >= 1;
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const std::array<std::uint32_t, 9> event{
      bits(RTCRayN_org_x(args->ray, n, i)), bits(RTCRayN_org_y(args->ray, n, i)),
      bits(RTCRayN_org_z(args->ray, n, i)), bits(RTCRayN_dir_x(args->ray, n, i)),
      bits(RTCRayN_dir_y(args->ray, n, i)), bits(RTCRayN_dir_z(args->ray, n, i)),
      RTCHitN_geomID(args->hit, n, i),      triangle,
      RTCHitN_instID(args->hit, n, i, 0)};
  return decide_by_bits(coverage, event);
}

// Called by Embree for every candidate hit on a geometry with a mask.
void mask_filter(const RTCFilterFunctionNArguments* args) {
  const auto& mask = *static_cast<const AlphaMask*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != 0 && !meets(mask, args, i)) args->valid[i] = 0;
  }
}

}  // namespace

struct RayCaster::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const SceneData* data = nullptr;
  std::uint32_t first_instance = 0;  // Embree's geometries: the placed meshes, then the instances
  std::vector<std::unique_ptr<AlphaMask>> masks;
  std::atomic<std::int64_t> bytes{0};
  std::string last_error;  // Embree's text
  mutable std::atomic<std::uint64_t> refused{0};
  std::vector<RecordedRay>* recorded = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void check(const char* doing) const {
    const RTCError e = rtcGetDeviceError(device);
    if (e == RTC_ERROR_NONE) return;
    // A task that ran out of memory cancels the others, which may report first; or a thread's stack
    // could not be allocated.
    const bool unnamed =
        e == RTC_ERROR_UNKNOWN &&
        (last_error == "task cancelled" || last_error.starts_with("pthread_create has failed"));
    if (e == RTC_ERROR_OUT_OF_MEMORY || unnamed) throw std::bad_alloc();
    throw SceneError(
        fmt::format("Embree failed while {}: error {} ({})", doing, int(e), last_error));
  }

  /// Adds a mesh to `to`, the scene or a prototype, as geometry `id`.
  void add(RTCScene to, const Mesh& mesh, std::size_t id) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    static_assert(sizeof(V3f) == 12 && sizeof(mesh.triangles[0]) == 12);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(V3f), mesh.positions.size());
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(),
                               0, sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (AlphaMask::needed(*data, mesh)) {
      masks.push_back(std::make_unique<AlphaMask>(*data, mesh));
      rtcSetGeometryUserData(g, masks.back().get());
      rtcSetGeometryIntersectFilterFunction(g, mask_filter);
      rtcSetGeometryOccludedFilterFunction(g, mask_filter);
    }
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(to, g, static_cast<unsigned>(id));
    rtcReleaseGeometry(g);
  }

  RTCScene new_scene() const {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
    return s;
  }

  void build(RTCScene s, const ThreadPool& pool) const {
    rtcSetSceneProgressMonitorFunction(
        s, [](void* user, double) { return !static_cast<const ThreadPool*>(user)->stopped(); },
        const_cast<ThreadPool*>(&pool));
    rtcCommitScene(s);
    rtcSetSceneProgressMonitorFunction(s, nullptr, nullptr);
    pool.check_stop();
    check("building its acceleration structure");
  }

  /// Builds each prototype and places it; Embree's instances keep it alive.
  void add_instances(const ThreadPool& pool) {
    std::vector<RTCScene> built;
    struct Release {
      std::vector<RTCScene>& scenes;
      ~Release() {
        for (RTCScene s : scenes) rtcReleaseScene(s);
      }
    } const release{built};
    for (const Prototype& prototype : data->prototypes) {
      RTCScene s = built.emplace_back(new_scene());
      std::size_t id = 0;
      for (const Mesh& mesh : data->meshes_of(prototype)) add(s, mesh, id++);
      build(s, pool);
    }
    for (std::size_t i = 0; i < data->instances.size(); ++i) {
      const Instance& instance = data->instances[i];
      static_assert(offsetof(Instance, at) == 36 && sizeof instance.axes == 36);
      RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(g, built[instance.prototype]);
      rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, instance.axes.data());
      rtcCommitGeometry(g);
      rtcAttachGeometryByID(scene, g, first_instance + static_cast<unsigned>(i));
      rtcReleaseGeometry(g);
      if (i % 1024 == 0) pool.check_stop();
    }
    check("placing instances");
  }

  /// Names a hit by the indices of SceneData.
  Hit hit(float t, std::array<unsigned, 3> at, float u, float v) const {
    const auto [geometry, triangle, instance] = at;
    if (instance == RTC_INVALID_GEOMETRY_ID) [[likely]]
      return {t, geometry, triangle, u, v};
    const std::uint32_t index = instance - first_instance;
    const Prototype& prototype = data->prototypes[data->instances[index].prototype];
    return {t, prototype.first_mesh + geometry, triangle, u, v, index};
  }
};

RayCaster::RayCaster(SceneData& data, const ThreadPool& pool) : impl_(std::make_unique<Impl>()) {
  impl_->device =
      rtcNewDevice(fmt::format("isa=avx2,threads={},set_affinity=0", pool.threads()).c_str());
  impl_->check("starting");
  rtcSetDeviceErrorFunction(
      impl_->device,
      [](void* user, RTCError, const char* text) {
        static_cast<Impl*>(user)->last_error = text == nullptr ? "" : text;
      },
      impl_.get());
  rtcSetDeviceMemoryMonitorFunction(
      impl_->device,
      [](void* user, ssize_t bytes, bool) {
        static_cast<Impl*>(user)->bytes += bytes;
        return true;
      },
      impl_.get());
  // Embree reads 16 bytes of each position.
  for (Mesh& mesh : data.meshes) mesh.positions.reserve(mesh.positions.size() + 1);
  impl_->data = &data;
  impl_->first_instance = static_cast<std::uint32_t>(data.placed_meshes().size());
  impl_->scene = impl_->new_scene();
  std::size_t id = 0;
  for (const Mesh& mesh : data.placed_meshes()) impl_->add(impl_->scene, mesh, id++);
  impl_->add_instances(pool);
  impl_->build(impl_->scene, pool);
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

bool RayCaster::intersect(const Ray& ray, Hit& hit) const {
  if (impl_->recorded != nullptr) [[unlikely]]
    impl_->recorded->push_back({ray, false});
  if (!acceptable(ray)) [[unlikely]] {
    ++impl_->refused;
    return false;
  }
  RTCRayHit query;
  query.ray = to_embree(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = impl_->hit(query.ray.tfar, {query.hit.geomID, query.hit.primID, query.hit.instID[0]},
                   query.hit.u, query.hit.v);
  return true;
}

void RayCaster::intersect(std::span<const Ray> rays, std::span<Hit> hits,
                          std::span<std::uint8_t> result) const {
  if (impl_->recorded != nullptr) [[unlikely]] {
    for (const Ray& ray : rays) impl_->recorded->push_back({ray, false});
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t first = 0; first < rays.size(); first += 8) {
    RTCRayHit8 q{};
    alignas(32) std::array<int, 8> valid{};
    for (std::size_t i = 0; i < std::min<std::size_t>(8, rays.size() - first); ++i) {
      const Ray& ray = rays[first + i];
      q.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      if (!acceptable(ray)) {
        ++impl_->refused;
        continue;
      }
      valid[i] = -1;
      put(ray, q.ray, i);
    }
    rtcIntersect8(valid.data(), impl_->scene, &context, &q);
    for (std::size_t i = 0; i < std::min<std::size_t>(8, rays.size() - first); ++i) {
      const bool found = q.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      result[first + i] = found ? 1 : 0;
      if (found) {
        hits[first + i] =
            impl_->hit(q.ray.tfar[i], {q.hit.geomID[i], q.hit.primID[i], q.hit.instID[0][i]},
                       q.hit.u[i], q.hit.v[i]);
      }
    }
  }
}

bool RayCaster::occluded(const Ray& ray) const {
  if (impl_->recorded != nullptr) [[unlikely]]
    impl_->recorded->push_back({ray, true});
  if (!acceptable(ray)) [[unlikely]] {
    ++impl_->refused;
    return true;
  }
  RTCRay query = to_embree(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene, &context, &query);
  return query.tfar < 0.0F;
}

void RayCaster::occluded(std::span<const Ray> rays, std::span<std::uint8_t> result) const {
  if (impl_->recorded != nullptr) [[unlikely]] {
    for (const Ray& ray : rays) impl_->recorded->push_back({ray, true});
  }
  constexpr std::size_t batch = 128;  // fits the first-level cache
  std::array<RTCRay, batch> queries;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t n = std::min(batch, rays.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      const Ray& ray = rays[first + i];
      const bool good = acceptable(ray);
      queries[i] = to_embree(good ? ray : Ray{V3f(0, 0, 0), V3f(0, 0, 1), 0});
      if (!good) {
        ++impl_->refused;
        queries[i].tfar = -1;  // inactive; read below as occluded
      }
    }
    rtcOccluded1M(impl_->scene, &context, queries.data(), static_cast<unsigned>(n), sizeof(RTCRay));
    for (std::size_t i = 0; i < n; ++i) result[first + i] = queries[i].tfar < 0.0F ? 1 : 0;
  }
}

void RayCaster::occluded_together(std::span<const Ray> rays, std::span<std::uint8_t> result) const {
  if (impl_->recorded != nullptr) [[unlikely]] {
    for (const Ray& ray : rays) impl_->recorded->push_back({ray, true});
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t first = 0; first < rays.size(); first += 8) {
    RTCRay8 q{};
    alignas(32) std::array<int, 8> valid{};
    for (std::size_t i = 0; i < std::min<std::size_t>(8, rays.size() - first); ++i) {
      const Ray& ray = rays[first + i];
      q.tfar[i] = -1;
      if (!acceptable(ray)) {
        ++impl_->refused;
        continue;
      }
      valid[i] = -1;
      put(ray, q, i);
    }
    rtcOccluded8(valid.data(), impl_->scene, &context, &q);
    for (std::size_t i = 0; i < std::min<std::size_t>(8, rays.size() - first); ++i) {
      result[first + i] = q.tfar[i] < 0.0F ? 1 : 0;
    }
  }
}

void RayCaster::record(std::vector<RecordedRay>* rays) const { impl_->recorded = rays; }
std::uint64_t RayCaster::refused_rays() const { return impl_->refused; }
int RayCaster::filters() const { return static_cast<int>(impl_->masks.size()); }
RTCSceneTy* RayCaster::embree_scene() const { return impl_->scene; }
std::uint64_t RayCaster::bytes() const {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, impl_->bytes));
}

}  // namespace lacuna
