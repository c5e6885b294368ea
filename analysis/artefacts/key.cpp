#include "analysis/artefacts/key.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <stdexcept>

namespace lacuna {
namespace {

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

void check_name(std::string_view name) {
  const auto allowed = [](char c) { return is_lower(c) || is_digit(c) || c == '_'; };
  if (!name.empty() && is_lower(name[0]) && std::all_of(name.begin(), name.end(), allowed)) return;
  throw std::invalid_argument(fmt::format(
      "an artefact's type: found \"{}\"; allowed: lower-case letters, digits and '_', beginning "
      "with a letter",
      name));
}

void check_settings(std::string_view settings) {
  const auto allowed = [](char c) { return c >= ' ' && c <= '~' && c != '{' && c != '}'; };
  if (std::all_of(settings.begin(), settings.end(), allowed)) return;
  throw std::invalid_argument(fmt::format(
      "an artefact's settings: found \"{}\"; allowed: printable ASCII without braces", settings));
}

void check_hash(std::string_view hash) {
  const auto allowed = [](char c) { return is_digit(c) || (c >= 'a' && c <= 'f'); };
  if (!hash.empty() && std::all_of(hash.begin(), hash.end(), allowed)) return;
  throw std::invalid_argument(
      fmt::format("an artefact's input: found \"{}\"; allowed: hexadecimal digits", hash));
}

}  // namespace

ArtefactKey::ArtefactKey(std::string type, std::uint32_t version, std::string settings)
    : type_(std::move(type)), version_(version), settings_(std::move(settings)) {
  check_name(type_);
  check_settings(settings_);
}

ArtefactKey& ArtefactKey::from(std::string_view name, std::string_view hash) {
  check_name(name);
  check_hash(hash);
  inputs_ += fmt::format(" {}:{}", name, hash);
  return *this;
}

std::string ArtefactKey::text() const {
  return fmt::format("{} {} {{{}}}{}", type_, version_, settings_, inputs_);
}

std::string ArtefactKey::hash() const { return key_hash(text()); }

std::string key_hash(std::string_view text) {
  const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

}  // namespace lacuna
