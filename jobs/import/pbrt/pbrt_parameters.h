#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/import/pbrt/pbrt_tokens.h"
#include "renderer/core/vec.h"

namespace lacuna::pbrt {

/// One parameter of a statement: `"float fov" 39`.
struct Parameter {
  std::string type, name;
  std::vector<double> numbers;
  std::vector<std::string> texts;  ///< of string, texture, bool (true, false), a named spectrum
  Place place;
  mutable bool used = false;
};

/// The parameters of a statement. A look-up marks what it finds as used; a parameter of another
/// type than those of the look-up is not found. Of several with one name the last is found, as in
/// pbrt.
class Parameters {
 public:
  Parameters() = default;
  /// Reads `"type name" values` up to the next token of another form. Throws SceneError for unknown
  /// types, values that do not fit the type, and numbers that are not finite.
  Parameters(Tokens& tokens, Place place, std::string owner);

  const Place& place() const { return place_; }
  const std::string& owner() const { return owner_; }  ///< `Shape "sphere"`
  /// The same parameters for another statement, none of them used yet.
  Parameters copy_for(const Place& place, const std::string& owner) const;
  /// Appends those of `defaults` whose names are not here.
  void add_defaults(const Parameters& defaults);

  const Parameter* find(std::string_view name, std::initializer_list<std::string_view> types) const;
  /// A colour or spectrum of any form.
  const Parameter* find_spectrum(std::string_view name) const;

  std::optional<double> number(std::string_view name) const;
  double number(std::string_view name, double otherwise) const;
  /// Throws SceneError if it is not within [least, most].
  double number_in(std::string_view name, double otherwise, double least, double most) const;
  int integer(std::string_view name, int otherwise, int least, int most) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string text(std::string_view name, const std::string& otherwise) const;
  V3d point(std::string_view name, const V3d& otherwise) const;
  /// Groups of `size` numbers; empty if there are none. Throws SceneError if a group is incomplete.
  std::span<const double> groups(std::string_view name, std::size_t size,
                                 std::initializer_list<std::string_view> types) const;
  /// Indices in [0, count). Throws SceneError.
  std::vector<std::uint32_t> indices(std::string_view name, std::size_t group,
                                     std::size_t count) const;

  /// Marks parameters as used whose values do not change the picture that a converged render shows.
  void ignore(std::initializer_list<std::string_view> names) const;
  std::vector<const Parameter*> unused() const;
  const std::vector<Parameter>& all() const { return parameters_; }

 private:
  void read_values(Tokens& tokens, Parameter& p) const;
  const Parameter& single(const Parameter& p) const;

  std::vector<Parameter> parameters_;
  Place place_;
  std::string owner_;
};

/// The number that a word states; none if it states none. Not finite ones are none.
std::optional<double> number_of(std::string_view word);

}  // namespace lacuna::pbrt
