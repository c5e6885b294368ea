#pragma once

#include <cstdint>
#include <optional>

#include "renderer/core/density.h"
#include "renderer/core/vec.h"
#include "renderer/materials/facets.h"
#include "renderer/materials/lambert.h"
#include "renderer/materials/lobes.h"

namespace lacuna {

/// The quantity that a path transports: radiance (eye paths) or importance (light paths). They
/// differ if the BSDF is not symmetric: under refraction and with shading normals (Veach 1997, ch.
/// 5).
enum class Transport { radiance, importance };

/// A direction sampled from a BSDF.
struct BsdfSample {
  V3f wi;      ///< unit, world space, leaves the surface
  Rgb weight;  ///< f |cos| / pdf; for a delta lobe: reflectance or transmittance over its
               ///< probability
  /// Density of wi summed over all non-delta lobes; undefined for a delta lobe.
  Pdf<SolidAngle> pdf;
  bool delta = false;
  bool transmitted = false;  ///< wi lies on the other side of ng
  /// For a direction sampled with a guide (renderer/guides): `pdf` over the BSDF's density.
  float pdf_ratio = 1;
};

/// A delta lobe between two directions, with the probabilities of both transports.
struct DeltaLobe {
  V3f wi;     ///< unit
  Rgb value;  ///< f |cos| for radiance, without the delta in wi
  /// Probability that radiance from wo is scattered to wi.
  double p_radiance = 0;
  /// Probability that importance from wi is scattered to wo, times `jacobian`.
  double p_importance = 0;
  /// The delta in wo over the delta in wi: 1 except under refraction.
  double jacobian = 1;
};

/// Smaller cosines are rounding errors.
inline constexpr float cos_rounding = 0x1p-24F;

/// A Lambertian surface that light reaches from a fixed direction: towards unit `w` its eval() is
/// f (w.side) t if w.side > 0, else 0; t is `shading_cosine_ratio` if w.ns > 0, else 1.
struct LambertLobe {
  Rgb f;                       ///< diffuse reflectance / pi
  V3f side;                    ///< unit; ng on the side of the light
  V3f ns;                      ///< unit; ns on the side of the light
  float shading_cosine_ratio;  ///< >= 0
};

/// The BSDF at a point of a surface: a flat value, constructed for each hit, without allocation or
/// virtual calls. The glTF metallic-roughness model, mix(dielectric, metal, metallic):
/// - metal: GGX, Schlick from base_color to white;
/// - dielectric: a GGX layer, Schlick from f0 to f90, over Lambert (layer.h), which may scatter to
///   both sides; where it transmits, an interface with exact Fresnel (interface.h);
/// - over both, sheen and a coat (covers.h).
/// With f0 = f90 = 0 and no other lobe it is exactly Lambert. docs/materials.md has the equations.
///
/// `wo` and `wi` are unit, in world space, and leave the surface; `wi` is sampled. The geometric
/// normal `ng` decides on which side a direction lies, so light never leaks through a surface.
/// Cosines use the shading normal `ns`, or `ng` if the direction towards the eye lies behind `ns`,
/// or, on an opaque specular surface, if its mirror image about `ns` lies behind the surface: with
/// `ns` it would scatter little or nothing there, and show a black fringe. The direction towards
/// the eye is `wo` for radiance and `wi` for importance, so both transports measure the same light:
///   eval(a, b, importance) = eval(b, a, radiance) |b.ng| / |a.ng|   (Veach 1997, sec. 5.3.2).
/// A coat may have a normal of its own, for which the same holds.
/// All surfaces scatter on both sides; the two sides of an opaque surface are equal.
class Bsdf {
 public:
  /// `ng` and `ns` are unit; `ns` is flipped to the side of `ng`. `wo` may lie on either side.
  /// `lobes` are Lobes, which are not copied and outlive the Bsdf and its copies; or what Lobes are
  /// made of: the Bsdf holds these itself.
  template <class Surface>
  Bsdf(const Surface& lobes, const V3f& ng, const V3f& ns)
      : ng_(ng),
        ns_(dot(ns, ng) < 0 ? -ns : ns),
        flat_((ns_ - ng).length2() < 1e-12F),
        lobes_(lobes) {}
  Bsdf(const Lobes&&, const V3f&, const V3f&) = delete;

  /// Whether set_tangents() must be called: the facets have two widths.
  bool needs_tangents() const {
    return lobes_->further && lobes_->further->two_widths(lobes_->interface.alpha);
  }
  /// The tangent frame of the surface, unit, in which SurfaceParams::direction lies.
  void set_tangents(const V3f& tangent, const V3f& bitangent) {
    if (!needs_tangents()) return;
    along_ = lobes_->further->direction.x * tangent + lobes_->further->direction.y * bitangent;
  }

