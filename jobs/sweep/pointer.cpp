#include "jobs/sweep/pointer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "jobs/spec/described.h"

namespace lacuna {

std::vector<std::string> pointer_tokens(std::string_view pointer) {
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~' && i + 1 < pointer.size()) {
      tokens.back() += pointer[++i] == '1' ? '/' : '~';
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

std::optional<std::string> pointer_problem(std::string_view pointer) {
  bool good = pointer.starts_with('/');
  for (std::size_t i = 0; good && i < pointer.size(); ++i) {
    const char next = i + 1 < pointer.size() ? pointer[i + 1] : '\0';
    good = pointer[i] != '~' || next == '0' || next == '1';
  }
  if (good) return {};
  return "is not a JSON pointer to a setting; allowed: such as \"/integrator/max_depth\"";
}

std::optional<std::string> set_at(Json& document, const Json& defaults, std::string_view pointer,
                                  Json value) {
  const std::vector<std::string> tokens = pointer_tokens(pointer);
  const auto first = defaults.find(tokens.front());
  if (tokens.size() > 1 && first != defaults.end() && !document.contains(tokens.front())) {
    document[tokens.front()] = *first;
  }
  Json* here = &document;
  for (const std::string& token : tokens) {
    if (here->is_null()) *here = Json::object();
    if (here->is_string()) *here = Json{{std::string(variant_key), *here}};
    if (here->is_object()) {
      here = &(*here)[token];
      continue;
    }
    const bool number = !token.empty() && token.size() < 9 &&
                        token.find_first_not_of("0123456789") == std::string::npos &&
                        (token.size() == 1 || token[0] != '0');
    if (!here->is_array() || !number || std::stoul(token) >= here->size()) {
      return fmt::format("points to no setting: there is no \"{}\" in {}", token, json_text(*here));
    }
    here = &(*here)[std::stoul(token)];
  }
  *here = std::move(value);
  return {};
}

}  // namespace lacuna
