#include "base/json/json_text.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lacuna {
namespace {

template <class AnyJson>
std::string text_of(const AnyJson& json, int indent, Escape escape) {
  return json.dump(indent, ' ', escape == Escape::all_but_ascii, AnyJson::error_handler_t::replace);
}

template <class AnyJson>
AnyJson parsed(std::string_view text) {
  AnyJson json = AnyJson::parse(text, nullptr, false);
  if (json.is_discarded()) throw std::logic_error("Lacuna's own text is not valid JSON");
  return json;
}

}  // namespace

std::string json_text(const Json& json, Escape escape) { return text_of(json, -1, escape); }
std::string json_text(const OrderedJson& json, Escape escape) { return text_of(json, -1, escape); }

std::string document_text(const OrderedJson& json) {
  return text_of(json, 2, Escape::as_needed) + '\n';
}

OrderedJson parse_own(std::string_view text) { return parsed<OrderedJson>(text); }
Json parse_own_sorted(std::string_view text) { return parsed<Json>(text); }

bool is_utf8(std::string_view text) {
  try {
    return !Json(text).dump().empty();
  } catch (const Json::type_error&) {
    return false;
  }
}

}  // namespace lacuna
