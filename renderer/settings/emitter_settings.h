#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// How next event estimation selects an emitter.
enum class EmitterChoice { automatic, tree, power };

template <>
struct EnumTable<EmitterChoice> {
  static constexpr std::array<EnumValue<EmitterChoice>, 3> values{{
      {EmitterChoice::automatic, "auto",
       "`tree` in scenes of more than a few emitters, else `power`; each emissive triangle is an "
       "emitter"},
      {EmitterChoice::tree, "tree",
       "by a light tree, for each vertex: by power, distance, and the directions of emission and "
       "of the surface (Conty Estevez and Kulla 2018)"},
      {EmitterChoice::power, "power",
       "by power, the same at all vertices; with probability 1/8 by mesh or light first"},
  }};
};

template <class V>
void describe_emitters(V& v, EmitterChoice& choice) {
  v("emitters", choice,
    {.doc = "how next event estimation selects the emitter", .published = "\"power\""});
}

}  // namespace lacuna