  /// f(wo, wi) |cos(wi, ns)| of all non-delta lobes; the cosine is included.
  Rgb eval(const V3f& wo, const V3f& wi, Transport transport) const {
    if (plain_lambert(transport)) return lobes_->diffuse * lambert(wo, wi);
    return eval_any(wo, wi, transport);
  }

  /// Whether eval(wo, wi, radiance) is the same for wo = `a` and wo = `b`, for every wi.
  bool is_constant_in_wo(const V3f& a, const V3f& b) const {
    return lobes_->kind == Lobes::Kind::lambert && flat_ && dot(a, ng_) * dot(b, ng_) > 0;
  }

  /// Density with which sample(wo) returns wi by a non-delta lobe. It integrates to 1 minus the
  /// probability of the delta lobes and of failure. It depends on `transport` only if ns differs
  /// from ng: importance must also reach eyes behind ns.
  Pdf<SolidAngle> pdf(const V3f& wo, const V3f& wi,
                      Transport transport = Transport::radiance) const {
    if (plain_lambert(transport)) return Pdf<SolidAngle>(lambert(wo, wi));
    return pdf_any(wo, wi, transport);
  }

  /// eval() and pdf() of one direction.
  struct Evaluated {
    Rgb value{0, 0, 0};
    Pdf<SolidAngle> pdf{};
  };
  /// Both at once, bit-identical to eval() and pdf(): they share most terms. If f is black, the
  /// density may be 0.
  Evaluated evaluate(const V3f& wo, const V3f& wi, Transport transport) const {
    if (!plain_lambert(transport)) return evaluate_any(wo, wi, transport);
    const float l = lambert(wo, wi);
    return {lobes_->diffuse * l, Pdf<SolidAngle>(l)};
  }

  /// Samples wi. `u_lobe` and `u` are uniform in [0, 1). None if the sample fails (below the
  /// surface) or the surface is black.
  std::optional<BsdfSample> sample(const V3f& wo, double u_lobe, const V2f& u,
                                   Transport transport) const {
    if (plain_lambert(transport)) return sample_lambert(wo, u);
    return sample_any(wo, u_lobe, u, transport);
  }

  /// The delta lobe that reflects or transmits the direction `wo`, towards the eye; none if there
  /// is no such lobe.
  std::optional<DeltaLobe> delta(const V3f& wo, bool transmitted) const;

  /// Whether Lambert's lobes, reflected and transmitted, scatter at least half of the light from
  /// `to_light` to `to_eye` that all lobes but the delta ones scatter, by luminance.
  bool mostly_diffuse(const V3f& to_eye, const V3f& to_light) const;

  /// Whether some lobe is not a delta, so that the vertex can be connected to others.
  bool connectible() const {
    return lobes_->kind == Lobes::Kind::lambert ||
           (lobes_->kind == Lobes::Kind::layered &&
            (!lobes_->interface.smooth() || lobes_->has_diffuse() ||
             (lobes_->further && has_broad_further())));
  }

  /// eval(from, w, importance) as a function of w; none unless the surface is purely Lambertian.
  std::optional<LambertLobe> lambert_lobe(const V3f& from) const;

  /// Whether the surface can carry and receive virtual lights: it is opaque and has a broad lobe,
  /// diffuse or GGX with alpha >= `least_alpha`, or sheen.
  bool is_vpl_receiver(float least_alpha) const {
    if (transmits() || !connectible()) return false;
    return lobes_->has_diffuse() || lobes_->interface.alpha >= least_alpha ||
           (lobes_->further &&
            (lobes_->further->covers.sheen.any() ||
             lobes_->further->covers.coat.alpha >= least_alpha || coating_alpha() >= least_alpha));
  }
  /// Whether some lobe transmits light to the other side.
  bool transmits() const {
    return lobes_->kind == Lobes::Kind::layered &&
           (lobes_->interface.glass > 0 ||
            (lobes_->further && !is_black(lobes_->further->diffuse_through)));
  }
  /// The medium that light crosses in direction `w`; null: none.
  const Medium* medium(const V3f& w) const {
    return lobes_->medium != nullptr && dot(w, ng_) < 0 ? lobes_->medium : nullptr;
  }

  /// Albedo, for the layer of that name: the sum of the lobes' reflectances.
  Rgb albedo() const;

 private:
  friend class BsdfAtWo;

  /// Probabilities of the lobes for one wo; they sum to 1, or are all 0.
  struct Choice {
    double diffuse = 0;
    double through = 0;  ///< of Lambert's lobe on the other side
    double facets = 0;   ///< of sampling a facet, which reflects or transmits
    double clear = 0;    ///< of the transmission of Interface::clear()
    double coat = 0, sheen = 0;
  };
  /// The quantities that depend on `wo` and the normal used.
  struct ShadingFrame {
    V3f n;  ///< on the side of wo
    bool front;
    float cos_o;
    float eta;                     ///< Interface::eta()
    float bend;                    ///< Interface::bend()
    float mean_weight = 0;         ///< of the layer, if facets_compete()
    Covers::Through through = {};  ///< on the side of wo
    V3f coat_n = {};               ///< as `n`, of a coat; set if there are further lobes
  };
  /// The normal of a coat that has its own: the one that an eye sees, or one of its two.
  enum class CoatFrame : std::uint8_t { seen, own, flat };
  /// f |cos| for radiance, and the density for one normal; 0 unless requested.
  struct Scatter {
    Rgb f{0, 0, 0};
    float pdf = 0;
  };
  /// The delta lobes of one direction together, without the 1 / bend^2 of radiance.
  struct DeltaSum {
    Rgb value{0, 0, 0};  ///< reflectance or transmittance
    double p = 0;        ///< probability of sampling one; 0: there is none
  };
  /// A sample of a lobe, before the test of its side.
  struct LobeSample {
    V3f wi;
    bool transmitted = false;
    DeltaSum delta = {};
    bool by_coat = false;
  };

  /// Whether the BSDF is a single symmetric Lambertian lobe: the fast path.
  bool plain_lambert(Transport transport) const {
    return lobes_->kind == Lobes::Kind::lambert && (flat_ || transport == Transport::radiance);
  }
  float lambert(const V3f& wo, const V3f& wi) const {
    const float side = dot(wo, ng_);
    const float side_i = dot(wi, ng_);
    if (!(side > 0 ? side_i > 0 : side < 0 && side_i < 0)) return 0;
    return std::max(0.0F, dot(wi, front_normal(wo, side)) * inv_pi);
  }
  std::optional<BsdfSample> sample_lambert(const V3f& wo, const V2f& u) const {
    const float side = dot(wo, ng_);
    const V3f n = front_normal(wo, side);
    const V3f wi = sample_cosine(n, u);
    const float side_i = dot(wi, ng_);
    if (!(side > 0 ? side_i > 0 : side < 0 && side_i < 0)) return std::nullopt;
    return BsdfSample{wi, lobes_->diffuse, Pdf<SolidAngle>(dot(wi, n) * inv_pi), false, false};
  }

  // Below, side = dot(w, ng).

  /// Whether nothing is scattered to or from this side.
  bool dark(float side) const {
    return lobes_->kind == Lobes::Kind::black || side == 0 ||
           (lobes_->further && lobes_->further->one_sided && side < 0);
  }

  bool in_front_of_ns(const V3f& w, float side) const { return dot(w, side < 0 ? -ns_ : ns_) > 0; }
  /// ng or ns, on the side of `w`.
  V3f normal(bool with_ns, float side) const {
    const V3f& n = with_ns ? ns_ : ng_;
    return side < 0 ? -n : n;
  }
  /// A normal with a positive cosine to `w`: ns if possible.
  V3f front_normal(const V3f& w, float side) const { return normal(in_front_of_ns(w, side), side); }
  /// Whether an eye in direction `w` sees the surface with ns; otherwise it uses ng.
  bool seen_with_ns(const V3f& w, float side) const {
    if (!in_front_of_ns(w, side)) return false;
    // Not for glass: light that enters it by ng could be reflected inside by ns forever.
    if (flat_ || lobes_->kind != Lobes::Kind::layered || transmits()) return true;
    return dot(reflect(w, normal(true, side)), ng_) * side > 0;
  }
  bool own_coat_normal() const { return lobes_->further && lobes_->further->coat_normal; }
  /// Whether eval() is the same for importance, but for refraction.
  bool reciprocal() const { return flat_ && !own_coat_normal(); }
  /// Whether eyes see light from `w` with either of two frames.
  bool two_frames(const V3f& w, float side) const {
    return own_coat_normal() || in_front_of_ns(w, side);
  }
  V3f coat_normal(const V3f& w, CoatFrame frame) const;
  /// The normal for cosines if the eye is in direction `w`.
  V3f eye_normal(const V3f& w, float side) const { return normal(seen_with_ns(w, side), side); }

  Evaluated evaluate_any(const V3f& wo, const V3f& wi, Transport transport) const;
  Rgb eval_any(const V3f& wo, const V3f& wi, Transport transport) const;
  Pdf<SolidAngle> pdf_any(const V3f& wo, const V3f& wi, Transport transport) const;
  std::optional<BsdfSample> sample_any(const V3f& wo, double u_lobe, const V2f& u,
                                       Transport transport) const;

  bool has_broad_further() const;
  Facets facets(const V3f& n) const {
    const float alpha = lobes_->interface.alpha;
    if (!lobes_->further || !(lobes_->further->alpha_along > 0)) return {n, alpha};
    return {n, alpha, lobes_->further->alpha_along, along_, lobes_->further->shape};
  }
  /// What the covers let through of direction `w`: all behind the surface of a solid, where its
  /// inside is, and without covers.
  Covers::Through let_through(const V3f& w, float cos) const {
    const bool covered = lobes_->further && (lobes_->interface.thin || dot(w, ng_) > 0);
    if (!covered) return {};
    const float coat_cos = own_coat_normal() ? dot(w, coat_normal(w, CoatFrame::seen)) : cos;
    return lobes_->further->covers.through(cos, coat_cos);
  }

  // Under a coating, Choice::coat is the probability of its boundary and Choice::facets that of the
  // whole base, which is a Bsdf of its own.
  bool coated() const { return lobes_->further && lobes_->further->coating && !bare_; }
  float coating_alpha() const { return coated() ? lobes_->further->coating->alpha() : 0.0F; }
  Bsdf below_coating(const ShadingFrame& from) const;
  Choice coated_choice(const ShadingFrame& from) const;
  template <bool want_f, bool want_pdf>
  Scatter coated_scatter(const ShadingFrame& from, const Choice* c, const V3f& wo,
                         const V3f& wi) const;
  DeltaSum coated_delta_sum(const ShadingFrame& from, const Choice& c, const V3f& wi) const;
  std::optional<LobeSample> sample_coated(const ShadingFrame& from, const Choice& c, const V3f& wo,
                                          double u_lobe, const V2f& u) const;

  ShadingFrame shading_frame(const V3f& n, const V3f& wo, CoatFrame coat = CoatFrame::seen) const;
  Choice choice(const ShadingFrame& from) const;
  void weigh_base(const ShadingFrame& from, Choice& c) const;
  void add_covers(const ShadingFrame& from, Choice& c) const;
  /// `c` may be null unless want_pdf.
  template <bool want_f, bool want_pdf>
  Scatter scatter(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi) const;
  template <bool want_f, bool want_pdf>
  void reflected(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                 Scatter& s) const;
  template <bool want_f, bool want_pdf>
  void transmitted(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                   Scatter& s) const;
  template <bool want_f, bool want_pdf>
  void refracted(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                 Scatter& s) const;
  template <bool want_f, bool want_pdf>
  void mirrored(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                Scatter& s) const;
  /// Scales what lies below the covers, and adds sheen, to the same side only.
  template <bool want_f, bool want_pdf>
  void cover(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
             Scatter& s) const;
  /// Adds the lobe of a rough coat.
  template <bool want_f, bool want_pdf>
  void coat_lobe(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                 Scatter& s) const;
  /// 1: wi is on wo's side of ng and of `n`, which is on wo's side (reflection); -1: on the other
  /// side of both (transmission); 0: neither.
  int passage(bool front, const V3f& n, const V3f& wi) const;

  std::optional<LobeSample> sample_lobe(const ShadingFrame& from, const Choice& c, const V3f& wo,
                                        double u_lobe, const V2f& u) const;
  LobeSample sample_coat(const ShadingFrame& from, const Choice& c, const V3f& wo,
                         const V2f& u) const;
  /// The direction in which the facet `m` transmits; none under total reflection.
  std::optional<V3f> passed(const ShadingFrame& from, const V3f& wo, const V3f& m) const;
  /// The delta lobes that scatter wo to `wi`; `split` of the facet that does.
  DeltaSum delta_sum(const ShadingFrame& from, const Choice& c, const Interface::Split& split,
                     const V3f& wi, bool transmitted) const;
  /// Probability of the delta lobe of the facets, or of Interface::clear(), with facets of `split`.
  double delta_probability(const Choice& c, const Interface::Split& split, bool transmitted) const;
  /// Probability with which importance from `w` is scattered with the normal `n`.
  float frame_probability(const V3f& w, const V3f& n) const;
  std::optional<BsdfSample> finish_delta(const LobeSample& drawn, const ShadingFrame& from,
                                         const V3f& wo, float frame_probability,
                                         Transport transport) const;

  V3f ng_, ns_;
  bool flat_;           // ns equals ng, up to the rounding of an interpolated normal
  bool bare_ = false;   // without its coating: the base of another Bsdf
  V3f along_{0, 0, 0};  // direction of the wider facets, if needs_tangents()
  HeldLobes lobes_;
};

}  // namespace lacuna
